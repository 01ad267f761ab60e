// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "scenarios/metrics/reference_score.h"

namespace plumbline::scenarios::score {

/// Rules of the axes of a reference. As those of quaternions in another order: what is turned breaks the motion between
/// poses, seen from the robot.
struct AxesRules {
  double least_error_m = 0.5;    ///< over each metre, as read; below, nothing is wrong with the axes
  double most_of_as_read = 0.2;  ///< what is left of it with the axes turned
  double reach_m = 1.0;          ///< of the motions by which they are turned
};

/// A reference as its poses would be in the axes of the robot R, and how far those of its own body B are turned.
struct TurnedReference {
  std::vector<slam::StampedPose> reference_W;
  double turned_rad = 0.0;
};

/// A reference may be of a body on the robot with other axes, as a camera's: X_WB = X_WR X_RB. Finds the rotation of
/// X_RB by which directions of motion and of turning are the estimate's [umeyama1991], and turns it back; its
/// position stays. Nullopt where the axes are the robot's, or no rotation makes the motions those of the estimate.
[[nodiscard]] std::optional<TurnedReference> turned_to_robot(const std::vector<slam::StampedPose>& reference_W,
                                                             const std::vector<slam::StampedPose>& poses_F,
                                                             const AxesRules& rules = {});

/// What is said of errors by such a reference.
inline constexpr std::string_view positions_alone_words =
    "the reference has one orientation throughout: errors of steps, of rotation and over a metre are left out";
/// Whether all poses of a reference have one orientation while the estimate turns: it holds positions alone.
[[nodiscard]] bool is_without_orientation(const std::vector<slam::StampedPose>& reference_W,
                                          const std::vector<slam::StampedPose>& poses_F);

}  // namespace plumbline::scenarios::score
