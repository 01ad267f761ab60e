// SPDX-License-Identifier: Apache-2.0
#include "bim/model/fillings.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/body_section.h"
#include "bim/model/extrude.h"
#include "bim/model/floors.h"
#include "bim/model/materials.h"
#include "bim/model/permanence.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

constexpr std::string_view leaf_kind = "door_leaf";
constexpr std::string_view pane_kind = "window_pane";

/// Furniture, and coverings of walls and ceilings, which may not be there yet.
bool is_left_out(const Building& building, const Obstacle& obstacle) {
  if (permanence_of(obstacle) == Permanence::furniture) return true;
  return obstacle.planned && obstacle.kind == "covering" && !is_floor_covering(building, obstacle);
}

/// Where a plate stands on the plan: its middle, the unit vector along it, and its length.
struct PlatePlace {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), along = Eigen::Vector2d::UnitX();
  double length_m = 0.0;
};

/// The direction in which a polygon is longest: the principal axis of the second moments of its triangles.
Eigen::Vector2d long_axis(const Polygon2& polygon) {
  const Eigen::Vector2d middle = centroid(polygon);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - middle, b = polygon[(i + 1) % polygon.size()] - middle;
    const double twice_area = a.x() * b.y() - a.y() * b.x();
    moments += twice_area * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  const double angle = 0.5 * std::atan2(2.0 * moments(0, 1), moments(0, 0) - moments(1, 1));
  return {std::cos(angle), std::sin(angle)};
}

/// Along a wall where it passes a place: its section around there is longer than thick.
Eigen::Vector2d tangent_at(const Region2& section, const Eigen::Vector2d& place) {
  constexpr double around_m = 1.0;
  const Eigen::Vector2d u(around_m, around_m), v(around_m, -around_m);
  const Region2 near = intersect(section, unite(std::vector<Polygon2>{{place - u, place + v, place + u, place - v}}));
  const auto here = std::find_if(near.begin(), near.end(), [&](const auto& piece) { return contains(piece, place); });
  return long_axis(here == near.end() ? section.front().outer : here->outer);
}

/// In the middle of what an opening cuts out of a bent wall's body, halfway up: a plate in the middle of the wall's
/// rectangle would hang in the room. Nullopt for a straight wall.
std::optional<PlatePlace> place_in_bent_wall(const Opening& opening, const Wall& wall) {
  constexpr double least_fill = 0.6;
  const std::vector<Solid> hole = solids_of(opening);
  if (hole.empty() || fill_of(wall) >= least_fill) return std::nullopt;
  const double z = 0.5 * (opening.z0_m + opening.z1_m);
  const Region2 section = wall_section(wall, z);
  Region2 cut;
  for (const Solid& part : hole)
    for (const PolygonWithHoles2& piece : intersect(body_section(part, z), section)) cut.push_back(piece);
  if (cut.empty()) return std::nullopt;
  const Polygon2& largest = std::max_element(cut.begin(), cut.end(), [](const auto& p, const auto& q) {
                              return signed_area(p.outer) < signed_area(q.outer);
                            })->outer;
  PlatePlace place;
  place.middle = centroid(largest);
  place.along = tangent_at(section, place.middle);
  Interval extent;
  for (const Eigen::Vector2d& p : largest) extent.add((p - place.middle).dot(place.along));
  place.middle += 0.5 * (extent.low + extent.high) * place.along;
  place.length_m = extent.length();
  return place;
}

/// The opening's rectangle as a plate in the middle of its wall; it leans with a straight one.
Solid plate(const Opening& opening, const Wall& wall, double thickness_m) {
  const double half = 0.5 * std::min(thickness_m, wall.thickness_m);
  if (const std::optional<PlatePlace> place = place_in_bent_wall(opening, wall)) {
    const Eigen::Vector2d u = 0.5 * place->length_m * place->along,
                          v(-half * place->along.y(), half * place->along.x());
    const Eigen::Vector2d& m = place->middle;
    return extrude({{{m - u - v, m + u - v, m + u + v, m - u + v}, {}}}, opening.z0_m, opening.z1_m);
  }
  const WallFrame frame(wall);
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
  if (!options.furniture)
    std::erase_if(building.obstacles, [&](const Obstacle& obstacle) { return is_left_out(building, obstacle); });
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
