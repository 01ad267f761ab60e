// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

/// True where two faces of a solid lie on each other back to back, as far as its grid can tell: a skin that holds no
/// material, or a seam within it. Compares the middle of each triangle with all others.
[[nodiscard]] bool has_membrane(const Solid& solid, double grid_m);

}  // namespace plumbline::bim
