// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/formats/ifc/read/wall_box.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/body_section.h"
#include "bim/model/extrude.h"
#include "bim/model/through.h"
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

/// A thin straight wall along a face of another, such as its plasterboard: a door of that one is a door of both. Where
/// it lies across the other; nullopt for a wall of its own.
std::optional<Interval> lining_of(const Wall& host, const Wall& wall, const IfcConfig& config) {
  constexpr double parallel = 0.02;
  if (wall.thickness_m > config.lining_m || std::abs(host.direction().dot(wall.left())) > parallel) return std::nullopt;
  Interval across;
  for (const double side : {wall.offset_m, wall.offset_m + wall.thickness_m})
    across.add(host.left().dot(0.5 * (wall.a + wall.b) + side * wall.left() - host.a));
  if (gap(across, {host.offset_m, host.offset_m + host.thickness_m}) > config.lining_gap_m) return std::nullopt;
  const bool straight = fill_of(wall) >= config.least_fill && fill_of(host) >= config.least_fill;
  return straight ? std::optional(across) : std::nullopt;
}

/// What an opening leaves of its wall's rectangle on the plan, and of a lining's that lies across it so; of a bent
/// wall's, no more than it reaches.
Polygon2 doorway_of(const Opening& opening, const Wall& host, const std::optional<Interval>& lining,
                    double least_fill) {
  const Eigen::Vector2d e = host.direction(), foot = host.a + opening.s_m * e;
  const double half = 0.5 * opening.width_m;
  Interval depth{host.offset_m, host.offset_m + host.thickness_m};
  if (fill_of(host) < least_fill) depth = depth_in_wall(opening, host);
  if (lining) depth = {std::min(depth.low, lining->low), std::max(depth.high, lining->high)};
  Polygon2 doorway;
  for (const auto& [s, y] : {std::pair(-half, depth.low), std::pair(half, depth.low), std::pair(half, depth.high),
                             std::pair(-half, depth.high)})
    doorway.emplace_back(foot + s * e + y * host.left());
  return doorway;
}

}  // namespace

/// The wall that an opening is said to cut; where that is several pieces or a group of walls, those that it reaches
/// into, and where it is a part of a wall, that wall.
std::vector<int> Interpreter::host_walls(const StepProduct& opening, const std::vector<Solid>& solids) const {
  std::vector<int> reached;
  const auto add_reached = [&](const std::vector<int>& walls) {
    for (const int i : walls) {
      const Wall& wall = building_.walls[static_cast<std::size_t>(i)];
      if (common_area(box_in(wall, {*wall.body}), box_in(wall, solids), 0.0) > config_.least_cut_m2)
        reached.push_back(i);
    }
  };
  for (const StepProduct* host = find(opening.host); host != nullptr; host = find(host->whole)) {
    if (const auto own = walls_.find(host->step_id); own != walls_.end()) {
      if (own->second.size() > 1) add_reached(own->second);
      return reached.empty() ? std::vector<int>{own->second.front()} : reached;
    }
    const auto parts = parts_.find(host->step_id);
    if (parts == parts_.end()) continue;
    for (const StepProduct* part : parts->second)
      if (const auto found = walls_.find(part->step_id); found != walls_.end()) add_reached(found->second);
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

void Interpreter::add_opening(const Cut& cut) {
  const auto& [product_of, filling, wall, solids, id, of_part] = cut;
  const StepProduct& product = *product_of;
  const WallBox box = box_within(building_.walls[static_cast<std::size_t>(wall)], solids);
  Opening opening;
  opening.id = id;
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
  const Wall& host = building_.walls[static_cast<std::size_t>(wall)];
  const WallBox of_host = box_in(host, {*host.body});
  constexpr double sheet_m = 1e-3;  // a wall drawn as a surface has no thickness to meet
  if (common_area(of_host, box_in(host, solids), of_host.across.length() < sheet_m ? sheet_m : 0.0) <= 0.0) {
    warn(filling != nullptr ? *filling : product, "opening_unused",
         filling != nullptr ? "its opening misses its wall and cuts nothing" : "misses its wall and cuts nothing");
  } else if (opening.kind == OpeningKind::door) {
    const double short_m = extend_through(opening, host);
    if (short_m > 0.0)
      warn(*filling, "niche",
           "its opening ends " + std::to_string(std::lround(short_m * 1e3)) +
               " mm short of the faces of its wall, and is cut through");
    else if (!goes_through(opening, host))
      warn(*filling, "niche", "its opening does not go through its wall; it leads nowhere");
  }
  building_.openings.push_back(std::move(opening));
}

/// Joins what an opening of a part cuts with what another cuts in the same place of the same wall. The filled one goes
/// on, otherwise that of the wall itself, otherwise the first.
bool Interpreter::join_cut(const Cut& cut, std::vector<Cut>& cuts) const {
  constexpr double same_share = 0.8;
  const Wall& wall = building_.walls[static_cast<std::size_t>(cut.wall)];
  const WallBox box = box_within(wall, cut.solids);
  for (Cut& other : cuts) {
    if (other.wall != cut.wall || !(other.of_part || cut.of_part) ||
        (other.filling != nullptr && cut.filling != nullptr))
      continue;
    const WallBox there = box_within(wall, other.solids);
    if (overlap(box.along, there.along) < same_share * std::max(box.along.length(), there.along.length()) ||
        overlap(box.height, there.height) < same_share * std::max(box.height.length(), there.height.length()))
      continue;
    const bool takes_over = cut.filling != nullptr || (other.filling == nullptr && other.of_part && !cut.of_part);
    Cut joined = takes_over ? cut : other;
    const Cut& rest = takes_over ? other : cut;
    const Interval deep = box_in(wall, joined.solids).across, more = box_in(wall, rest.solids).across;
    if (more.low < deep.low - config_.grid_m || more.high > deep.high + config_.grid_m)
      joined.solids.insert(joined.solids.end(), rest.solids.begin(), rest.solids.end());
    other = std::move(joined);
    return true;
  }
  return false;
}

void Interpreter::add_openings() {
  const auto filling_of = fillings(model_);
  std::vector<Cut> cuts;
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
      Cut cut{&product,   filling == filling_of.end() ? nullptr : filling->second,
              wall,       solids,
              product.id, !walls_.contains(product.host)};
      // An opening through several leaves of a wall is one in each.
      if (wall != walls.front()) cut.id += "/" + building_.walls[static_cast<std::size_t>(wall)].id;
      if (!join_cut(cut, cuts)) cuts.push_back(std::move(cut));
    }
  }
  for (const Cut& cut : cuts) add_opening(cut);
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
  const WallBox box = said_box(filling, building_.walls[static_cast<std::size_t>(best)], {body});
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
  std::set<std::int64_t> cut;
  for (const Opening& opening : building_.openings) {
    linked.insert(opening.filling_id);
    cut.insert(opening.step_id);
  }
  for (const StepProduct& product : model_.products) {
    const bool door = product.kind == StepClass::door;
    if ((!door && product.kind != StepClass::window) || linked.contains(product.id)) continue;
    if (product.host != 0 && cut.contains(product.host)) {
      warn(product, "second_filling", "its opening is filled by another door or window already");
      continue;
    }
    const StepProduct* hole = find(product.host);
    Solid body = joined(uncut_solids(product));
    if (door && body.triangles.empty() && hole != nullptr && !hole->body.empty()) body = joined(solids_of(*hole));
    if (body.triangles.empty()) {
      warn(product, "no_body", "has neither an opening nor a body, and is left out");
      continue;
    }
    // An opening without a body, or in nothing, says no more than none.
    const bool in_other = hole != nullptr && !hole->body.empty() && find(hole->host) != nullptr;
    if (!in_other && (fill_empty_opening(product, body) || open_wall_for(product, body))) continue;
    if (door) {
      warn(product, "door_without_wall", "stands in no wall, and is left open");
      free_doors_.push_back({product.id, std::move(body)});
    } else {
      add_obstacle(product, in_other ? "roof_window" : "window", "glass", std::move(body));
    }
  }
}

/// The wall that a door of another stands in, opened for it: through its whole thickness where the two run along each
/// other, otherwise as far as the opening reaches. Nullopt where the wall's body leaves most of the doorway free.
std::optional<Opening> Interpreter::opening_in(const Wall& wall, int index, const Opening& opening,
                                               const Polygon2& doorway) const {
  constexpr double least_m = 0.03, least_height_m = 0.5, along = 0.1;
  const double least_deep_m = std::min(least_m, 0.5 * wall.thickness_m);
  if (wall.z0_m > opening.z1_m - least_height_m || wall.z1_m < opening.z0_m + least_height_m) return std::nullopt;
  const Wall& host = building_.walls[static_cast<std::size_t>(opening.wall)];
  const Eigen::Vector2d e = host.direction(), foot = host.a + opening.s_m * e;
  const double half = 0.5 * opening.width_m;
  Interval range, across;  // of the doorway, in the frame of the other wall
  for (const Eigen::Vector2d& p : doorway) {
    range.add(wall.direction().dot(p - wall.a));
    across.add(wall.left().dot(p - wall.a));
  }
  if (overlap(range, {0.0, wall.length()}) < least_m ||
      overlap(across, {wall.offset_m, wall.offset_m + wall.thickness_m}) < least_deep_m)
    return std::nullopt;
  const double middle_m = 0.5 * (std::max(wall.z0_m, opening.z0_m) + std::min(wall.z1_m, opening.z1_m));
  Interval blocked, filled, deep;  // along the host, and along and across the other wall
  for (const PolygonWithHoles2& piece : intersect(unite(std::vector<Polygon2>{doorway}), wall_section(wall, middle_m)))
    for (const Eigen::Vector2d& p : piece.outer) {
      blocked.add(e.dot(p - foot));
      filled.add(wall.direction().dot(p - wall.a));
      deep.add(wall.left().dot(p - wall.a));
    }
  if (blocked.high < blocked.low || filled.length() < least_m || deep.length() < least_deep_m) return std::nullopt;
  if (std::max(blocked.low + half, half - blocked.high) >= config_.clear_share * opening.width_m) return std::nullopt;
  Opening other = opening;
  other.id = opening.id + "/" + wall.id;
  other.wall = index;
  other.kind = OpeningKind::opening_void;
  other.leaf = Leaf::none;
  other.filling_id.clear();
  other.material.clear();
  other.s_m = snapped(0.5 * (range.low + range.high));
  other.width_m = snapped(range.length());
  // A rectangle would go through all that a bent wall has behind the doorway, too.
  if (fill_of(wall) < config_.least_fill) {
    if (!other.solid) other.solid = extrude(unite(std::vector<Polygon2>{doorway}), other.z0_m, other.z1_m);
  } else if (std::abs(e.dot(wall.left())) < along) {
    other.solid.reset();
    other.parts.clear();
  }
  return other;
}

/// An opening of the same wall that the doorway is in already.
bool Interpreter::has_opening_at(int wall, const Opening& like) const {
  return std::any_of(building_.openings.begin(), building_.openings.end(), [&](const Opening& other) {
    return other.wall == wall && other.kind != OpeningKind::window &&
           std::abs(other.s_m - like.s_m) < 0.5 * like.width_m && other.z0_m < like.z1_m && other.z1_m > like.z0_m;
  });
}

void Interpreter::open_overlapping_walls() {
  const std::size_t count = building_.openings.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Opening opening = building_.openings[i];
    if (opening.kind == OpeningKind::window) continue;
    const Wall& host = building_.walls[static_cast<std::size_t>(opening.wall)];
    const Polygon2 doorway = doorway_of(opening, host, std::nullopt, config_.least_fill);
    const bool through = goes_through(opening, host);
    for (int w = 0; w < static_cast<int>(building_.walls.size()); ++w) {
      if (w == opening.wall) continue;
      const Wall& wall = building_.walls[static_cast<std::size_t>(w)];
      const std::optional<Interval> lining = through ? lining_of(host, wall, config_) : std::nullopt;
      std::optional<Opening> other =
          opening_in(wall, w, opening, lining ? doorway_of(opening, host, lining, config_.least_fill) : doorway);
      if (!other || has_opening_at(w, *other)) continue;
      building_.warnings.push_back({opening.filling_id.empty() ? opening.id : opening.filling_id, "walls_overlap",
                                    lining ? "wall " + wall.id + " lines its wall, and is opened there"
                                           : "stands in wall " + wall.id + " too, which is opened there"});
      building_.openings.push_back(std::move(*other));
    }
  }
}

/// A covering of a wall, drawn over its doors too, less these.
Solid Interpreter::opened_at_doors(const StepProduct& product, Solid covering) {
  constexpr double upright_m = 1.0, under_m = 0.01;  // what lies on the floor stays
  const Extent box = extent(covering);
  if (box.high.z() - box.low.z() < upright_m) return covering;
  const double before_m = config_.lining_m + config_.lining_gap_m;
  const Eigen::AlignedBox2d on_plan(Eigen::Vector2d(box.low.head<2>()), Eigen::Vector2d(box.high.head<2>()));
  std::vector<Solid> cuts;
  for (const Opening& opening : building_.openings) {
    if (opening.kind == OpeningKind::window) continue;
    const double low_m = opening.z0_m - under_m;
    if (low_m > box.high.z() || opening.z1_m < box.low.z()) continue;
    const Wall& host = building_.walls[static_cast<std::size_t>(opening.wall)];
    const Interval across{host.offset_m - before_m, host.offset_m + host.thickness_m + before_m};
    const Polygon2 doorway = doorway_of(opening, host, across, config_.least_fill);
    Eigen::AlignedBox2d reach;
    for (const Eigen::Vector2d& p : doorway) reach.extend(p);
    if (!reach.intersects(on_plan) || !goes_through(opening, host)) continue;
    const Region2 region = unite(std::vector<Polygon2>{doorway});
    const Region2 common = intersect(
        region, body_section(covering, 0.5 * (std::max(low_m, box.low.z()) + std::min(opening.z1_m, box.high.z()))));
    if (common.empty()) continue;
    cuts.push_back(extrude(region, low_m, opening.z1_m));
    warn(product, "walls_overlap", "covers " + opening.id + ", and is opened there");
  }
  if (cuts.empty()) return covering;
  std::vector<std::string> problems;
  covering = without(std::move(covering), cuts, problems);
  for (const std::string& problem : problems) warn(product, "not_cut", problem);
  return covering;
}

}  // namespace plumbline::bim
