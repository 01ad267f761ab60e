// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "slam/io/estimate.h"

namespace plumbline::scenarios {

/// Names of slam::State in files and reports, in the order of its values.
inline constexpr std::array<std::string_view, 4> state_names = {"SEARCHING", "AMBIGUOUS", "CONVERGED", "LOST"};

/// What they say, in the same order.
inline constexpr std::array<std::string_view, 4> state_meanings = {
    "no pose is confirmed: none stands out, or one does but has not yet led for long enough", "several poses remain",
    "one pose is announced; this is the answer", "the announced pose was withdrawn"};

[[nodiscard]] constexpr std::string_view state_name(slam::State state) {
  return state_names[static_cast<std::size_t>(state)];
}

}  // namespace plumbline::scenarios
