// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// True when a name speaks of glass that one sees through, in one of the languages of common exporters; not of glass
/// wool, glass fibre or glass blocks.
[[nodiscard]] bool says_glass(std::string_view name);

/// The material of this name: clear glass when it says so, otherwise a Material's defaults.
[[nodiscard]] Material material_named(const std::string& name);

}  // namespace plumbline::bim
