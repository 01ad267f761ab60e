// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "slam/rooms/room_detector.h"

namespace plumbline::slam {

/// The room or corridor that the planes seen from one keyframe close round it, without free space, in the style of
/// S-Graphs of 2022 [bavle2022]: the longest opposed pair of walls to both sides of the robot in each axis class of M
/// (ties: lower ids). Both pairs, with each wall's middle between the other two: a four-wall room; one pair: a two-wall
/// room where its walls run beside each other for min_two_wall_m. At most one candidate. seen_M: walls with the
/// stretches seen from this keyframe alone.
[[nodiscard]] std::vector<RoomCandidate> keyframe_rooms(std::span<const PlaneNode> seen_M,
                                                        const Eigen::Vector2d& robot_M, const RoomConfig& config);

}  // namespace plumbline::slam
