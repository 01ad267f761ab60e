// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "slam/rooms/room_detector.h"

namespace plumbline::slam {

/// Which of the opposed pairs of one keyframe's walls make a room: the longest, or, by the rules of 2022 [lsg2022s],
/// the pair whose ends lie nearest to each other, within windows of length and width.
enum class KeyframeRoomRule { longest, end_points };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(KeyframeRoomRule) { return {"longest", "end_points"}; }

/// Windows of the rule end_points.
struct KeyframeRoomConfig {
  KeyframeRoomRule rule = KeyframeRoomRule::longest;
  double corridor_length_m = 5.0;
  double corridor_least_width_m = 1.5, corridor_most_width_m = 2.5;
  double corridor_ends_m = 3.5;
  double room_least_length_m = 2.0, room_most_length_m = 10.0;
  double room_least_width_m = 2.5, room_most_width_m = 6.0;
  double room_ends_m = 2.5;
  double length_difference_m = 3.0;
  double width_difference_m = 2.5;

  template <class V>
  void visit(V& v) {
    v("rule", rule, Field{.doc = "which opposed pair of walls counts: the longest, or the one whose ends are nearest"});
    v("corridor_length_m", corridor_length_m, Field{.doc = "least length of a corridor's walls", .min = 0.0});
    v("corridor_least_width_m", corridor_least_width_m, Field{.doc = "least width of a corridor", .min = 0.0});
    v("corridor_most_width_m", corridor_most_width_m, Field{.doc = "greatest width of a corridor", .min = 0.0});
    v("corridor_ends_m", corridor_ends_m, Field{.doc = "greatest mean distance of its walls' ends", .min = 0.0});
    v("room_least_length_m", room_least_length_m, Field{.doc = "least length of a room's walls", .min = 0.0});
    v("room_most_length_m", room_most_length_m, Field{.doc = "greatest length of a room's walls", .min = 0.0});
    v("room_least_width_m", room_least_width_m, Field{.doc = "least width of a room", .min = 0.0});
    v("room_most_width_m", room_most_width_m, Field{.doc = "greatest width of a room", .min = 0.0});
    v("room_ends_m", room_ends_m, Field{.doc = "greatest mean distance of opposed walls' ends", .min = 0.0});
    v("length_difference_m", length_difference_m, Field{.doc = "greatest difference of opposed lengths", .min = 0.0});
    v("width_difference_m", width_difference_m, Field{.doc = "greatest difference of a room's two widths", .min = 0.0});
  }
};

/// The room or corridor that the planes seen from one keyframe close round it, without free space, in the style of
/// S-Graphs of 2022 [bavle2022]: the longest opposed pair of walls to both sides of the robot in each axis class of M
/// (ties: lower ids). Both pairs, with each wall's middle between the other two: a four-wall room; one pair: a two-wall
/// room where its walls run beside each other for min_two_wall_m. At most one candidate. By
/// the rule end_points: a corridor of either axis, and a room of a pair in each, in their windows; robot between them.
/// seen_M: walls with the stretches seen from this keyframe alone.
[[nodiscard]] std::vector<RoomCandidate> keyframe_rooms(std::span<const PlaneNode> seen_M,
                                                        const Eigen::Vector2d& robot_M, const RoomConfig& config,
                                                        const KeyframeRoomConfig& rules = {});

}  // namespace plumbline::slam
