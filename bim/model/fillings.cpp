// SPDX-License-Identifier: Apache-2.0
#include "bim/model/fillings.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"
#include "bim/model/materials.h"
#include "bim/model/permanence.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

constexpr std::string_view leaf_kind = "door_leaf";
constexpr std::string_view pane_kind = "window_pane";
/// Furniture, and coverings of floors and ceilings, which may not lie yet.
bool is_left_out(const Obstacle& obstacle) {
  return permanence_of(obstacle) == Permanence::furniture || (obstacle.planned && obstacle.kind == "covering");
}

/// The opening's rectangle as a plate in the middle of its wall; it leans with the wall.
Solid plate(const Opening& opening, const Wall& wall, double thickness_m) {
  const WallFrame frame(wall);
  const double half = 0.5 * std::min(thickness_m, wall.thickness_m);
  const double middle = wall.offset_m + 0.5 * wall.thickness_m;
  const double s0 = opening.s_m - 0.5 * opening.width_m, s1 = opening.s_m + 0.5 * opening.width_m;
  const Polygon2 outline = {{s0, opening.z0_m}, {s1, opening.z0_m}, {s1, opening.z1_m}, {s0, opening.z1_m}};
  const auto at = [&](double y) {
    return [&frame, y](const Eigen::Vector2d& p) { return frame.to_world({p.x(), y, p.y()}); };
  };
  return extrude_between({{outline, {}}}, at(middle + half), at(middle - half));
}

void fill(Building& building, const Opening& opening, std::string_view kind, double thickness_m,
          const std::string& material) {
  const Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
  Obstacle obstacle;
  obstacle.id = opening.id + (kind == leaf_kind ? "/leaf" : "/pane");
  obstacle.kind = kind;
  obstacle.storey = wall.storey;
  obstacle.body = plate(opening, wall, thickness_m);
  obstacle.material = material;
  building.obstacles.push_back(std::move(obstacle));
}

}  // namespace

bool is_filling(const Obstacle& obstacle) { return obstacle.kind == leaf_kind || obstacle.kind == pane_kind; }

void apply_options(Building& building, const BuildingOptions& options) {
  if (!options.furniture) std::erase_if(building.obstacles, is_left_out);
  if (options.doors == Doors::as_designed) return;
  for (Opening& opening : building.openings)
    if (opening.kind == OpeningKind::door && opening.leaf != Leaf::none)
      opening.leaf = options.doors == Doors::open ? Leaf::open : Leaf::closed;
}

void add_fillings(Building& building, const FillingConfig& config) {
  // A building that was written as built comes with them.
  std::set<std::string> there;
  for (const Obstacle& obstacle : building.obstacles)
    if (is_filling(obstacle)) there.insert(obstacle.id);
  for (const Opening& opening : building.openings) {
    if (there.contains(opening.id + "/leaf") || there.contains(opening.id + "/pane")) continue;
    if (opening.wall < 0 || opening.width_m <= 0.0 || opening.z1_m <= opening.z0_m) continue;
    if (opening.kind == OpeningKind::door && opening.leaf == Leaf::closed)
      fill(building, opening, leaf_kind, config.leaf_m, opening.material);
    if (opening.kind == OpeningKind::window)
      fill(building, opening, pane_kind, config.pane_m,
           opening.material.empty() ? config.pane_material : opening.material);
  }
}

}  // namespace plumbline::bim
