// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/odometry_method.h"

#include "slam/io/stopwatch.h"

namespace plumbline::slam {

Output OdometryMethod::on_scan(const Scan& scan) {
  Output output;
  output.stamp = scan.stamp;
  Stopwatch stopwatch;
  DeskewedScan deskewed_scan = deskewed(scan);
  output.times.push_back({"deskew", stopwatch.cpu_ms()});
  output.digests.push_back({"deskew", digest(deskewed_scan)});

  stopwatch.restart();
  const OdometryAnswer answer = track(scan, deskewed_scan);
  output.times.push_back({"odometry", stopwatch.cpu_ms()});
  output.digests.push_back({"odometry", answer.digest});

  output.X_FR = answer.X_MR;
  if (answer.lost) output.state = State::lost;
  output.degenerate_directions = answer.degenerate_directions;
  trajectory_.push_back({scan.stamp, answer.X_MR});
  // M starts at the first scan, whether or not it could be matched.
  if (answer.accepted || trajectory_.size() == 1) map_.add(deskewed_scan, answer.X_MR);
  return output;
}

Estimate OdometryMethod::finish() {
  Estimate estimate;
  estimate.trajectory = trajectory_;
  estimate.map_F = map_.cloud();
  return estimate;
}

}  // namespace plumbline::slam
