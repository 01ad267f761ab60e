// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/plan/plan.h"
#include "scenarios/metrics/localization_score.h"
#include "scenarios/metrics/structure.h"

namespace plumbline::scenarios::score {

/// For each wall patch that a robot at X_WR_true matched, whether it was matched with the right wall: at the true pose
/// at least half of its length (StructureRules::wall_overlap) lies on faces of that wall as built, within
/// wall_angle_deg and wall_offset_m. Faces are named by their ids in the plan; where they stand, the building as built
/// says.
[[nodiscard]] std::vector<bool> right_matches(const std::vector<slam::WallMatch>& matches, const Pose& X_WR_true,
                                              const bim::Plan& as_planned, const bim::Plan& as_built,
                                              const StructureRules& rules = {});

/// For each wall patch that a robot at X_WR_true saw, the id of the wall as built that most of it lies on there, within
/// the same limits; empty where it lies on none, as on furniture.
[[nodiscard]] std::vector<std::string> walls_seen(const std::vector<slam::WallMatch>& matches, const Pose& X_WR_true,
                                                  const bim::Plan& as_built, const StructureRules& rules = {});

/// Share of the wall patches matched at the first convergence, where the plan's graph takes over from the particles,
/// that are matched with the right wall. Absent where nothing converged (of a kidnapped robot: before the kidnapping),
/// or the hypothesis of the largest mass then names no wall.
[[nodiscard]] std::optional<double> handover_precision(const Truth& truth, const std::vector<Belief>& beliefs,
                                                       const bim::Plan& as_planned, const bim::Plan& as_built,
                                                       const StructureRules& rules = {});

}  // namespace plumbline::scenarios::score
