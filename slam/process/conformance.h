// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bim/plan/plan.h"
#include "slam/process/process_method.h"

namespace plumbline::slam {

/// What was tried of a process, and what came of it.
struct Finding {
  enum class Kind { fine, note, wrong };
  Kind kind = Kind::fine;
  std::string text;
};

/// Starts the process on the trial walk (trial_walk.h), again to see whether it repeats, and a third time on LiDAR
/// alone with scans that are hard: without returns, of one return. plan: of trial_plan(), for a localization; else
/// null. found: gets each finding as soon as it is made. go_on: asked before each scan; what it throws ends the
/// process. Never throws ProcessFailure: that is a finding.
void check_conformance(ProcessCommand command, const std::shared_ptr<const bim::Plan>& plan,
                       const std::function<void(const Finding&)>& found, const std::function<void()>& go_on);

/// What poses that do not follow the trial walk may be of instead: the LiDAR, the map in the robot, the middle of the
/// scan. aligned: compared from the first pose on, else as they are in W. Nothing where they follow, or nothing fits.
[[nodiscard]] std::optional<Finding> misunderstanding(const std::vector<StampedPose>& answered, const Pose& X_RL,
                                                      bool aligned);

}  // namespace plumbline::slam
