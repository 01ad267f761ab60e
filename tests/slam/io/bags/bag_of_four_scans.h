// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "slam/io/bags/bag.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {

/// Four scans with odometry at 100 Hz and IMU at 250 Hz.
inline std::vector<SensorFrame> walk_of_four_scans() {
  constexpr int turns = 4, packets = 76;
  const std::vector<Vlp16Packet> all = turning_packets(turns * packets);
  std::vector<SensorFrame> frames(turns);
  Nanoseconds odometry = 0, imu = 0;
  for (std::size_t m = 0; m < turns; ++m) {
    frames[m].scan = decode_message(std::span(all).subspan(packets * m, packets));
    for (; odometry <= frames[m].scan.stamp; odometry += 10'000'000) {
      const double s = seconds(odometry);
      frames[m].odometry.push_back({odometry, Pose::from_xyz_yaw({0.3 * s, -0.1 * s, 0.0}, 0.2 * s)});
      frames[m].covariances.push_back({odometry, 1e-8 * Matrix6d::Identity()});
    }
    for (; imu <= frames[m].scan.stamp; imu += 4'000'000)
      frames[m].imu.push_back({imu, Eigen::Vector3d(0.1, 0.2, 1.0 / 3.0), Eigen::Vector3d(0, -0.5, 9.81)});
  }
  return frames;
}

inline void write_walk(const std::string& path, BagFormat format, std::string_view compression = {}) {
  Calibration calibration;
  calibration.X_RL = Pose::from_xyz_yaw({0.1, -0.2, 0.3}, 1.0);
  BagWriter writer(path, bag_profiles[0], calibration, format, compression);
  for (const SensorFrame& frame : walk_of_four_scans()) {
    writer.add(frame.scan, frame.odometry, frame.imu, frame.covariances);
    const std::vector<StampedPose> truth = {{frame.scan.stamp, Pose{}}};
    writer.add_truth(truth);
  }
  writer.finish();
}

}  // namespace plumbline::slam
