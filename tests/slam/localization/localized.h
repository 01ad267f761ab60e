// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bim/plan/plan.h"
#include "slam/localization/pipeline.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {

/// Of a robot with that plan, whose owner knows the heading of the start or not.
inline MethodInput input_for(const synthetic::Recording& recording, const bim::Plan& plan, bool yaw_known) {
  MethodInput input;
  input.seed = 17;
  input.calibration = recording.calibration;
  input.plan = std::make_shared<bim::Plan>(plan);
  if (yaw_known) input.prior.yaw_W = recording.truth.front().X_FR.yaw();
  return input;
}

struct Answers {
  std::vector<Output> outputs;
  Estimate estimate;
};

/// What the localization answers to a recording.
inline Answers run(const synthetic::Recording& recording, const MethodInput& input) {
  Answers result;
  const std::unique_ptr<Method> method = make_s_graph_localization(input);
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    while (next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp)
      method->on_odometry(recording.odometry[next++]);
    result.outputs.push_back(method->on_scan(scan));
  }
  result.estimate = method->finish();
  return result;
}

/// The walk with the time from t0 to t1 cut out: odometry goes on as if nothing had happened, the robot is elsewhere.
/// In the air there is nothing received for `silent`.
inline synthetic::Recording kidnapped(const synthetic::Recording& recording, Nanoseconds t0, Nanoseconds t1,
                                      Nanoseconds silent = 0) {
  synthetic::Recording result;
  result.calibration = recording.calibration;
  Pose X_OR_t0, X_OR_t1;
  for (const Odometry& o : recording.odometry) {
    if (o.stamp <= t0) X_OR_t0 = o.X_OR;
    if (o.stamp <= t1) X_OR_t1 = o.X_OR;
  }
  const Pose X_patch = X_OR_t0 * X_OR_t1.inverse();
  for (const Odometry& o : recording.odometry) {
    if (o.stamp <= t0) result.odometry.push_back(o);
    if (o.stamp > t1) result.odometry.push_back({o.stamp - (t1 - t0) + silent, X_patch * o.X_OR});
  }
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    Scan scan = recording.scans[i];
    if (scan.stamp > t0 && scan.stamp <= t1 + 200'000'000) continue;
    if (scan.stamp > t1) scan.stamp -= t1 - t0 - silent;
    result.scans.push_back(scan);
    result.truth.push_back({scan.stamp, recording.truth[i].X_FR});
  }
  return result;
}

}  // namespace plumbline::slam
