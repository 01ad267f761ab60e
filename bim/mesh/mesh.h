// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/mesh/solid.h"
#include "bim/mesh/wall_cut.h"
#include "bim/model/building.h"

namespace plumbline::bim {

enum class ElementKind { wall, slab, column, stair, obstacle };

/// One physical element of the mesh; its position in BuildingMesh::elements is the element id of its triangles.
struct MeshElement {
  std::string id;
  ElementKind kind = ElementKind::wall;
  int index = -1;  ///< into Building::walls, slabs, columns, stairs or obstacles
  int storey = -1;
  bool closed = true;
  double volume_m3 = 0.0;  ///< 0 when not closed
  int first_triangle = 0;
  int triangle_count = 0;
};

/// All elements as one triangle soup in W: each element a closed solid, overlaps at junctions allowed.
struct BuildingMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> element;  ///< element id per triangle
  std::vector<MeshElement> elements;
  std::vector<Warning> warnings;
};

/// Cuts every wall (2D booleans on the elevation where the wall is prismatic, corefinement otherwise), extrudes
/// slabs and columns, and joins all in the order of the building: walls, slabs, columns, stairs,
/// obstacles.
[[nodiscard]] BuildingMesh build_mesh(const Building& building, const MeshConfig& config = {});

}  // namespace plumbline::bim
