// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/stairwell.h"

#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/formats/plan_yaml/unused_id.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/stair_flight.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

constexpr double level_m = 1e-3;  ///< heights this close are one level

/// Ground that a part of the stair covers, all of it at one height.
struct Step {
  Polygon2 outline;
  double z_m = 0.0;
};

std::vector<Step> steps_of(const Stair& stair) {
  std::vector<Step> steps;
  for (const StairFlight& flight : stair.flights)
    for (int k = 0; k < flight.steps; ++k)
      steps.push_back({steps_outline(flight, k, k), flight.z0_m + (k + 1) * flight.rise_m});
  for (const Landing& landing : stair.landings) steps.push_back({landing.polygon, landing.z_m});
  return steps;
}

bool in_head_room(const Step& step, double z0, double z1, const StairBuilderConfig& config) {
  return z0 < step.z_m + config.head_room_m && z1 > step.z_m + level_m;
}

bool boxes_meet(const Polygon2& a, const Polygon2& b) {
  Eigen::AlignedBox2d box_a, box_b;
  for (const Eigen::Vector2d& p : a) box_a.extend(p);
  for (const Eigen::Vector2d& p : b) box_b.extend(p);
  return box_a.intersects(box_b);
}

/// The ground over which a slab must be open. Steps of a flight that follow each other are one rectangle.
std::vector<Polygon2> well_through(const Stair& stair, const Slab& slab, const StairBuilderConfig& config) {
  std::vector<Polygon2> well;
  for (const StairFlight& flight : stair.flights) {
    int first = -1, last = -1;
    for (int k = 0; k < flight.steps; ++k) {
      const Step step{{}, flight.z0_m + (k + 1) * flight.rise_m};
      if (!in_head_room(step, slab.z0_m, slab.z1_m, config)) continue;
      if (first < 0) first = k;
      last = k;
    }
    if (first >= 0) well.push_back(steps_outline(flight, first, last));
  }
  for (const Landing& landing : stair.landings)
    if (in_head_room({{}, landing.z_m}, slab.z0_m, slab.z1_m, config)) well.push_back(landing.polygon);
  return well;
}

/// Floor of the storey at p, not its ceiling.
bool floor_at(const Building& building, int storey, const Eigen::Vector2d& p) {
  const double level = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  return std::any_of(building.slabs.begin(), building.slabs.end(), [&](const Slab& slab) {
    return std::abs(slab.z1_m - level) < level_m && contains(slab.polygon, p);
  });
}

int room_at(const Building& building, int storey, const Eigen::Vector2d& p) {
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    if (building.rooms[i].storey == storey && contains(building.rooms[i].polygon, p)) return static_cast<int>(i);
  return -1;
}

std::string point(const Eigen::Vector2d& p) {
  const auto text = [](double v) { return format_number(std::round(v * 1e3) / 1e3); };
  return "[" + text(p.x()) + ", " + text(p.y()) + "]";
}

/// The wall or column that stands in the way of a step, by name.
std::optional<std::string> in_the_way(const Building& building, const Step& step, const StairBuilderConfig& config) {
  const auto meets = [&](const Polygon2& ground, double z0, double z1) {
    return in_head_room(step, z0, z1, config) && boxes_meet(step.outline, ground) &&
           intersection_area(step.outline, ground) > config.wall_m2;
  };
  for (const Wall& wall : building.walls)
    if (meets(footprint(wall), wall.z0_m, wall.z1_m)) return "wall '" + wall.id + "'";
  for (const Column& column : building.columns)
    if (meets(column.footprint, column.z0_m, column.z1_m)) return "column '" + column.id + "'";
  return std::nullopt;
}

}  // namespace

void cut_stairwell(const Stair& stair, Building& building, const StairBuilderConfig& config) {
  std::vector<Slab> more;
  for (Slab& slab : building.slabs) {
    const std::vector<Polygon2> well = well_through(stair, slab, config);
    const bool apart = std::none_of(well.begin(), well.end(),
                                    [&](const Polygon2& part) { return boxes_meet(part, slab.polygon.outer); });
    if (apart) continue;
    const Region2 whole = subtract(unite(std::vector<Polygon2>{slab.polygon.outer}), slab.polygon.holes);
    const Region2 rest = subtract(whole, well);
    for (std::size_t i = 1; i < rest.size(); ++i) {
      Slab piece = slab;
      piece.id = unused_id(slab.id, building.slabs, more);
      piece.polygon = rest[i];
      more.push_back(std::move(piece));
    }
    slab.polygon = rest.empty() ? PolygonWithHoles2{} : rest.front();
  }
  std::erase_if(building.slabs, [](const Slab& slab) { return slab.polygon.outer.empty(); });
  building.slabs.insert(building.slabs.end(), more.begin(), more.end());
}

void find_stair_rooms(const Building& building, Stair& stair, const StairBuilderConfig& config) {
  StairFlight before = stair.flights.front();
  before.steps = 0;
  stair.rooms[0] = room_at(building, stair.from, head_of(before, -config.step_off_m));
  stair.rooms[1] = room_at(building, stair.to, head_of(stair.flights.back(), config.step_off_m));
}

std::optional<std::string> stair_fault(const Building& building, const Stair& stair, const StairBuilderConfig& config) {
  StairFlight before = stair.flights.front();
  before.steps = 0;
  const Eigen::Vector2d foot = head_of(before, -config.step_off_m);
  const Eigen::Vector2d head = head_of(stair.flights.back(), config.step_off_m);
  const auto storey = [&](int i) { return "storey '" + building.storeys[static_cast<std::size_t>(i)].id + "'"; };
  if (!floor_at(building, stair.from, foot))
    return "there is no floor of " + storey(stair.from) + " before its first step, at " + point(foot);
  if (!floor_at(building, stair.to, head))
    return "it ends in the void: there is no floor of " + storey(stair.to) + " beyond its last step, at " + point(head);
  for (const Step& step : steps_of(stair))
    if (const auto obstacle = in_the_way(building, step, config))
      return *obstacle + " stands on or less than " + format_number(config.head_room_m) + " m above it, near " +
             point(centroid(step.outline));
  for (const auto& [where, p] : {std::pair{stair.from, foot}, std::pair{stair.to, head}}) {
    const double level = building.storeys[static_cast<std::size_t>(where)].elevation_m;
    for (const Wall& wall : building.walls)
      if (in_head_room({{}, level}, wall.z0_m, wall.z1_m, config) && contains(footprint(wall), p))
        return "it runs into wall '" + wall.id + "' at " + point(p);
  }
  return std::nullopt;
}

}  // namespace plumbline::bim
