// SPDX-License-Identifier: Apache-2.0
#include "bim/model/rooms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/boxes.h"
#include "bim/model/through.h"
#include "bim/model/wall_face.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

/// Length over which segment c-d runs along a-b in the given sense (+1 the same way, -1 against it), within gap_m.
double overlap(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d,
               int sense, double gap_m, double tilt) {
  const double length_ab = (b - a).norm(), length_cd = (d - c).norm();
  if (length_ab == 0.0 || length_cd == 0.0) return 0.0;
  const Eigen::Vector2d u = (b - a) / length_ab, v = (d - c) / length_cd;
  const Eigen::Vector2d normal(-u.y(), u.x());
  if (sense * u.dot(v) <= 0.0 || std::abs(normal.dot(v)) > tilt) return 0.0;
  if (std::abs(normal.dot(c - a)) > gap_m || std::abs(normal.dot(d - a)) > gap_m) return 0.0;
  const double sc = u.dot(c - a), sd = u.dot(d - a);
  return std::max(0.0, std::min(length_ab, std::max(sc, sd)) - std::max(0.0, std::min(sc, sd)));
}

double common_height(const Room& room, const Wall& wall, const AdjacencyConfig& config) {
  return std::min({room.z1_m, room.z0_m + config.walking_m, wall.z1_m}) - std::max(room.z0_m, wall.z0_m);
}

/// Those of the given walls whose sides a room's outline runs along.
std::vector<int> walls_among(const Building& building, const Room& room, const std::vector<int>& walls,
                             const AdjacencyConfig& config) {
  std::vector<int> along;
  for (const int i : walls) {
    const Wall& wall = building.walls[static_cast<std::size_t>(i)];
    if (shared_length(room, wall, 0, config) > config.overlap_m ||
        shared_length(room, wall, 1, config) > config.overlap_m)
      along.push_back(i);
  }
  return along;
}

}  // namespace

std::string room_name(const std::vector<Room>& rooms, const std::string& id) {
  const auto found = std::find_if(rooms.begin(), rooms.end(), [&](const Room& room) { return room.id == id; });
  return found != rooms.end() && !found->name.empty() ? found->name : id;
}

double shared_length(const Room& room, const Wall& wall, int side, const AdjacencyConfig& config) {
  if (common_height(room, wall, config) <= config.z_overlap_m) return 0.0;
  const FaceLine face = face_line(wall, side);
  double length = 0.0;
  // The room lies left of its edges, free space left of the face: both run the same way.
  for (const Polygon2* rim : room.rims())
    for (std::size_t i = 0; i < rim->size(); ++i)
      length += overlap(face.p0, face.p1, (*rim)[i], (*rim)[(i + 1) % rim->size()], 1, config.gap_m, config.tilt);
  return length;
}

std::vector<int> bounding_sides(const Room& room, const Wall& wall, const AdjacencyConfig& config) {
  std::vector<int> sides;
  for (const int side : {0, 1})
    if (shared_length(room, wall, side, config) > config.overlap_m) sides.push_back(side);
  if (!sides.empty() || common_height(room, wall, config) <= config.z_overlap_m) return sides;
  const Eigen::Vector2d inner = interior_point(room.polygon);
  for (const int side : {0, 1})
    if (face_plane(wall, side).distance({inner.x(), inner.y(), 0.0}) > 0.0) sides.push_back(side);
  return sides;
}

double open_length(const Room& a, const Room& b, const AdjacencyConfig& config) {
  if (std::min(a.z1_m, b.z1_m) - std::max(a.z0_m, b.z0_m) <= config.z_overlap_m) return 0.0;
  double length = 0.0;
  for (const Polygon2* p : a.rims())
    for (const Polygon2* q : b.rims())
      for (std::size_t i = 0; i < p->size(); ++i)
        for (std::size_t j = 0; j < q->size(); ++j)
          length += overlap((*p)[i], (*p)[(i + 1) % p->size()], (*q)[j], (*q)[(j + 1) % q->size()], -1,
                            config.virtual_gap_m, config.tilt);
  return length;
}

std::vector<Polygon2> clear_outlines(const Polygon2& outline, const std::vector<Wall>& walls) {
  std::vector<Polygon2> footprints, pieces;
  // Walls out of the outline's reach take nothing off it; exact booleans of a whole storey for each room would.
  const Eigen::AlignedBox2d reach = box_of(outline);
  for (const Wall& wall : walls) {
    Polygon2 body = footprint(wall);
    if (box_of(body).intersects(reach)) footprints.push_back(std::move(body));
  }
  for (const PolygonWithHoles2& piece : subtract(unite(std::vector<Polygon2>{outline}), footprints))
    pieces.push_back(piece.outer);
  // Pieces of equal size keep their canonical order.
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Polygon2& a, const Polygon2& b) { return signed_area(a) > signed_area(b); });
  return pieces;
}

int room_at(const Building& building, const Eigen::Vector2d& p, double sill_m, const AdjacencyConfig& config) {
  return room_among(building, boxes_of(building.rooms).near({p}, 0.0), p, sill_m, config);
}

int room_among(const Building& building, const std::vector<int>& rooms, const Eigen::Vector2d& p, double sill_m,
               const AdjacencyConfig& config) {
  const double z = sill_m + config.above_sill_m;
  int smallest = -1;
  double least_m2 = 0.0;
  for (const int i : rooms) {
    const Room& room = building.rooms[static_cast<std::size_t>(i)];
    const bool at_height = z >= room.z0_m - config.below_floor_m && z <= room.z1_m;
    if (!at_height || !room.contains(p)) continue;
    const double area_m2 = room.area_m2();
    if (smallest >= 0 && area_m2 >= least_m2) continue;
    smallest = i;
    least_m2 = area_m2;
  }
  return smallest;
}

void find_room_walls(Building& building, const AdjacencyConfig& config) {
  const BoxIndex boxes = boxes_of(building.walls);
  for (Room& room : building.rooms)
    if (room.walls.empty()) room.walls = walls_among(building, room, boxes.near(room.polygon, config.gap_m), config);
}

void find_opening_rooms(Building& building, const AdjacencyConfig& config) {
  const BoxIndex boxes = boxes_of(building.rooms);
  for (Opening& opening : building.openings) {
    if (opening.wall < 0) continue;
    const Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    if (!goes_through(opening, wall)) continue;
    const Eigen::Vector2d on_line = wall.a + opening.s_m * wall.direction();
    // In a curved wall the opening's own depth says where its sides are.
    const Interval depth = depth_in_wall(opening, wall);
    const double left = depth.high + config.step_m, right = depth.low - config.step_m;
    const std::array<Eigen::Vector2d, 2> points = {on_line + left * wall.left(), on_line + right * wall.left()};
    for (std::size_t side = 0; side < points.size(); ++side)
      opening.rooms[side] = room_among(building, boxes.near({points[side]}, 0.0), points[side], opening.z0_m, config);
  }
}

}  // namespace plumbline::bim
