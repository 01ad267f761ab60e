// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scenarios/run/method_recorder.h"
#include "slam/io/recordings/sensor_frame.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// One estimator of a run: feeds it the sensor frames in time order and records its answers. Sensor frames are all it
/// is given, so that no estimator can see the truth. A method that crashes does not disturb the others.
class MethodRunner {
 public:
  MethodRunner(slam::MethodRow row, slam::MethodInput input);

  void on_frame(const slam::SensorFrame& frame);
  /// Call once, after the last frame.
  [[nodiscard]] MethodRecord finish();

 private:
  [[nodiscard]] slam::Output process(const slam::SensorFrame& frame);

  slam::MethodRow row_;
  slam::MethodInput input_;
  std::unique_ptr<slam::Method> method_;
  MethodRecorder recorder_;
};

}  // namespace plumbline::scenarios
