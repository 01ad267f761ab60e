// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/furniture/footprint.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"

namespace plumbline::bim {

namespace {

double body_offset(const PlanWallEntry& wall) {
  switch (wall.just) {
    case Just::center:
      return -0.5 * wall.thickness_m;
    case Just::left:
      return -wall.thickness_m;
    case Just::right:
      return 0.0;
  }
  throw InternalError("unknown justification of a wall");
}

/// Shapes of furniture follow the two plain ones, in their own order.
constexpr std::size_t plain_shapes = 2;
static_assert([] {
  constexpr auto clutter = EnumNames<ClutterShape>::names;
  constexpr auto furniture = EnumNames<FurnitureShape>::names;
  return std::equal(clutter.begin() + plain_shapes, clutter.end(), furniture.begin(), furniture.end());
}());

double radians(double deg) { return deg * std::numbers::pi / 180.0; }

/// Polygon with its corners on the ellipse of the given diameters.
Polygon2 turned_ellipse(const Eigen::Vector2d& at, const Eigen::Vector2d& size, double yaw_deg, int sides) {
  const Eigen::Rotation2Dd turn(radians(yaw_deg));
  Polygon2 polygon;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const Eigen::Vector2d p(std::cos(angle) * 0.5 * size.x(), std::sin(angle) * 0.5 * size.y());
    polygon.push_back(at + turn * p);
  }
  return polygon;
}

}  // namespace

Wall wall_of(const PlanWallEntry& entry, const PlanLevel& level) {
  Wall wall;
  wall.id = level.prefix + entry.id;
  wall.name = wall.id;
  wall.storey = level.index;
  wall.a = entry.a;
  wall.b = entry.b;
  wall.thickness_m = entry.thickness_m;
  wall.offset_m = body_offset(entry);
  wall.z0_m = level.floor_z_m;
  wall.z1_m = entry.height_m ? level.floor_z_m + *entry.height_m : level.top_z_m;
  wall.material = entry.material;
  return wall;
}

Opening opening_of(const PlanOpeningEntry& entry, const std::string& prefix, int wall_index, const Wall& wall) {
  Opening opening;
  opening.id = prefix + entry.id;
  opening.wall = wall_index;
  opening.kind = entry.kind;
  opening.s_m = entry.s_m;
  opening.width_m = entry.width_m;
  opening.z0_m = wall.z0_m + entry.sill_m;
  opening.z1_m = opening.z0_m + entry.height_m;
  opening.leaf = entry.leaf.value_or(entry.kind == OpeningKind::door ? Leaf::open : Leaf::none);
  opening.material = entry.material;
  return opening;
}

Column column_of(const PlanColumnEntry& entry, const PlanLevel& level) {
  Column column;
  column.id = level.prefix + entry.id;
  column.storey = level.index;
  column.footprint = turned_rectangle(entry.at, entry.size, radians(entry.yaw_deg));
  column.z0_m = level.floor_z_m;
  column.z1_m = entry.height_m ? level.floor_z_m + *entry.height_m : level.top_z_m;
  column.material = entry.material;
  return column;
}

std::optional<FurnitureShape> furniture_of(ClutterShape shape) {
  const auto i = static_cast<std::size_t>(shape);
  if (i < plain_shapes) return std::nullopt;
  return static_cast<FurnitureShape>(i - plain_shapes);
}

ClutterShape clutter_shape_of(FurnitureShape shape) {
  return static_cast<ClutterShape>(static_cast<std::size_t>(shape) + plain_shapes);
}

Obstacle clutter_of(const PlanClutterEntry& entry, const PlanLevel& level, int cylinder_sides) {
  Obstacle obstacle;
  obstacle.id = level.prefix + entry.id;
  obstacle.storey = level.index;
  obstacle.material = entry.material;
  if (const std::optional<FurnitureShape> shape = furniture_of(entry.shape)) {
    obstacle.kind = "furniture";
    obstacle.body = furniture_solid(*shape, {entry.size.x(), entry.size.y(), entry.height_m}, entry.at,
                                    radians(entry.yaw_deg), level.floor_z_m);
    return obstacle;
  }
  const bool round = entry.shape == ClutterShape::cylinder;
  const Polygon2 outline = round ? turned_ellipse(entry.at, entry.size, entry.yaw_deg, cylinder_sides)
                                 : turned_rectangle(entry.at, entry.size, radians(entry.yaw_deg));
  obstacle.kind = round ? "cylinder" : "box";
  obstacle.body = extrude({{outline, {}}}, level.floor_z_m, level.floor_z_m + entry.height_m);
  return obstacle;
}

}  // namespace plumbline::bim
