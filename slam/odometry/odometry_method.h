// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/io/method.h"
#include "slam/scan/map_cloud.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// What odometry says of one scan.
struct OdometryAnswer {
  Pose X_MR;
  bool lost = false;
  bool accepted = true;           ///< may enter the map
  int degenerate_directions = 0;  ///< as in Output
  std::uint64_t digest = 0;       ///< of the stage "odometry"
};

/// Odometry and mapping alone: each scan's pose in M as it was found, never corrected, and at the end the map of the
/// scans at those poses. It records the stages "deskew" and "odometry".
class OdometryMethod : public Method {
 public:
  explicit OdometryMethod(const MapCloudConfig& map) : map_(map) {}

  [[nodiscard]] Output on_scan(const Scan& scan) final;
  [[nodiscard]] Estimate finish() final;

 protected:
  /// The scan without the robot's motion during it.
  [[nodiscard]] virtual DeskewedScan deskewed(const Scan& raw) = 0;
  /// Pose of a scan that deskewed() gave, right after it; the scan may be replaced by one that was deskewed better.
  [[nodiscard]] virtual OdometryAnswer track(const Scan& raw, DeskewedScan& scan) = 0;
  /// One pose for each scan before.
  [[nodiscard]] const std::vector<StampedPose>& trajectory() const { return trajectory_; }

 private:
  MapCloudRecorder map_;
  std::vector<StampedPose> trajectory_;
};

}  // namespace plumbline::slam
