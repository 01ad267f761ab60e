// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/localizability/element_evidence.h"
#include "scenarios/localizability/floor.h"
#include "scenarios/localizability/localizability_map.h"

namespace plumbline::scenarios {

/// What distinguishes a pose from its alias where it can be distinguished: the element most of the evidence comes from.
struct Distinction {
  std::string element;   ///< its id
  bool missing = false;  ///< it would be visible from the alias, and is not; else it is visible, and would not be
  double share = 0.0;    ///< of the positive evidence
  Eigen::Vector2d from_W = Eigen::Vector2d::Zero();  ///< the place nearest to aliased ones that sees it
};

/// Places that look alike by one motion of the plan.
struct Alike {
  Pose transform;                            ///< alias = transform * pose
  int places = 0;                            ///< that one scan cannot distinguish from their images
  bool compass = false;                      ///< a compass does not help: headings are alike too
  std::vector<std::pair<int, int>> rooms;    ///< in which they and their images lie, most places first; -1: in none
  std::optional<Distinction> distinguished;  ///< absent where no place on the floors does
};

/// The motions with most places; those that do nearly the same count once.
struct AlikePlaces {
  std::vector<Alike> motions;
  std::size_t others = 0;  ///< with no more places than the last one listed; at most most_others are counted
};
inline constexpr std::size_t most_others = 99;

/// At most `most` motions are described.
[[nodiscard]] AlikePlaces alike_places(const bim::Building& plan, const VisibleBuilding& visible,
                                       const std::vector<SearchArea>& storeys, const std::vector<Floor>& floors,
                                       const LocalizabilityMap& map, std::size_t most = 8);

}  // namespace plumbline::scenarios
