// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/boolean.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/wall_cut.h"
#include "bim/model/body_section.h"
#include "bim/model/extrude.h"
#include "bim/model/hull.h"
#include "bim/model/straight_pieces.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {
namespace {

constexpr double shortest_line_m = 1e-3;

ThinRectangle rectangle_around(const Solid& body) {
  Polygon2 corners;
  for (const Eigen::Vector3d& p : body.vertices) corners.push_back(p.head<2>());
  return thinnest_rectangle(convex_hull(std::move(corners)));
}

/// Through the placement along its x axis where the body lies on that, otherwise the middle of the thinnest
/// rectangle around it, in the sense of that axis.
std::pair<Eigen::Vector2d, Eigen::Vector2d> line_along(const StepProduct& product, const Solid& body) {
  constexpr double most_wider = 1.02, beside_m = 1.0;
  const Eigen::Vector2d origin = product.X_WP.translation().head<2>();
  const Eigen::Vector2d x = product.X_WP.linear().col(0).head<2>();
  const ThinRectangle thinnest = rectangle_around(body);
  const Eigen::Vector2d line = thinnest.b - thinnest.a;
  if (x.norm() >= shortest_line_m) {
    const Eigen::Vector2d e = x.normalized(), left(-e.y(), e.x());
    Interval along, across;
    for (const Eigen::Vector3d& p : body.vertices) {
      along.add((p.head<2>() - origin).dot(e));
      across.add((p.head<2>() - origin).dot(left));
    }
    const bool on_axis = across.low < beside_m && across.high > -beside_m;
    const bool slim = on_axis && along.length() >= across.length() &&
                      along.length() * across.length() <= most_wider * line.norm() * thinnest.width_m;
    if (slim || line.norm() < shortest_line_m) return {origin + along.low * e, origin + along.high * e};
    if (line.dot(e) < 0.0) return {thinnest.b, thinnest.a};
  }
  return {thinnest.a, thinnest.b};
}

/// What the wall's body has in common with a column of the outline; no triangles where that cannot be said.
Solid part_within(const Wall& wall, bool upright, const Polygon2& outline) {
  constexpr double beyond_m = 1.0;
  const Region2 base = unite(std::vector<Polygon2>{outline});
  if (upright) return extrude(base, wall.z0_m, wall.z1_m);
  const double grid_m = MeshConfig{}.weld_m;
  const std::vector<BooleanStep> column{
      {BooleanOperation::intersection, extrude(base, wall.z0_m - beyond_m, wall.z1_m + beyond_m)}};
  BooleanResult part = boolean_steps(*wall.body, column, grid_m);
  return part.closed && part.failed.empty() ? canonical(part.solid, grid_m) : Solid{};
}

/// The wall as one for each straight piece of its section, or none where it has no such pieces.
std::vector<Wall> pieces_of(const Wall& wall, double grid_m) {
  constexpr double same = 0.01, most_stepped_m = 1.0;
  const auto on_plan = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(snap(p.x(), grid_m), snap(p.y(), grid_m));
  };
  const Region2 section = body_section(*wall.body, 0.5 * (wall.z0_m + wall.z1_m));
  const double whole = std::abs(volume(*wall.body)), prism = area(section) * (wall.z1_m - wall.z0_m);
  const bool upright =
      std::abs(prism - whole) < same * whole && area(footprint(*wall.body)) < (1.0 + same) * area(section);
  double held = 0.0;
  std::vector<Wall> walls;
  for (const Polygon2& outline : straight_pieces(section)) {
    Wall piece = wall;
    if (!walls.empty()) piece.id += "/" + std::to_string(walls.size() + 1);
    piece.body = part_within(wall, upright, outline);
    if (piece.body->triangles.empty()) return {};
    held += volume(*piece.body);
    const ThinRectangle rectangle = thinnest_rectangle(convex_hull(outline));
    piece.a = on_plan(rectangle.a);
    piece.b = on_plan(rectangle.b);
    piece.thickness_m = snap(rectangle.width_m, grid_m);
    piece.offset_m = -0.5 * piece.thickness_m;
    const Extent box = extent(*piece.body);
    piece.z0_m = snap(box.low.z(), grid_m);
    piece.z1_m = snap(box.high.z(), grid_m);
    walls.push_back(std::move(piece));
  }
  // One that is only stepped along its line stays whole.
  const bool stepped =
      wall.thickness_m < most_stepped_m && std::all_of(walls.begin(), walls.end(), [&](const Wall& piece) {
        return std::abs(piece.direction().dot(wall.left())) < same;
      });
  return stepped || held < (1.0 - same) * whole ? std::vector<Wall>{} : walls;
}

}  // namespace

/// Axis where the file has one, otherwise a line along the body.
void Interpreter::read_reference_line(const StepProduct& product, const Solid& body, Wall& wall) {
  const auto on_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(snapped(p.x()), snapped(p.y())); };
  if (product.axis_W.size() >= 2) {
    wall.a = on_plan(product.axis_W.front().head<2>());
    wall.b = on_plan(product.axis_W.back().head<2>());
    if (product.axis_W.size() > 2)
      warn(product, "curved_axis", "the axis is taken as straight; what methods are told of it is wrong");
  }
  if (wall.length() >= shortest_line_m) return;
  const auto [a, b] = line_along(product, body);
  if ((b - a).norm() < shortest_line_m) return;
  wall.a = on_plan(a);
  wall.b = on_plan(b);
  warn(product, "no_axis", "the reference line is the body's longer extent on the plan");
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
    if (product.axis_W.size() > 2) return;  // what the body is compared with is the rectangle around it
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
    add_straightened(product, std::move(wall));
  }
  if (!building_.walls.empty()) return;
  for (const StepProduct& product : model_.products)
    if (is_of_layers(product)) take_as_wall(product);
  for (const StepProduct& product : model_.products)
    if (is_nameless(product)) take_as_wall(product);
}

/// False where the body is not straight either.
bool Interpreter::take_line_of_body(const StepProduct& product, Wall& wall) {
  constexpr double least_straight = 0.95;  // of its box along the line; assumed
  Wall along = wall;
  const auto on_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(snapped(p.x()), snapped(p.y())); };
  const auto [a, b] = line_along(product, *wall.body);
  along.a = on_plan(a);
  along.b = on_plan(b);
  if (along.length() < shortest_line_m) return false;
  const Interval across = extent_across(WallFrame(along), {*wall.body});
  along.offset_m = snapped(across.low);
  along.thickness_m = snapped(across.length());
  if (fill_of(along) < least_straight) return false;
  wall = std::move(along);
  warn(product, "no_axis", "its axis contradicts its body; the reference line is the body's longer extent on the plan");
  return true;
}

void Interpreter::add_straightened(const StepProduct& product, Wall wall) {
  std::vector<Wall> pieces;
  bool bent = fill_of(wall) < config_.least_fill;
  if (bent && product.axis_W.size() == 2) bent = !take_line_of_body(product, wall);
  if (bent && product.axis_W.size() <= 2) pieces = pieces_of(wall, config_.grid_m);
  if (bent)
    warn(product, "bent_wall",
         pieces.empty() ? "its body is not straight; its rectangle on the plan is larger than its body"
                        : "its body is not straight; it becomes " + std::to_string(pieces.size()) + " walls");
  if (pieces.empty()) pieces.push_back(std::move(wall));
  for (Wall& piece : pieces) {
    walls_[product.step_id].push_back(static_cast<int>(building_.walls.size()));
    building_.walls.push_back(std::move(piece));
  }
}

/// An element that stands on the plan as a long thin rectangle, and is as high as a wall.
void Interpreter::take_as_wall(const StepProduct& product) {
  const LookalikeConfig config;
  const std::string kind = obstacle_kind(product.type);
  if (kind != "proxy" && kind != "plate" && kind != "part" && !is_of_layers(product)) return;
  Solid body = product.has_body ? joined(uncut_solids(product)) : layers_of(product);
  if (body.triangles.empty()) return;
  const Extent box = extent(body);
  if (box.high.z() - box.low.z() < config.least_height_m) return;
  const ThinRectangle rectangle = rectangle_around(body);
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
  if (!product.has_body)
    for (const StepProduct* part : parts_[product.step_id]) taken_.insert(part->step_id);
  walls_[product.step_id].push_back(static_cast<int>(building_.walls.size()));
  building_.walls.push_back(std::move(wall));
}

}  // namespace plumbline::bim
