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

/// How many faces of an item are not read as they are meant.
struct OddFaces {
  int unread = 0;  ///< bounded by edges, of which IFC++ makes nothing
  int curved = 0;  ///< read as flat between their edges
};
[[nodiscard]] OddFaces odd_faces(const IfcRepresentationItem& item);

}  // namespace plumbline::bim
