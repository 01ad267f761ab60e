// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scenarios/spec/resolve.h"
#include "sim/world.h"

namespace plumbline::scenarios {

/// The simulation of a scenario. A robot that is kidnapped walks in a second world from where it is set down: time goes
/// on, odometry goes on from its last position and heading, since legs in the air measure nothing; the sensors keep
/// their errors. In between there is neither scan nor odometry.
class SimulatedRun {
 public:
  /// `resolved` must outlive it. Throws as sim::World.
  explicit SimulatedRun(const ResolvedScenario& resolved);

  /// As sim::World::next.
  [[nodiscard]] bool next(sim::WorldFrame& frame);

 private:
  void set_down();
  void carry_on(sim::WorldFrame& frame) const;

  const ResolvedScenario& resolved_;
  std::optional<sim::World> world_;
  slam::Nanoseconds last_stamp_ = 0;
  Pose last_X_OR_;
  std::optional<slam::Nanoseconds> begin_;  ///< of the second world
  Pose X_OO_;                               ///< its odometry frame in that of the first
};

}  // namespace plumbline::scenarios
