// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/generators/floor_template.h"

namespace plumbline::bim {

/// A floor template with its one distinguishing feature.
struct FeaturedTemplate {
  FloorTemplate floor;
  std::string element;  ///< id of the wall, opening, column or clutter, without prefix
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> seen_at;  ///< points just before its surface
};

/// Ways to put the feature that the options ask for into a room, in a fixed order; only such that leave doors and
/// windows their place and a robot its way.
[[nodiscard]] std::vector<FeaturedTemplate> place_feature(const FloorTemplate& floor, const GeneratorOptions& options,
                                                          const std::string& room);

}  // namespace plumbline::bim
