// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/plan/plan.h"
#include "slam/plan_map/plan_segment.h"
#include "slam/plan_map/pose2.h"

namespace plumbline::slam {

/// A coordinate in I to 1e-6 m.
[[nodiscard]] double snap(double value);
[[nodiscard]] Eigen::Vector2d snap(const Eigen::Vector2d& p);

/// The upright rectangle over p0 to p1 (in W) with free space on its left. base_z: height of I in W, m.
[[nodiscard]] PlanSegment upright(const Eigen::Vector2d& p0, const Eigen::Vector2d& p1, double z0, double z1,
                                  const Pose2& X_IW, double base_z);
/// The sides of a solid of a plan in W; none is shorter than a millimetre.
[[nodiscard]] std::vector<PlanSegment> sides_of(const bim::PlanSolid& solid, const Pose2& X_IW, double base_z);
/// Into an order that does not depend on that of the plan.
void sort_by_geometry(std::vector<PlanSegment>& segments);

}  // namespace plumbline::slam
