// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenarios/run/method_recorder.h"
#include "sim/world.h"

namespace plumbline::scenarios {

/// The row `truth`: a perfect SLAM method, whose map frame M is W. It scores 0, which checks the scorer. Unlike the
/// estimators it is handed the ground truth, and nothing else.
class OracleMethod {
 public:
  OracleMethod();

  void on_truth(const sim::GroundTruth& truth);
  /// Call once, after the last frame.
  [[nodiscard]] MethodRecord finish();

 private:
  MethodRecorder recorder_;
};

}  // namespace plumbline::scenarios
