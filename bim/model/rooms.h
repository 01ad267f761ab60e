// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Thresholds of the relations between rooms, walls and openings, m.
struct AdjacencyConfig {
  double gap_m = 0.05;        ///< a room edge this close to a wall face lies on it
  double overlap_m = 0.20;    ///< the two run along each other for more than this
  double tilt = 0.02;         ///< sine of the angle between them, at most
  double z_overlap_m = 0.2;   ///< common height of wall and room
  double walking_m = 2.0;     ///< ... counted up to this above the room's floor: walls of the next storey bound nothing
  double step_m = 0.25;       ///< distance from a wall face at which the room of an opening is looked up
  double above_sill_m = 0.5;  ///< ... and how far above the opening's lower edge
  double below_floor_m = 0.3;    ///< ... allowed below the room's floor
  double virtual_gap_m = 0.005;  ///< edges of two rooms this close have no wall between them
};

/// Name of the room with an id; its id where it has no name or there is no such room.
[[nodiscard]] std::string room_name(const std::vector<Room>& rooms, const std::string& id);

/// Length over which a room's outline runs along one side of a wall, with the room in front of that side, m.
[[nodiscard]] double shared_length(const Room& room, const Wall& wall, int side, const AdjacencyConfig& config = {});
/// Sides (0, 1) of the wall that bound the room: those its outline runs along; for a wall the room names although its
/// outline keeps away from it, the side that faces the room.
[[nodiscard]] std::vector<int> bounding_sides(const Room& room, const Wall& wall, const AdjacencyConfig& config = {});
/// Length over which the outlines of two rooms coincide without a wall between them, m.
[[nodiscard]] double open_length(const Room& a, const Room& b, const AdjacencyConfig& config = {});

/// The pieces of an outline that are free of walls, from the wall faces in, without their holes; the largest first,
/// none when walls cover it whole. `walls`: uncut walls of the same storey.
[[nodiscard]] std::vector<Polygon2> clear_outlines(const Polygon2& outline, const std::vector<Wall>& walls);

/// The smallest room that holds a point of the plan at the height above a sill or floor where rooms are looked up, or
/// -1: what stands free in a room lies within its outline. Of equal ones the first.
[[nodiscard]] int room_at(const Building& building, const Eigen::Vector2d& p, double sill_m,
                          const AdjacencyConfig& config = {});
/// The same of the given rooms, such as those near the point.
[[nodiscard]] int room_among(const Building& building, const std::vector<int>& rooms, const Eigen::Vector2d& p,
                             double sill_m, const AdjacencyConfig& config = {});

/// Fills Room::walls of every room that names none.
void find_room_walls(Building& building, const AdjacencyConfig& config = {});
/// Fills Opening::rooms of every opening through its wall from the points in front of it on either side; of several
/// rooms the smallest.
void find_opening_rooms(Building& building, const AdjacencyConfig& config = {});

}  // namespace plumbline::bim
