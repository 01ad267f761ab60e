// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/run_site.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bim/model/floors.h"

namespace plumbline::scenarios {

namespace {

using Obstacles = std::vector<bim::Obstacle>;

const bim::Obstacle* named(const Obstacles& obstacles, const std::string& id) {
  const auto found = std::find_if(obstacles.begin(), obstacles.end(), [&](const auto& o) { return o.id == id; });
  return found == obstacles.end() ? nullptr : &*found;
}

/// Furniture in the file's building as built only would have the ids of what is added.
void check_ids(const Obstacles& added, const bim::Building& as_built, const std::string& path) {
  for (const bim::Obstacle& obstacle : added)
    if (named(as_built.obstacles, obstacle.id) != nullptr)
      throw InputError({path, 0, 0}, "has an obstacle '" + obstacle.id + "', the id of generated furniture; rename it");
}

/// What stands otherwise than before, in the order of the obstacles; what is gone first.
void add_changes(const Obstacles& before, const Obstacles& after, std::vector<bim::Change>& changes) {
  for (const bim::Obstacle& obstacle : before)
    if (named(after, obstacle.id) == nullptr) changes.push_back({"remove_furniture", obstacle.id});
  for (const bim::Obstacle& obstacle : after) {
    const bim::Obstacle* old = named(before, obstacle.id);
    if (old == nullptr)
      changes.push_back({"add_furniture", obstacle.id});
    else if (old->body.vertices != obstacle.body.vertices)
      changes.push_back({"move_furniture", obstacle.id});
  }
}

}  // namespace

bim::PlannedAndBuilt load_site(const std::string& path, const Scenario& scenario) {
  bim::PlannedAndBuilt site = bim::load_planned_and_built(path, scenario.building_options);
  const std::vector<bim::Slab> floors = bim::assumed_slabs(site.as_built);
  site.as_built.slabs.insert(site.as_built.slabs.end(), floors.begin(), floors.end());
  if (scenario.furnish) {
    const std::vector<bim::FurniturePiece> pieces = bim::furnish_pieces(site.as_planned, *scenario.furnish);
    Obstacles added;
    for (const bim::FurniturePiece& piece : pieces) added.push_back(obstacle_of(piece));
    if (std::optional<bim::Warning> missing = bim::chairs_missing(pieces, *scenario.furnish))
      site.as_planned.warnings.push_back(std::move(*missing));
    check_ids(added, site.as_built, path);
    for (bim::Building* building : {&site.as_planned, &site.as_built})
      building->obstacles.insert(building->obstacles.end(), added.begin(), added.end());
  }
  if (scenario.world.furniture == bim::FurnitureWorld::as_planned) return site;
  const Obstacles before = site.as_built.obstacles;
  bim::alter_furniture(site.as_built, scenario.world.furniture, scenario.seed);
  add_changes(before, site.as_built.obstacles, site.changes);
  return site;
}

}  // namespace plumbline::scenarios
