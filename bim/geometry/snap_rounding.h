// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/polygon.h"

namespace plumbline {

/// The area on the left of rings that do not cross, with all vertices on whole numbers. Where rounding them makes rings
/// meet, by snap rounding [hobby1999]: an edge that comes within half a step of a vertex runs through it afterwards, so
/// that nothing crosses and holes stay in their outlines; what is thinner than a step may vanish. Vertices within a
/// straight edge are left out, rings that touch themselves are split, each ring starts at its smallest vertex; pieces
/// and holes come in lexicographic order.
[[nodiscard]] std::vector<PolygonWithHoles2> snap_rounded(const std::vector<Polygon2>& rings);

/// Leads the rings of pieces, all vertices on whole numbers, through the vertices of others that lie within their
/// edges: where rings touch, both have a vertex then.
void lead_through_corners(std::vector<PolygonWithHoles2>& pieces);

}  // namespace plumbline
