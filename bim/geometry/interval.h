// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <compare>
#include <limits>

namespace plumbline {

/// A range of numbers, empty at first.
struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double length() const { return high - low; }
  /// By the low end, then by the high one.
  [[nodiscard]] friend auto operator<=>(const Interval&, const Interval&) = default;
};

/// Positive: the gap between two intervals; negative: their overlap.
[[nodiscard]] inline double gap(const Interval& a, const Interval& b) {
  return std::max(a.low, b.low) - std::min(a.high, b.high);
}

}  // namespace plumbline
