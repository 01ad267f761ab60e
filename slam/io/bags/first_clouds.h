// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "slam/io/bags/unset_clock.h"
#include "slam/io/packets/point_cloud.h"

namespace plumbline::slam {

/// Shows the clouds of a topic to a function, from the first on, until that returns false.
using ShowClouds = std::function<void(const std::function<bool(const PointCloud&)>&)>;

/// True where no cloud of the first three has a stamp. One alone may be at a simulation's start.
[[nodiscard]] inline bool are_unstamped(const ShowClouds& show) {
  constexpr int enough = 3;
  int clouds = 0;
  bool stamped = false;
  show([&](const PointCloud& cloud) {
    stamped = stamped || cloud.stamp != 0;
    return !stamped && ++clouds < enough;
  });
  return clouds > 1 && !stamped;
}

[[nodiscard]] inline UnsetClock clock_of_clouds(const ShowClouds& show) {
  UnsetClock clock;
  show([&](const PointCloud& cloud) { return clock.add(cloud.stamp); });
  return clock;
}

/// How the times of the points are read, told by the clouds that the clock takes: the stamps of others have no relation
/// to these. Throws InputError as scan_of() does.
[[nodiscard]] inline AssumedTimes times_of_clouds(const ShowClouds& show, const UnsetClock& clock) {
  TimeBaseSearch search;
  show([&](const PointCloud& cloud) { return clock.leaves_out(cloud.stamp) || search.add(cloud); });
  SweepLengthSearch lengths(search.base());
  show([&](const PointCloud& cloud) { return clock.leaves_out(cloud.stamp) || lengths.add(cloud); });
  return lengths.found();
}

}  // namespace plumbline::slam
