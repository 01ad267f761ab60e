// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/model/building.h"
#include "bim/rays/ray_scene.h"
#include "scenarios/localizability/place_index.h"
#include "scenarios/spec/run_building.h"

namespace plumbline::scenarios {

/// What a LiDAR sees of a building: all but what light goes through.
struct VisibleScene {
  bim::RayScene scene;
  std::vector<std::string> elements;  ///< ids, by the element of a hit
};

/// By what of a plan a pose is asked for.
enum class PlanEvidence {
  building,        ///< by what was built: the plan without what may have moved
  with_furniture,  ///< by the plan without furniture that is gone: what is not there tells no pose from another
  whole_plan       ///< by the plan as it is
};

/// The building as planned, as far as it counts, and as built, with everything.
struct VisibleBuilding {
  VisibleScene planned;
  std::optional<VisibleScene> built;  ///< absent where it is the same
  std::vector<char> loose;            ///< by element as built: it may have moved and does not stand as planned
  std::vector<Pose> isometries;       ///< storey_isometries() of what counts of the plan
  bool featureless = false;           ///< nothing that counts of the plan is seen, but floors that are assumed

  [[nodiscard]] const VisibleScene& as_built() const { return built ? *built : planned; }
};
[[nodiscard]] VisibleBuilding visible_building(const RunBuilding& building, PlanEvidence by = PlanEvidence::building);

/// Two neighbouring cells of a floor and the way between them.
struct FloorLink {
  std::size_t a = 0, b = 0;
  double length_m = 0.0;
};

/// Places on the floor of a storey where a robot's centre can be, and which of them are neighbours.
struct Floor {
  std::size_t storey = 0;
  std::vector<Eigen::Vector2d> cells_W;
  std::vector<FloorLink> links;  ///< by a, then b
};

/// Cells of a square grid in the rooms of a storey (anywhere on it where none are known), as built. Neighbours are
/// those whose surroundings, in steps of 0.1 m, touch, so that doors narrower than the grid join cells.
[[nodiscard]] Floor floor_of(const bim::Building& as_built, std::size_t storey, double step_m);

}  // namespace plumbline::scenarios
