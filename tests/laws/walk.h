// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bim/plan/plan.h"
#include "sim/world.h"
#include "slam/io/method.h"

namespace plumbline {

/// A short simulated walk through the quickstart floor, with the sensors' noise. What methods are fed and the truth are
/// kept apart.
struct SimulatedWalk {
  std::shared_ptr<const bim::Plan> plan;
  std::vector<slam::SensorFrame> frames;
  std::vector<Pose> X_WR;  ///< true pose at the scan of each frame
  Pose X_WR_start;
};

[[nodiscard]] SimulatedWalk walk_quickstart(std::uint64_t seed, const std::vector<std::string>& rooms,
                                            double duration_s, slam::LidarModelId lidar = slam::LidarModelId::vlp16);

/// Names of the table of methods, without those that differ in their defaults alone.
[[nodiscard]] std::vector<std::string> all_methods();

/// What a method needs for this walk, with a compass of the given heading error.
[[nodiscard]] slam::MethodInput method_input(const SimulatedWalk& walk, const std::string& method,
                                             double yaw_error = 0.02);

/// What a method says of a walk.
struct Answer {
  std::vector<slam::Output> outputs;
  slam::Estimate estimate;
};
/// Feeds a method the sensor frames, and nothing else.
[[nodiscard]] Answer answer_of(const std::string& method, const slam::MethodInput& input,
                               const std::vector<slam::SensorFrame>& frames);

/// Hash of everything an answer says.
[[nodiscard]] std::uint64_t digest_of(const Answer& answer);

/// Root mean square distance of the causal positions to the truth, M placed on W by the first pose.
[[nodiscard]] double rmse_from_first_pose(const Answer& answer, const SimulatedWalk& walk);

}  // namespace plumbline
