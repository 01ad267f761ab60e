// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace plumbline::scenarios {

/// What methods with a plan are told of what may have moved.
enum class ToldFurniture { none, as_planned };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(ToldFurniture) { return {"none", "as_planned"}; }

}  // namespace plumbline::scenarios
