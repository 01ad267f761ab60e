// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/mesh/exact_boolean.h"

namespace plumbline::bim {

/// The part of a surface outside a closed solid (difference) or inside it (intersection), for surfaces that do not
/// close: its triangles are cut along the planes of the solid's faces and taken one by one. The cut itself gets no
/// faces. In rounded arithmetic.
[[nodiscard]] Solid surface_cut(const Solid& surface, const BooleanStep& step, double grid_m);

}  // namespace plumbline::bim
