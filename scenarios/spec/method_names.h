// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/methods.h"

namespace plumbline::scenarios {

/// Name of the row the runner adds to the table of estimators: the method that knows the truth.
inline constexpr std::string_view truth_method = "truth";

/// Names of every method a scenario may ask for, in the order of `plumbline methods`.
[[nodiscard]] std::vector<std::string> method_names(slam::MethodTable table = slam::methods());

}  // namespace plumbline::scenarios
