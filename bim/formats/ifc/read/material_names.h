// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// True when a name contains a word for transparent glass, in one of the languages of common exporters; false for
/// glass wool, glass fibre and glass blocks.
[[nodiscard]] bool says_glass(std::string_view name);

/// The material of this name: clear glass when it says so, otherwise a Material's defaults.
[[nodiscard]] Material material_named(const std::string& name);

}  // namespace plumbline::bim
