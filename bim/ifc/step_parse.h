// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

class BuildingModel;

namespace plumbline::bim {

/// STEP text to IFC++'s entity graph, inverse relations resolved. Throws InputError when IFC++ gives up.
[[nodiscard]] std::shared_ptr<BuildingModel> parse_step(const std::string& text, const std::string& file);

/// IFC++ keeps text in wide strings.
[[nodiscard]] std::string utf8(const std::wstring& text);

}  // namespace plumbline::bim
