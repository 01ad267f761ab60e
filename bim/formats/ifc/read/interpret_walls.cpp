// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"
#include "bim/model/hull.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {
namespace {

constexpr double shortest_line_m = 1e-3;

}  // namespace

/// Axis where the file has one, otherwise the body's extent along the placement's x axis.
void Interpreter::read_reference_line(const StepProduct& product, const Solid& body, Wall& wall) {
  const auto on_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(snapped(p.x()), snapped(p.y())); };
  if (product.axis_W.size() >= 2) {
    wall.a = on_plan(product.axis_W.front().head<2>());
    wall.b = on_plan(product.axis_W.back().head<2>());
    if (product.axis_W.size() > 2)
      warn(product, "curved_axis", "the axis is taken as straight; what methods are told of it is wrong");
  }
  if (wall.length() >= shortest_line_m) return;
  const Eigen::Vector2d origin = product.X_WP.translation().head<2>();
  const Eigen::Vector2d along = product.X_WP.linear().col(0).head<2>();
  if (along.norm() < shortest_line_m) return;
  Interval range;
  for (const Eigen::Vector3d& p : body.vertices) range.add((p.head<2>() - origin).dot(along.normalized()));
  wall.a = on_plan(origin + range.low * along.normalized());
  wall.b = on_plan(origin + range.high * along.normalized());
  warn(product, "no_axis", "the reference line is the body's extent along the placement's x axis");
}

/// Faces from the layer set, from the body where the two differ.
void Interpreter::read_faces(const StepProduct& product, const Solid& body, Wall& wall) {
  const Interval across = extent_across(WallFrame(wall), {body});
  wall.offset_m = snapped(across.low);
  wall.thickness_m = snapped(across.length());
  if (!product.layers) return warn(product, "no_layers", "offset and thickness are those of the body");
  // Layers are counted along the placement's y axis, the wall's offset to the left of a to b.
  const double side = product.X_WP.linear().col(1).head<2>().dot(wall.left()) < 0.0 ? -1.0 : 1.0;
  Interval layers;
  layers.add(side * product.layers->offset_m);
  layers.add(side * (product.layers->offset_m + product.layers->sense * product.layers->thickness_m));
  const double off = std::max(std::abs(layers.low - across.low), std::abs(layers.high - across.high));
  if (off > config_.layer_match_m) {
    return warn(product, "layer_mismatch",
                "layers and body differ by " + std::to_string(std::lround(off * 1e3)) + " mm; the body counts");
  }
  wall.offset_m = snapped(layers.low);
  wall.thickness_m = snapped(product.layers->thickness_m);
}

void Interpreter::add_walls() {
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::wall) continue;
    Solid body = body_of(product);  // openings are found later, and cut in the mesh
    if (body.triangles.empty()) continue;
    Wall wall;
    wall.id = product.id;
    wall.name = product.name;
    wall.step_id = product.step_id;
    wall.material = product.material;
    const Extent box = extent(body);
    wall.z0_m = snapped(box.low.z());
    wall.z1_m = snapped(box.high.z());
    wall.storey = storey_index(product, wall.z0_m);
    read_reference_line(product, body, wall);
    if (wall.length() < shortest_line_m) {
      warn(product, "no_axis", "has no direction on the plan, and is left out");
      continue;
    }
    read_faces(product, body, wall);
    wall.body = std::move(body);
    walls_[product.step_id] = static_cast<int>(building_.walls.size());
    building_.walls.push_back(std::move(wall));
  }
  if (!building_.walls.empty()) return;
  for (const StepProduct& product : model_.products)
    if (is_nameless(product)) take_as_wall(product);
}

/// An element that stands on the plan as a long thin rectangle, and is as high as a wall.
void Interpreter::take_as_wall(const StepProduct& product) {
  const LookalikeConfig config;
  const std::string kind = obstacle_kind(product.type);
  if (kind != "proxy" && kind != "plate") return;
  Solid body = joined(uncut_solids(product));
  if (body.triangles.empty()) return;
  const Extent box = extent(body);
  if (box.high.z() - box.low.z() < config.least_height_m) return;
  Polygon2 corners;
  for (const Eigen::Vector3d& p : body.vertices) corners.push_back(p.head<2>());
  const ThinRectangle rectangle = thinnest_rectangle(convex_hull(std::move(corners)));
  const double thickness = rectangle.width_m, length = (rectangle.b - rectangle.a).norm();
  if (thickness > config.most_thickness_m || thickness < shortest_line_m) return;
  if (length < std::max(config.least_length_m, 2.0 * thickness)) return;
  if (area(footprint(body)) < config.least_fill * thickness * length) return;
  Wall wall;
  wall.id = product.id;
  wall.name = product.name;
  wall.step_id = product.step_id;
  wall.material = product.material;
  wall.z0_m = snapped(box.low.z());
  wall.z1_m = snapped(box.high.z());
  wall.storey = storey_index(product, wall.z0_m);
  const auto on_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(snapped(p.x()), snapped(p.y())); };
  wall.a = on_plan(rectangle.a);
  wall.b = on_plan(rectangle.b);
  wall.thickness_m = snapped(thickness);
  wall.offset_m = -0.5 * wall.thickness_m;
  warn(product, "taken_as_wall", "the file has no IfcWall; this stands like one");
  wall.body = std::move(body);
  taken_.insert(product.step_id);
  walls_[product.step_id] = static_cast<int>(building_.walls.size());
  building_.walls.push_back(std::move(wall));
}

}  // namespace plumbline::bim
