// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/run/record.h"
#include "sim/world.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// One method of a run: feeds it the frames in time order and keeps what it says. A method that throws has crashed;
/// it gets no further frame and does not disturb the others.
class Participant {
 public:
  virtual ~Participant() = default;
  void on_frame(const sim::WorldFrame& frame);
  /// Call once, after the last frame.
  [[nodiscard]] MethodRecord finish();

 protected:
  Participant(std::string name, bool localization);
  virtual slam::Output process(const sim::WorldFrame& frame) = 0;
  virtual slam::Estimate estimate() = 0;

 private:
  void keep(const slam::Output& output);
  void keep_belief(const slam::Output& output);

  MethodRecord record_;
  slam::Nanoseconds last_stamp_ = 0;
  slam::Nanoseconds particles_stamp_ = 0;
  slam::Nanoseconds walls_stamp_ = 0;
};

/// An estimator of the table. It sees odometry, IMU and scans, never the frame's truth.
[[nodiscard]] std::unique_ptr<Participant> make_estimator(const slam::MethodRow& row, const slam::MethodInput& input);
/// The method that knows the truth: scores 0, which checks the scorer.
[[nodiscard]] std::unique_ptr<Participant> make_truth();

}  // namespace plumbline::scenarios
