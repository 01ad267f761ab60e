// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "bim/plan/plan.h"
#include "scenarios/spec/told_furniture.h"

namespace plumbline::scenarios {

/// A building with its plans and meshes, each made once: simulation, methods, localizability, scores and report share
/// them. The mesh as built is made when first asked for, by whichever thread asks.
class RunBuilding {
 public:
  explicit RunBuilding(bim::PlannedAndBuilt building, ToldFurniture told = ToldFurniture::as_planned);

  [[nodiscard]] const bim::PlannedAndBuilt& variants() const { return building_; }
  [[nodiscard]] const bim::Building& as_planned() const { return building_.as_planned; }
  [[nodiscard]] const bim::Building& as_built() const { return building_.as_built; }
  /// Whether anything was built otherwise than planned.
  [[nodiscard]] bool deviates() const { return !building_.changes.empty(); }

  [[nodiscard]] ToldFurniture told_furniture() const { return told_; }
  /// Whether anything of the plan may have moved, told to methods or not.
  [[nodiscard]] bool plans_movables() const;
  /// Whether what may have moved can tell methods anything: they are told of it, and not all of it is gone.
  [[nodiscard]] bool movables_tell() const;

  /// What methods may know of the building. Walls, rooms and storeys are those of the whole plan, whatever is told of
  /// the furniture.
  [[nodiscard]] const std::shared_ptr<const bim::Plan>& plan_as_planned() const { return plan_as_planned_; }
  /// What maps are scored against. The same plan where nothing deviates.
  [[nodiscard]] const bim::Plan& plan_as_built() const { return *plan_as_built_; }
  [[nodiscard]] const bim::BuildingMesh& mesh_as_planned() const { return mesh_as_planned_; }
  /// What the LiDAR hits. The same mesh where nothing deviates and no floor is assumed.
  [[nodiscard]] const bim::BuildingMesh& mesh_as_built() const;

 private:
  bim::PlannedAndBuilt building_;
  ToldFurniture told_;
  bim::BuildingMesh mesh_as_planned_;
  std::shared_ptr<const bim::Plan> plan_as_planned_, plan_as_built_;
  mutable std::once_flag made_as_built_;
  mutable std::optional<bim::BuildingMesh> mesh_as_built_;
};

}  // namespace plumbline::scenarios
