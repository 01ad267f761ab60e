// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

class BuildingModel;

namespace plumbline::bim {

/// The schema that a file is read by: IFC2X3 for that and its forerunners, IFC4 for that and its successors (IFC4X1 to
/// IFC4X3), whose buildings have the same entities; what is new in them (roads, bridges) is not read.
[[nodiscard]] std::string schema_for_reader(const std::string& schema);

/// STEP text of that schema to IFC++'s entity graph, inverse relations resolved. Throws InputError when IFC++ gives up.
[[nodiscard]] std::shared_ptr<BuildingModel> parse_step(const std::string& text, const std::string& schema,
                                                        const std::string& file);

/// IFC++ keeps text in wide strings.
[[nodiscard]] std::string utf8(const std::wstring& text);

}  // namespace plumbline::bim
