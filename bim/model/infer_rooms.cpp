// SPDX-License-Identifier: Apache-2.0
#include "bim/model/infer_rooms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/boxes.h"
#include "bim/model/rooms.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {
namespace {

/// The wall made longer and thicker by `margin_m` on every side.
Wall grown(Wall wall, double margin_m) {
  const Eigen::Vector2d e = wall.direction() * margin_m;
  wall.a -= e;
  wall.b += e;
  wall.offset_m -= margin_m;
  wall.thickness_m += 2.0 * margin_m;
  return wall;
}

/// A counter-clockwise polygon with every edge moved outward, up to where the moved lines meet: the polygon joined with
/// a band along each edge and a kite at each corner that points outward. (Moving the corners instead would fold
/// edges shorter than the margin over.)
Polygon2 grown(const Polygon2& polygon, double margin_m) {
  std::vector<Polygon2> parts = {polygon};
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &p = polygon[i], &q = polygon[(i + 1) % n];
    const Eigen::Vector2d u = (p - polygon[(i + n - 1) % n]).normalized(), v = (q - p).normalized();
    const Eigen::Vector2d out_u = margin_m * Eigen::Vector2d(u.y(), -u.x());
    const Eigen::Vector2d out_v = margin_m * Eigen::Vector2d(v.y(), -v.x());
    parts.push_back({p, p + out_v, q + out_v, q});
    // p + m with m.out_u = m.out_v = margin^2 lies on the bisector; a hairpin gets no kite.
    const double lean = 1.0 + u.dot(v);
    const bool outward = u.x() * v.y() - u.y() * v.x() > 0.0;
    if (outward && lean > 0.1) parts.push_back({p, p + out_u, p + (out_u + out_v) / lean, p + out_v});
  }
  const Region2 region = unite(parts);
  return region.empty() ? polygon : region.front().outer;
}

/// Walls that can cut an outline: all others would only cost time.
std::vector<Wall> walls_near(const Polygon2& outline, const std::vector<Wall>& walls) {
  const Eigen::AlignedBox2d box = box_of(outline);
  std::vector<Wall> near;
  for (const Wall& wall : walls)
    if (box.intersects(box_of(footprint(wall)))) near.push_back(wall);
  return near;
}

}  // namespace

std::vector<Room> infer_rooms(const Building& building, int storey, const RoomInferenceConfig& config) {
  const Storey& level = building.storeys[static_cast<std::size_t>(storey)];
  if (level.height_m < config.least_height_m) return {};
  const double slice_m = level.elevation_m + config.slice_m;
  std::vector<Wall> walls;
  for (const Wall& wall : building.walls)
    if (wall.z0_m <= slice_m && wall.z1_m >= slice_m) walls.push_back(wall);
  std::vector<Polygon2> footprints;
  for (const Wall& wall : walls) footprints.push_back(footprint(grown(wall, config.closing_m)));
  std::vector<Room> rooms;
  for (const PolygonWithHoles2& piece : unite(footprints)) {
    for (Polygon2 hole : piece.holes) {
      std::reverse(hole.begin(), hole.end());
      // Grown past the wall faces and cut back to them.
      const Polygon2 outline = grown(hole, 2.0 * config.closing_m);
      const std::vector<Polygon2> outlines = clear_outlines(outline, walls_near(outline, walls));
      if (outlines.empty() || signed_area(outlines.front()) < config.least_area_m2) continue;
      Room room;
      room.id = level.id + "/room" + std::to_string(rooms.size() + 1);
      room.name = "room " + std::to_string(rooms.size() + 1);
      room.storey = storey;
      room.polygon = outlines.front();
      room.z0_m = level.elevation_m;
      room.z1_m = level.elevation_m + level.height_m;
      rooms.push_back(std::move(room));
    }
  }
  return rooms;
}

}  // namespace plumbline::bim
