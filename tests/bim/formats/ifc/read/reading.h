// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "bim/formats/ifc/read/ifc.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {

inline Building read(const Sketch& sketch) { return read_ifc_text(sketch.text(), "s.ifc"); }

/// How many warnings of a kind reading gave.
inline int count(const Building& building, const std::string& kind) {
  return static_cast<int>(std::count_if(building.warnings.begin(), building.warnings.end(),
                                        [&](const Warning& w) { return w.kind == kind; }));
}

/// Two rooms of 4 by 6 m with a wall of 0.3 m between them, for an opening in it.
inline std::string two_rooms(Sketch& sketch) {
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 3);
  for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
  return sketch.wall(4, 0, 6, 0.3, 3, true);
}

}  // namespace plumbline::bim
