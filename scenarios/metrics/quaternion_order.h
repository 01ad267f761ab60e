// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/metrics/trajectory.h"
#include "slam/io/recordings/trajectory.h"

namespace plumbline::scenarios::score {

/// Rules of the order of quaternions. A quaternion read in the wrong order is a rotation all the same; what it breaks
/// is the motion between poses, seen from the robot. On 20 s of the walk `house` vgicp's poses are off by 0.03 m over
/// each metre, in the wrong order by 1.3 m; the limits between are assumed.
struct OrderRules {
  double least_error_m = 0.5;    ///< over each metre, as read; below, nothing is wrong with the order
  double most_of_as_read = 0.2;  ///< what is left of it in the other order
};

/// Why poses are in the order that their file's form does not have: a clause; empty: they are not, or their walk is too
/// short or too straight to tell. The errors are those over each metre, as read and in the other order.
[[nodiscard]] std::string wrong_order(slam::TrajectoryForm form, std::optional<double> as_read_m,
                                      std::optional<double> other_m, const OrderRules& rules = {});

/// The same of an estimate of a walk whose truth is known.
[[nodiscard]] std::string wrong_order(slam::TrajectoryForm form, const std::vector<slam::StampedPose>& poses_F,
                                      const Truth& truth);

}  // namespace plumbline::scenarios::score
