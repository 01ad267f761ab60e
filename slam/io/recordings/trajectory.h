// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/estimate.h"

namespace plumbline::slam {

/// Forms of a file of poses.
enum class TrajectoryForm {
  tum,    ///< [sturm2012]: "t tx ty tz qx qy qz qw", s
  kitti,  ///< [geiger2012]: the first three rows of the pose's 4 x 4 matrix, without a time
  euroc   ///< [burri2016]: "t,px,py,pz,qw,qx,qy,qz" and what may follow, ns
};

/// By the first line that is no comment: commas are EuRoC's, 12 columns KITTI's; all else is taken for TUM.
[[nodiscard]] TrajectoryForm trajectory_form(std::string_view text);

/// Reads poses of any form; lines that start with # and empty ones are skipped. `scans`: stamps for a KITTI file, whose
/// line i is the pose at scan i. Throws InputError naming the line, as read_tum() does, also where a matrix is no
/// rotation, and where a KITTI file has another number of poses than there are scans.
[[nodiscard]] std::vector<StampedPose> read_trajectory(std::string_view text, const std::string& file,
                                                       std::span<const Nanoseconds> scans);

/// Poses of KITTI's form, in order. Throws InputError naming the line that is wrong.
[[nodiscard]] std::vector<Pose> read_kitti(std::string_view text, const std::string& file);

/// The poses that a file would have, were its quaternions in the order that its form does not have: w first in a TUM
/// file, w last in a EuRoC one. The same poses where the form is KITTI's, which has none.
[[nodiscard]] std::vector<StampedPose> in_other_order(std::vector<StampedPose> poses, TrajectoryForm form);

}  // namespace plumbline::slam
