// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scenarios/run/method_recorder.h"
#include "scenarios/spec/sensors.h"
#include "slam/io/recordings/sensor_frame.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// One estimator of a run: feeds it the sensor frames in time order and records its answers. Sensor frames are all it
/// is given, so that no estimator can see the truth. A method that crashes does not disturb the others. With LiDAR
/// alone its record has the label of MethodChoice.
class MethodRunner {
 public:
  MethodRunner(slam::MethodRow row, slam::MethodInput input, Sensors sensors = Sensors::all);

  void on_frame(const slam::SensorFrame& frame);
  /// Call once, after the last frame.
  [[nodiscard]] MethodRecord finish();

 private:
  [[nodiscard]] slam::Output process(const slam::SensorFrame& frame);

  slam::MethodRow row_;
  slam::MethodInput input_;
  Sensors sensors_;
  std::unique_ptr<slam::Method> method_;
  MethodRecorder recorder_;
};

}  // namespace plumbline::scenarios
