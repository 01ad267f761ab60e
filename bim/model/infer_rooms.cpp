// SPDX-License-Identifier: Apache-2.0
#include "bim/model/infer_rooms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "bim/geometry/interval.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/boxes.h"
#include "bim/model/floors.h"
#include "bim/model/hull.h"
#include "bim/model/rooms.h"
#include "bim/model/wall_face.h"
#include "bim/model/wall_section.h"

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

/// A flat body that crosses the slice as a wall, its ends stretched over the joints beside it.
std::optional<Wall> front_of(const Solid& body, double slice_m, double joint_m) {
  constexpr double most_thickness_m = 0.6;
  Polygon2 corners;
  Interval height;
  for (const Eigen::Vector3d& p : body.vertices) {
    corners.push_back(p.head<2>());
    height.add(p.z());
  }
  if (height.low > slice_m || height.high < slice_m) return std::nullopt;
  const ThinRectangle rectangle = thinnest_rectangle(convex_hull(std::move(corners)));
  if (rectangle.width_m <= 0.0 || rectangle.width_m > most_thickness_m) return std::nullopt;
  Wall wall;
  const Eigen::Vector2d e = (rectangle.b - rectangle.a).normalized() * joint_m;
  wall.a = rectangle.a - e;
  wall.b = rectangle.b + e;
  wall.thickness_m = rectangle.width_m;
  wall.offset_m = -0.5 * rectangle.width_m;
  wall.z0_m = height.low;
  wall.z1_m = height.high;
  return wall;
}

/// Curtain panels, plates and mullions close rooms as walls do, and so do doors between them.
void add_fronts(const Building& building, const std::vector<FreeDoor>& doors, double slice_m, double joint_m,
                std::vector<Wall>& walls) {
  const auto add = [&](const Solid& body) {
    if (std::optional<Wall> wall = front_of(body, slice_m, joint_m)) walls.push_back(std::move(*wall));
  };
  for (const Obstacle& obstacle : building.obstacles) {
    const std::string& kind = obstacle.kind;
    if (kind == "curtain_panel" || kind == "mullion" || kind == "curtain_wall" || kind == "plate") add(obstacle.body);
  }
  for (const FreeDoor& door : doors) add(door.body);
}

/// Whether a slab or a roof reaches over the height z, m, somewhere above the middle of an outline.
bool is_covered(const Building& building, const Polygon2& outline, double z_m) {
  const Eigen::Vector2d inner = interior_point(outline);
  return std::any_of(building.slabs.begin(), building.slabs.end(),
                     [&](const Slab& slab) { return slab.z1_m > z_m && contains(slab.polygon, inner); });
}

/// The level floor that most of an outline lies on, of equal ones the lowest; the storey's elevation without one.
double floor_of(const Polygon2& outline, const std::vector<FloorPiece>& pieces, const Storey& level) {
  constexpr int across = 7;
  constexpr double least_share = 0.5, headroom_m = 1.8;
  const Eigen::AlignedBox2d box = box_of(outline);
  double best_z = level.elevation_m;
  int best = 0, inside = 0;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < across * across; ++i) {
    const Eigen::Array2d share((i % across + 0.5) / across, (i / across + 0.5) / across);
    const Eigen::Vector2d p = box.min() + (share * box.sizes().array()).matrix();
    if (!contains(outline, p)) continue;
    points.push_back(p);
    ++inside;
  }
  for (const FloorPiece& piece : pieces) {
    const bool level_piece = piece.slope.isZero(0.0) && piece.z0_m < level.elevation_m + level.height_m - headroom_m;
    if (!level_piece || !box.intersects(box_of(piece.polygon.outer))) continue;
    const auto on = static_cast<int>(
        std::count_if(points.begin(), points.end(), [&](const auto& p) { return contains(piece.polygon, p); }));
    if (on <= best || on < least_share * inside) continue;
    best = on;
    best_z = piece.z0_m;
  }
  return best_z;
}

/// Length of a room's outline along the walls of each storey, m.
std::vector<double> lengths_by_storey(const Building& building, const Room& room) {
  std::vector<double> lengths(building.storeys.size(), 0.0);
  for (const Wall& wall : building.walls)
    if (wall.storey >= 0)
      for (const int side : {0, 1}) lengths[static_cast<std::size_t>(wall.storey)] += shared_length(room, wall, side);
  return lengths;
}

/// The storey that a room belongs to among those beside its own: the one with most of its walls, of equal ones the
/// first.
int owner_of(const Building& building, const Room& room, double beside_m) {
  const auto beside = [&](std::size_t i) {
    return std::abs(building.storeys[i].elevation_m -
                    building.storeys[static_cast<std::size_t>(room.storey)].elevation_m) < beside_m;
  };
  int neighbours = 0;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) neighbours += beside(i) ? 1 : 0;
  if (neighbours < 2) return room.storey;
  const std::vector<double> lengths = lengths_by_storey(building, room);
  int best = -1;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (beside(i) && (best < 0 || lengths[i] > lengths[static_cast<std::size_t>(best)])) best = static_cast<int>(i);
  return best;
}

/// What is cut at a height: straight walls, and the footprints of all.
struct Slice {
  std::vector<Wall> walls;
  std::vector<Polygon2> footprints;
};

Slice slice_at(const Building& building, const std::vector<FreeDoor>& doors, double slice_m,
               const RoomInferenceConfig& config) {
  Slice slice;
  for (std::size_t i = 0; i < building.walls.size(); ++i) {
    const Wall& wall = building.walls[i];
    if (wall.z0_m > slice_m || wall.z1_m < slice_m) continue;
    if (is_straight(wall, openings_of(building, static_cast<int>(i)), {wall.z0_m, wall.z1_m})) {
      slice.walls.push_back(wall);
      continue;
    }
    // A curved one: its faces as walls of their own, and what is between them.
    for (Wall& face : surface_walls(wall, slice_m, config.closing_m)) slice.walls.push_back(std::move(face));
    for (const Eigen::Vector3i& t : wall.body->triangles) {
      Polygon2& triangle = slice.footprints.emplace_back();
      for (const int corner : t) triangle.push_back(wall.body->vertices[static_cast<std::size_t>(corner)].head<2>());
    }
  }
  add_fronts(building, doors, slice_m, config.closing_m, slice.walls);
  for (const Wall& wall : slice.walls) slice.footprints.push_back(footprint(grown(wall, config.closing_m)));
  return slice;
}

/// Clear outlines of what a slice encloses.
std::vector<Polygon2> enclosed_by(const Slice& slice, const RoomInferenceConfig& config) {
  std::vector<Polygon2> enclosed;
  for (const PolygonWithHoles2& piece : unite(slice.footprints)) {
    for (Polygon2 hole : piece.holes) {
      std::reverse(hole.begin(), hole.end());
      // Grown past the wall faces and cut back to them.
      const Polygon2 outline = grown(hole, 2.0 * config.closing_m);
      std::vector<Polygon2> outlines = clear_outlines(outline, walls_near(outline, slice.walls));
      if (outlines.empty() || signed_area(outlines.front()) < config.least_area_m2) continue;
      enclosed.push_back(std::move(outlines.front()));
    }
  }
  return enclosed;
}

}  // namespace

std::vector<Room> infer_rooms(const Building& building, int storey, const RoomInferenceConfig& config) {
  return infer_rooms(building, storey, floor_pieces(building), {}, config);
}

std::vector<Room> infer_rooms(const Building& building, int storey, const std::vector<FloorPiece>& all_floors,
                              const std::vector<FreeDoor>& doors, const RoomInferenceConfig& config) {
  const Storey& level = building.storeys[static_cast<std::size_t>(storey)];
  if (level.height_m < config.least_height_m) return {};
  const double slice_m = level.elevation_m + config.slice_m;
  std::vector<Polygon2> outlines = enclosed_by(slice_at(building, doors, slice_m, config), config);
  if (outlines.empty()) {
    outlines = enclosed_by(slice_at(building, doors, level.elevation_m + config.low_slice_m, config), config);
    // A parapet encloses no room.
    std::erase_if(outlines, [&](const Polygon2& outline) { return !is_covered(building, outline, slice_m); });
  }
  std::vector<FloorPiece> floors;
  std::copy_if(all_floors.begin(), all_floors.end(), std::back_inserter(floors),
               [&](const FloorPiece& piece) { return piece.storey == storey; });
  std::vector<Room> rooms;
  for (Polygon2& outline : outlines) {
    Room room;
    room.id = level.id + "/room" + std::to_string(rooms.size() + 1);
    room.name = "room " + std::to_string(rooms.size() + 1);
    room.storey = storey;
    room.polygon = std::move(outline);
    room.z0_m = floor_of(room.polygon, floors, level);
    room.z1_m = level.elevation_m + level.height_m;
    if (owner_of(building, room, config.beside_m) == storey) rooms.push_back(std::move(room));
  }
  return rooms;
}

}  // namespace plumbline::bim
