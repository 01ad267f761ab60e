// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/oracle_method.h"

#include "bim/errors.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

OracleMethod::OracleMethod() : recorder_(std::string(truth_method), false) {}

void OracleMethod::on_truth(const sim::GroundTruth& truth) {
  if (truth.poses.empty()) throw InternalError("a frame without truth");
  const sim::TruePose& pose = truth.poses.back();
  recorder_.on_scan(pose.stamp, [&] {
    slam::Output output;
    output.stamp = pose.stamp;
    output.X_FR = pose.X_WR;
    return output;
  });
}

MethodRecord OracleMethod::finish() {
  return recorder_.finish([] { return slam::Estimate{}; });
}

}  // namespace plumbline::scenarios
