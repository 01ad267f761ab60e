// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/run_building.h"

#include <utility>

namespace plumbline::scenarios {

namespace {

std::shared_ptr<const bim::Plan> plan_of(const bim::Building& building) {
  return std::make_shared<const bim::Plan>(bim::make_plan(building));
}

}  // namespace

RunBuilding::RunBuilding(bim::PlannedAndBuilt building)
    : building_(std::move(building)),
      plan_as_planned_(plan_of(building_.as_planned)),
      plan_as_built_(deviates() ? plan_of(building_.as_built) : plan_as_planned_) {}

const bim::BuildingMesh& RunBuilding::mesh_as_planned() const {
  std::call_once(made_as_planned_, [&] { mesh_as_planned_ = bim::build_mesh(building_.as_planned); });
  return *mesh_as_planned_;
}

const bim::BuildingMesh& RunBuilding::mesh_as_built() const {
  if (!deviates()) return mesh_as_planned();
  std::call_once(made_as_built_, [&] { mesh_as_built_ = bim::build_mesh(building_.as_built); });
  return *mesh_as_built_;
}

}  // namespace plumbline::scenarios
