// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/intervals.h"

#include <algorithm>

namespace plumbline::slam {

std::vector<Interval> rest_of(double low, double high, std::vector<Interval> taken) {
  std::sort(taken.begin(), taken.end());
  std::vector<Interval> rest;
  double from = low;
  for (const auto& [a, b] : taken) {
    if (a > from) rest.push_back({from, std::min(a, high)});
    from = std::max(from, b);
    if (from >= high) break;
  }
  if (from < high) rest.push_back({from, high});
  return rest;
}

}  // namespace plumbline::slam
