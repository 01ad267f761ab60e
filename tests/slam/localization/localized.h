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

}  // namespace plumbline::slam
