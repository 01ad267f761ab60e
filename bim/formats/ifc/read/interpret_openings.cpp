// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {
namespace {

/// The filling of each opening by STEP number; of several the one with the lowest GlobalId.
std::map<std::int64_t, const StepProduct*> fillings(const StepModel& model) {
  std::map<std::int64_t, const StepProduct*> by_opening;
  for (const StepProduct& product : model.products) {
    const bool fills = product.kind == StepClass::door || product.kind == StepClass::window;
    if (fills && product.host != 0) by_opening.try_emplace(product.host, &product);
  }
  return by_opening;
}

/// Ranges of a solid in the frame of a wall: along, across, upright.
struct WallBox {
  Interval along, across, height;
};

WallBox box_in(const Wall& wall, const std::vector<Solid>& solids) {
  const WallFrame frame(wall);
  WallBox box;
  for (const Solid& solid : solids) {
    for (const Eigen::Vector3d& p_W : solid.vertices) {
      const Eigen::Vector3d p = frame.to_wall(p_W);
      box.along.add(p.x());
      box.across.add(p.y());
      box.height.add(p.z());
    }
  }
  return box;
}

double overlap(const Interval& a, const Interval& b) { return std::max(0.0, -gap(a, b)); }

/// Area that two boxes have in common in the wall's elevation, m^2; 0 where they lie apart across it.
double common_area(const WallBox& a, const WallBox& b, double slack_m) {
  if (overlap({a.across.low - slack_m, a.across.high + slack_m}, b.across) <= 0.0) return 0.0;
  return overlap(a.along, b.along) * overlap(a.height, b.height);
}

double area(const WallBox& box) { return box.along.length() * box.height.length(); }

}  // namespace

/// The wall that an opening is said to cut; where that is a group of walls, those of the group it reaches into, and
/// where it is a part of a wall, that wall.
std::vector<int> Interpreter::host_walls(const StepProduct& opening, const std::vector<Solid>& solids) const {
  for (const StepProduct* host = find(opening.host); host != nullptr; host = find(host->whole)) {
    const auto wall = walls_.find(host->step_id);
    if (wall != walls_.end()) return {wall->second};
    std::vector<int> reached;
    const auto parts = parts_.find(host->step_id);
    if (parts == parts_.end()) continue;
    for (const StepProduct* part : parts->second) {
      const auto found = walls_.find(part->step_id);
      if (found == walls_.end()) continue;
      const Wall& candidate = building_.walls[static_cast<std::size_t>(found->second)];
      if (common_area(box_in(candidate, {*candidate.body}), box_in(candidate, solids), 0.0) > config_.least_cut_m2)
        reached.push_back(found->second);
    }
    if (!reached.empty()) return reached;
  }
  return {};
}

void Interpreter::fill(Opening& opening, const StepProduct& filling) const {
  opening.kind = filling.kind == StepClass::door ? OpeningKind::door : OpeningKind::window;
  opening.leaf = opening.kind == OpeningKind::door ? Leaf::open : Leaf::none;
  opening.material = opening.kind == OpeningKind::window ? "glass" : "";
  opening.filling_id = filling.id;
}

void Interpreter::add_opening(const StepProduct& product, int wall, const std::vector<Solid>& solids,
                              const StepProduct* filling) {
  const WallBox box = box_in(building_.walls[static_cast<std::size_t>(wall)], solids);
  Opening opening;
  opening.id = product.id;
  opening.step_id = product.step_id;
  opening.wall = wall;
  opening.kind = OpeningKind::opening_void;
  opening.leaf = Leaf::none;
  opening.s_m = snapped((box.along.low + box.along.high) / 2.0);
  opening.width_m = snapped(box.along.high - box.along.low);
  opening.z0_m = snapped(box.height.low);
  opening.z1_m = snapped(box.height.high);
  if (filling != nullptr) fill(opening, *filling);
  opening.solid = solids.front();
  opening.parts.assign(solids.begin() + 1, solids.end());
  building_.openings.push_back(std::move(opening));
}

void Interpreter::add_openings() {
  const auto filling_of = fillings(model_);
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::opening) continue;
    const std::vector<Solid> solids = solids_of(product);
    if (solids.empty()) {
      warn(product, "no_body", "has no body that can be read; nothing is cut");
      continue;
    }
    const std::vector<int> walls = host_walls(product, solids);
    if (walls.empty()) cutters_[product.host].push_back(&product);
    const auto filling = filling_of.find(product.step_id);
    for (const int wall : walls) {
      add_opening(product, wall, solids, filling == filling_of.end() ? nullptr : filling->second);
      // An opening through several leaves of a wall is one in each.
      if (wall != walls.front())
        building_.openings.back().id += "/" + building_.walls[static_cast<std::size_t>(wall)].id;
    }
  }
}

/// The empty opening of a wall that the filling stands in; of several the one it fills best, then the first.
bool Interpreter::fill_empty_opening(const StepProduct& filling, const Solid& body) {
  Opening* best = nullptr;
  double best_area = 0.0;
  for (Opening& opening : building_.openings) {
    if (opening.kind != OpeningKind::opening_void) continue;
    const Wall& wall = building_.walls[static_cast<std::size_t>(opening.wall)];
    const WallBox box = box_in(wall, {body});
    std::vector<Solid> hole = opening.parts;
    hole.push_back(*opening.solid);
    const double common = common_area(box_in(wall, hole), box, config_.near_wall_m);
    if (common <= config_.filling_share * area(box) || common <= best_area) continue;
    best = &opening;
    best_area = common;
  }
  if (best == nullptr) return false;
  fill(*best, filling);
  warn(filling, "filling_matched", "names no opening; it stands in " + best->id);
  return true;
}

/// Cuts the filling's box out of the wall it stands in; of several the one it is deepest in, then the first.
bool Interpreter::open_wall_for(const StepProduct& filling, const Solid& body) {
  int best = -1;
  double deepest = 0.0;
  for (std::size_t i = 0; i < building_.walls.size(); ++i) {
    const Wall& wall = building_.walls[i];
    const WallBox box = box_in(wall, {body});
    const WallBox whole = box_in(wall, {*wall.body});
    if (common_area(whole, box, config_.near_wall_m) < config_.filling_share * area(box)) continue;
    // A leaf is thin and lies along its wall; one that crosses it belongs to another.
    if (box.across.high - box.across.low > box.along.high - box.along.low) continue;
    const Interval near{wall.offset_m - config_.near_wall_m, wall.offset_m + wall.thickness_m + config_.near_wall_m};
    const double depth = overlap(near, box.across);
    if (depth <= deepest) continue;
    best = static_cast<int>(i);
    deepest = depth;
  }
  if (best < 0) return false;
  const WallBox box = box_in(building_.walls[static_cast<std::size_t>(best)], {body});
  Opening opening;
  opening.id = filling.id;
  opening.step_id = filling.step_id;
  opening.wall = best;
  opening.s_m = snapped((box.along.low + box.along.high) / 2.0);
  opening.width_m = snapped(box.along.high - box.along.low);
  opening.z0_m = snapped(box.height.low);
  opening.z1_m = snapped(box.height.high);
  fill(opening, filling);
  building_.openings.push_back(std::move(opening));
  warn(filling, "opening_assumed", "fills no opening; its box is cut out of the wall it stands in");
  return true;
}

void Interpreter::add_unlinked_fillings() {
  std::set<std::string> linked;
  for (const Opening& opening : building_.openings) linked.insert(opening.filling_id);
  for (const StepProduct& product : model_.products) {
    const bool door = product.kind == StepClass::door;
    if ((!door && product.kind != StepClass::window) || linked.contains(product.id)) continue;
    const std::int64_t opening = product.host;
    if (const StepProduct* hole = find(opening); hole != nullptr && !host_walls(*hole, solids_of(*hole)).empty()) {
      warn(product, "second_filling", "its opening is filled by another door or window already");
      continue;
    }
    Solid body = joined(uncut_solids(product));
    if (body.triangles.empty()) {
      warn(product, "no_body", "has neither an opening nor a body, and is left out");
      continue;
    }
    if (opening == 0 && (fill_empty_opening(product, body) || open_wall_for(product, body))) continue;
    if (door) {
      warn(product, "door_without_wall", "stands in no wall, and is left open");
    } else {
      add_obstacle(product, opening != 0 ? "roof_window" : "window", "glass", std::move(body));
    }
  }
}

}  // namespace plumbline::bim
