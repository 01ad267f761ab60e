// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Whether the topics of a bag are stamped by one clock. The times of recording are those of one computer, and come
/// soon after the stamps.
class TopicClocks {
 public:
  /// A record's stamp and the time it was recorded. The middle one of a topic's first three counts: a driver's first
  /// may have no stamp yet.
  void add_scan(Nanoseconds stamp, Nanoseconds recorded) { add(scans_, stamp, recorded); }
  void add_odometry(Nanoseconds stamp, Nanoseconds recorded) { add(odometry_, stamp, recorded); }
  void add_imu(Nanoseconds stamp, Nanoseconds recorded) { add(imu_, stamp, recorded); }

  /// "the stamps on /points are 37.0 s ahead of those on /odom, by the times of recording"; empty where they are not
  /// plainly apart.
  [[nodiscard]] std::string difference(const std::string& scans, const std::string& odometry) const {
    return apart(odometry_, scans, odometry);
  }
  [[nodiscard]] std::string imu_difference(const std::string& scans, const std::string& imu) const {
    return apart(imu_, scans, imu);
  }

 private:
  static void add(std::vector<Nanoseconds>& first, Nanoseconds stamp, Nanoseconds recorded) {
    constexpr std::size_t enough = 3;
    if (first.size() < enough) first.push_back(stamp - recorded);
  }
  [[nodiscard]] std::string apart(const std::vector<Nanoseconds>& others, const std::string& scans,
                                  const std::string& other) const {
    constexpr double most_s = 5.0;  // of a scan, and of what may be computed before it is recorded
    if (scans_.empty() || others.empty()) return {};
    const double ahead_s = seconds(middle(scans_)) - seconds(middle(others));
    if (std::abs(ahead_s) <= most_s) return {};
    char text[64];
    std::snprintf(text, sizeof text, " are %.1f s %s those on ", std::abs(ahead_s),
                  ahead_s > 0.0 ? "ahead of" : "behind");
    return "the stamps on " + scans + text + other + ", by the times of recording";
  }
  static Nanoseconds middle(std::vector<Nanoseconds> all) {
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
  }

  std::vector<Nanoseconds> scans_, odometry_, imu_;  ///< stamps less the times of recording
};

}  // namespace plumbline::slam
