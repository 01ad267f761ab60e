// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/localization/tracker.h"

namespace plumbline::slam {

/// The plan's wall as a vertical plane in I.
[[nodiscard]] Plane plane_of(const WallLine& line);

/// Observed walls with the faces of the plan they are, at a predicted pose with this covariance of its position:
/// visible from there, Mahalanobis distance within the gate [shaheer2023, eq. 7, in the sensor's frame], patch on the
/// face. Ties: lowest line.
[[nodiscard]] std::vector<WallLink> associate_walls(const StoreyIndex& storey, const LocalizationScan& scan,
                                                    const std::vector<PlaneObservation>& planes, const Pose& X_IR,
                                                    const Eigen::Matrix2d& covariance, const TrackerConfig& config);

/// The floor of the plan, level or sloping, that an observed one is most likely to be, for a robot that stands on the
/// floor below it: its height is what a wrong one would change. standing_m: height of R above the ground. In I.
[[nodiscard]] Plane nearest_floor(const StoreyIndex& storey, const PlaneObservation& observed, Pose X_IR,
                                  double standing_m, const TrackerConfig& config);

/// Level planes under the robot: the floor, and tables beside it.
[[nodiscard]] std::vector<PlaneObservation> level_planes_below(const LocalizationScan& scan,
                                                               const std::vector<PlaneObservation>& planes,
                                                               const TrackerConfig& config);

/// Two opposed walls of the room the robot is in, as indices into TrackedPose::walls.
struct WallPair {
  int a = -1, b = -1;
};
/// Pairs whose middle fixes the robot in its room, each wall used once, widest patches first as listed.
[[nodiscard]] std::vector<WallPair> opposed_pairs(const StoreyIndex& storey, const TrackedPose& pose,
                                                  const TrackerConfig& config);

}  // namespace plumbline::slam
