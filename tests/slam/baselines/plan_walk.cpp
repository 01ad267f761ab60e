// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/baselines/plan_walk.h"

#include <limits>

#include "slam/methods.h"

namespace plumbline::slam::synthetic {

PlanWalkAnswers localize(const std::string& method, const Recording& recording, const bim::Plan& plan, bool yaw_known,
                         const std::string& config) {
  MethodInput input;
  input.seed = 17;
  input.calibration = recording.calibration;
  input.plan = std::make_shared<bim::Plan>(plan);
  if (yaw_known) input.prior.yaw_W = recording.truth.front().X_FR.yaw();
  const MethodRow* row = find_method(method);
  if (!config.empty()) input.config = row->configure(read_yaml(config, "config.yaml"));
  const std::unique_ptr<Method> estimator = row->make(input);
  PlanWalkAnswers answers;
  std::size_t next = 0, next_imu = 0;
  for (const Scan& scan : recording.scans) {
    while (next_imu < recording.imu.size() && recording.imu[next_imu].stamp <= scan.stamp)
      estimator->on_imu(recording.imu[next_imu++]);
    while (next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp)
      estimator->on_odometry(recording.odometry[next++]);
    answers.outputs.push_back(estimator->on_scan(scan));
  }
  answers.estimate = estimator->finish();
  return answers;
}

Recording biased_walk(double seconds) {
  WalkConfig config;
  config.duration_s = seconds;
  config.range_bias_m = 0.015;
  config.odometry_scale = 0.99;
  return walk(corridor_house(), corridor_house_walk(), config);
}

double last_error(const PlanWalkAnswers& answers, const Recording& recording) {
  const std::optional<Pose>& X_WR = answers.outputs.back().X_FR;
  return X_WR ? (X_WR->t - recording.truth.back().X_FR.t).norm() : std::numeric_limits<double>::infinity();
}

}  // namespace plumbline::slam::synthetic
