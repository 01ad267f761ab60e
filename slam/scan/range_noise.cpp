// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/range_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace plumbline::slam {

double range_noise(const DeskewedScan& scan) {
  constexpr int stride = 7;  // prime to common numbers of rings, so that all are among them
  std::vector<double> bends;
  const auto at = [&](int column, int ring) {
    return scan.range_m[static_cast<std::size_t>(column * scan.rings + ring)];
  };
  for (int i = 0; i < (scan.columns - 2) * scan.rings; i += stride) {
    const int column = i / scan.rings, ring = i % scan.rings;
    const double a = at(column, ring), b = at(column + 1, ring), c = at(column + 2, ring);
    if (a > 0.0 && b > 0.0 && c > 0.0) bends.push_back(std::abs(a - 2.0 * b + c));
  }
  if (bends.empty()) return 0.0;
  const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
  std::nth_element(bends.begin(), middle, bends.end());
  constexpr double median_of_unit_normal = 0.6745;
  return *middle / (median_of_unit_normal * std::sqrt(6.0));
}

}  // namespace plumbline::slam
