// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/load/load.h"

namespace plumbline::scenarios {

/// A page, and the same as JSON and in lines for a terminal.
struct WalkPage {
  std::string html;
  Tree storeys = Tree::list();  ///< of each storey with rooms a block like `walk` of results.json
  std::vector<std::string> lines;
};

/// A page on where a robot can walk in a building as built: for each storey with rooms the floor that it reaches from
/// where it would start, the walk it would take by default, each room by whether it is on the walk, in reach or out of
/// reach, and what stops the robot on the way to those. `name` is the title.
[[nodiscard]] WalkPage walk_page(const bim::PlannedAndBuilt& site, const std::string& name);

}  // namespace plumbline::scenarios
