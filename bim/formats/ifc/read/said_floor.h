// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/formats/ifc/step/step_model.h"

namespace plumbline::bim {

/// A height and how much says so: m^2 of floor, m of wall.
struct WeighedHeight {
  double z_m = 0.0;
  double weight = 0.0;
};

/// What the elements of a storey say about the height of its floor.
struct FloorHints {
  std::vector<WeighedHeight> slabs;      ///< upward faces
  std::vector<WeighedHeight> spaces;     ///< lower ends
  std::vector<WeighedHeight> walls;      ///< lower ends
  std::vector<double> doors;             ///< sills
  std::vector<WeighedHeight> at_storey;  ///< slabs that the height of the storey goes through
};

struct SaidFloorConfig {
  double same_m = 0.05;            ///< nobody notices a floor this much higher or lower
  double covering_m = 0.35;        ///< between a slab and the floor; it need not be drawn
  double with_walls_only_m = 0.6;  ///< walls begin this much beside their floor, where they are all that is known
  double window_m = 0.1;           ///< heights this close to another are one level
  double under_ceiling_m = 1.5;    ///< a slab this far over the foot of most walls or rooms is none to stand on
  double levels_share = 0.3;       ///< a level with this share of the largest is one of several of its storey
  double most_share = 0.5;         ///< a storey moves to a level with this share of all, at least
  double apart_m = 1.0;            ///< slabs alone move no storey so near to another one
};

/// Adds what a wall, slab or space says to the hints of its storey at a height.
void add_hints(const StepProduct& product, double storey_m, FloorHints& hints);

/// Where the floor of a storey lies, by most of the area of its slabs and spaces, without these by most of the length
/// of its walls; nullopt where that is the height of the storey, one of several levels of it, or not clear. `others`
/// are the heights of the other storeys.
[[nodiscard]] std::optional<double> said_floor(const FloorHints& hints, double storey_m,
                                               const std::vector<double>& others, const SaidFloorConfig& config = {});

/// Lowest point of what the bodies of a product are extruded or joined from, m in W; infinite without any.
[[nodiscard]] double foot_of(const StepProduct& product);
/// Likewise its highest point; minus infinity without a body.
[[nodiscard]] double top_of(const StepProduct& product);

}  // namespace plumbline::bim
