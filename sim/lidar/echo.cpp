// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/echo.h"

#include <algorithm>
#include <tuple>

namespace plumbline::sim {

namespace {

/// Surfaces farther apart than this in one echo: its range is that of neither.
constexpr double mixed_m = 0.05;

Echo join(std::span<const Reflection> reflections, bool mixed) {
  Echo echo;
  double most = -1.0;
  for (const Reflection& reflection : reflections) {
    const double energy = reflection.energy();
    echo.range_m += energy * reflection.path_m;
    echo.energy += energy;
    echo.cosine += reflection.strength * (reflection.cosine - 1.0);
    echo.strength += reflection.strength;
    if (energy <= most) continue;
    most = energy;
    echo.main = reflection;
  }
  echo.cosine = 1.0 + (echo.cosine - 1.0) / echo.strength;
  echo.range_m /= echo.energy;
  if (mixed) echo.main.flags |= light_path::mixed;
  return echo;
}

}  // namespace

void find_echoes(std::span<Reflection> reflections, double separation_m, std::vector<Echo>& echoes) {
  echoes.clear();
  if (reflections.empty()) return;
  const auto nearer = [](const Reflection& a, const Reflection& b) { return a.path_m < b.path_m; };
  const auto [first, last] = std::minmax_element(reflections.begin(), reflections.end(), nearer);
  const double spread_m = last->path_m - first->path_m;
  if (spread_m <= separation_m) {
    echoes.push_back(join(reflections, spread_m > mixed_m));
    return;
  }
  const auto key = [](const Reflection& r) { return std::tuple(r.path_m, r.element, r.triangle, r.flags); };
  std::sort(reflections.begin(), reflections.end(),
            [&](const Reflection& a, const Reflection& b) { return key(a) < key(b); });
  for (std::size_t begin = 0; begin < reflections.size();) {
    std::size_t end = begin + 1;
    while (end < reflections.size() && reflections[end].path_m - reflections[begin].path_m <= separation_m) ++end;
    const bool mixed = reflections[end - 1].path_m - reflections[begin].path_m > mixed_m;
    echoes.push_back(join(reflections.subspan(begin, end - begin), mixed));
    begin = end;
  }
}

}  // namespace plumbline::sim
