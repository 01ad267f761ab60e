// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/rays/ray_scene.h"

namespace plumbline::scenarios {

/// Size of the furnished storey that rays are timed in: strips of rooms on both sides of a corridor, each room 4 m wide
/// and 9 m deep with a door and a window, full of boxes and 32-sided cylinders.
struct FurnishedConfig {
  int columns = 10;              ///< rooms along a corridor, on each side
  int strips = 1;                ///< corridors
  int clutter_triangles = 2512;  ///< in each room, about

  [[nodiscard]] int rooms() const { return 2 * columns * strips; }
};

/// Closed boxes and cylinders, each an element; clutter stands off the middle of its room.
[[nodiscard]] bim::BuildingMesh furnished_storey(const FurnishedConfig& config, std::uint64_t seed);

/// Rays of a VLP-16 turn (16 x 1,800) of a sensor that walks and turns meanwhile, from the middle of a room, in packets
/// of 2 neighbouring rings x 8 neighbouring columns.
[[nodiscard]] std::vector<bim::Ray> turn_in_room(const FurnishedConfig& config, int room, std::uint64_t seed);

}  // namespace plumbline::scenarios
