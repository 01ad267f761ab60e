// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace plumbline::scenarios {

/// A number with so many digits behind the point, without a sign on what rounds to zero.
[[nodiscard]] inline std::string fixed_point(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, std::abs(value) < 0.5 * std::pow(10.0, -digits) ? 0.0 : value);
  return text;
}

}  // namespace plumbline::scenarios
