// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"
#include "bim/rays/ray_scene.h"
#include "scenarios/localizability/place_index.h"

namespace plumbline::scenarios {

/// A building as a LiDAR sees it, without what light goes through.
struct SeenBuilding {
  bim::RayScene scene;
  std::vector<std::string> elements;  ///< ids, by the element of a hit
};
[[nodiscard]] SeenBuilding seen_building(const bim::Building& building);

/// Box around the walls of a storey, with the sensor's height over its floor.
[[nodiscard]] IdentifyStorey search_area(const bim::Building& building, std::size_t storey);

/// Two neighbouring cells of a floor and the way between them.
struct FloorLink {
  std::size_t a = 0, b = 0;
  double length_m = 0.0;
};

/// Places on the floor of a storey where a robot's centre can be, and how they hang together.
struct Floor {
  std::size_t storey = 0;
  std::vector<Eigen::Vector2d> cells_W;
  std::vector<FloorLink> links;  ///< by a, then b
};

/// Cells of a square grid in the rooms of a storey (anywhere on it where none are known), as built. Neighbours are
/// those whose surroundings, in steps of 0.1 m, touch, so that doors narrower than the grid join cells.
[[nodiscard]] Floor floor_of(const bim::Building& as_built, std::size_t storey, double step_m);

}  // namespace plumbline::scenarios
