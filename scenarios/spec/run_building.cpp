// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/run_building.h"

#include <algorithm>
#include <utility>

#include "bim/model/permanence.h"

namespace plumbline::scenarios {

namespace {

std::shared_ptr<const bim::Plan> told_plan(const bim::Building& as_planned, const bim::BuildingMesh& mesh,
                                           ToldFurniture told) {
  bim::Plan plan = bim::make_plan(as_planned, mesh);
  if (told == ToldFurniture::none) {
    std::erase_if(plan.solids, [](const bim::PlanSolid& solid) { return solid.may_have_moved; });
    plan.furniture = {};
  }
  return std::make_shared<const bim::Plan>(std::move(plan));
}

}  // namespace

RunBuilding::RunBuilding(bim::PlannedAndBuilt building, ToldFurniture told)
    : building_(std::move(building)),
      told_(told),
      mesh_as_planned_(bim::build_mesh(building_.as_planned)),
      plan_as_planned_(told_plan(building_.as_planned, mesh_as_planned_, told)),
      plan_as_built_(deviates() || told == ToldFurniture::none
                         ? std::make_shared<const bim::Plan>(bim::make_plan(building_.as_built, {}))
                         : plan_as_planned_) {}

bool RunBuilding::plans_movables() const {
  return std::any_of(building_.as_planned.obstacles.begin(), building_.as_planned.obstacles.end(), bim::may_have_moved);
}

bool RunBuilding::movables_tell() const {
  return told_ == ToldFurniture::as_planned &&
         std::any_of(building_.as_planned.obstacles.begin(), building_.as_planned.obstacles.end(),
                     [&](const bim::Obstacle& obstacle) {
                       return bim::may_have_moved(obstacle) && !bim::is_gone(obstacle, building_.as_built);
                     });
}

const bim::BuildingMesh& RunBuilding::mesh_as_built() const {
  const auto assumed = [](const bim::Slab& slab) { return slab.assumed; };
  if (!deviates() && std::none_of(building_.as_built.slabs.begin(), building_.as_built.slabs.end(), assumed))
    return mesh_as_planned();
  std::call_once(made_as_built_, [&] { mesh_as_built_ = bim::build_mesh(building_.as_built); });
  return *mesh_as_built_;
}

}  // namespace plumbline::scenarios
