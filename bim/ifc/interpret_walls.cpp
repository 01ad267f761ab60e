// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/ifc/interpret.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/wall_frame.h"

namespace plumbline::bim {
namespace {

constexpr double shortest_line_m = 1e-3;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

/// Range of the points of a solid in the frame of a wall, along one of its axes.
Range range_in(const Wall& wall, const Solid& solid, int axis) {
  const WallFrame frame(wall);
  Range range;
  for (const Eigen::Vector3d& p_W : solid.vertices) range.add(frame.to_wall(p_W)[axis]);
  return range;
}

/// The filling of each opening by STEP number; of several the one with the lowest GlobalId.
std::map<std::int64_t, const StepProduct*> fillings(const StepModel& model) {
  std::map<std::int64_t, const StepProduct*> by_opening;
  for (const StepProduct& product : model.products) {
    const bool fills = product.kind == StepClass::door || product.kind == StepClass::window;
    if (fills && product.host != 0) by_opening.try_emplace(product.host, &product);
  }
  return by_opening;
}

}  // namespace

/// Axis where the file has one, otherwise the body's extent along the placement's x axis.
void Interpreter::read_reference_line(const StepProduct& product, const Solid& body, Wall& wall) {
  const auto on_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(snapped(p.x()), snapped(p.y())); };
  if (product.axis_W.size() >= 2) {
    wall.a = on_plan(product.axis_W.front().head<2>());
    wall.b = on_plan(product.axis_W.back().head<2>());
    if (product.axis_W.size() > 2) warn(product, "curved_axis", "the axis is taken as straight");
  }
  if (wall.length() >= shortest_line_m) return;
  const Eigen::Vector2d origin = product.X_WP.translation().head<2>();
  const Eigen::Vector2d along = product.X_WP.linear().col(0).head<2>();
  if (along.norm() < shortest_line_m) return;
  Range range;
  for (const Eigen::Vector3d& p : body.vertices) range.add((p.head<2>() - origin).dot(along.normalized()));
  wall.a = on_plan(origin + range.low * along.normalized());
  wall.b = on_plan(origin + range.high * along.normalized());
  warn(product, "no_axis", "the reference line is the body's extent along the placement's x axis");
}

/// Faces from the layer set [facts: the reference line is not a face], from the body where the two differ.
void Interpreter::read_faces(const StepProduct& product, const Solid& body, Wall& wall) {
  const Range across = range_in(wall, body, 1);
  wall.offset_m = snapped(across.low);
  wall.thickness_m = snapped(across.high - across.low);
  if (!product.layers) return warn(product, "no_layers", "offset and thickness are those of the body");
  // Layers are counted along the placement's y axis, the wall's offset to the left of a to b.
  const double side = product.X_WP.linear().col(1).head<2>().dot(wall.left()) < 0.0 ? -1.0 : 1.0;
  Range layers;
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
    Solid body = body_of(product);
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
}

void Interpreter::add_openings() {
  const auto filling_of = fillings(model_);
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::opening) continue;
    std::vector<Solid> solids = solids_of(product);
    const auto host = walls_.find(product.host);
    if (solids.empty() || host == walls_.end()) {
      std::vector<Solid>& cuts = slab_openings_[product.host];
      cuts.insert(cuts.end(), solids.begin(), solids.end());
      continue;
    }
    Opening opening;
    opening.id = product.id;
    opening.step_id = product.step_id;
    opening.wall = host->second;
    const Wall& wall = building_.walls[static_cast<std::size_t>(host->second)];
    const Solid all = joined(solids);
    const Range along = range_in(wall, all, 0), height = range_in(wall, all, 2);
    opening.s_m = snapped((along.low + along.high) / 2.0);
    opening.width_m = snapped(along.high - along.low);
    opening.z0_m = snapped(height.low);
    opening.z1_m = snapped(height.high);
    const auto filling = filling_of.find(product.step_id);
    const bool filled = filling != filling_of.end();
    opening.kind = !filled                                    ? OpeningKind::opening_void
                   : filling->second->kind == StepClass::door ? OpeningKind::door
                                                              : OpeningKind::window;
    opening.leaf = opening.kind == OpeningKind::door ? Leaf::open : Leaf::none;
    if (filled) opening.filling_id = filling->second->id;
    opening.solid = std::move(solids.front());
    opening.parts.assign(std::make_move_iterator(solids.begin() + 1), std::make_move_iterator(solids.end()));
    building_.openings.push_back(std::move(opening));
  }
}

}  // namespace plumbline::bim
