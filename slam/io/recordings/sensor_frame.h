// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/io/odometry_covariance.h"
#include "slam/io/packets/vlp16.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// What the sensors of a robot, simulated or real, recorded up to and including one scan, since the scan before it.
/// Everything a method is fed is in here; ground truth is not.
struct SensorFrame {
  std::vector<Imu> imu;
  std::vector<Odometry> odometry;
  std::vector<OdometryCovariance> covariances;  ///< of the odometry, where known
  std::vector<Vlp16Packet> packets;             ///< of the scan; empty where the recording holds points
  Scan scan;
};

}  // namespace plumbline::slam
