// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/polygon.h"

namespace plumbline {

[[nodiscard]] inline Polygon2 rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

}  // namespace plumbline
