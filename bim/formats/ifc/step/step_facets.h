// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/formats/ifc/step/shape.h"

class IfcPolygonalFaceSet;
class IfcRepresentationItem;

namespace plumbline::bim {

/// The faces of a face set, m; those with holes as triangles. Adds to `problems` what gives no face.
[[nodiscard]] Facets polygonal_facets(const IfcPolygonalFaceSet& set, double unit_m,
                                      std::vector<std::string>& problems);

/// How many faces of an item are bounded by edges, of which IFC++ makes nothing.
[[nodiscard]] int unread_faces(const IfcRepresentationItem& item);

}  // namespace plumbline::bim
