// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "bim/building/building.h"

namespace plumbline::bim {

/// Faces as loops of vertices, as a file describes them; not yet triangulated.
struct Facets {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> loops;  ///< indices into points, counter-clockwise seen from outside
};

/// One item of a body before booleans: base minus the operands of its IfcBooleanResults, half spaces as large boxes.
struct Shape {
  Facets base;
  std::vector<Facets> minus;
};

/// Grid of the vertices of solids, m: coarse against the reader's rounding, fine enough to keep oblique walls flat.
inline constexpr double solid_grid_m = 1e-5;

/// Facets moved by a transform; loops are reversed where it mirrors.
[[nodiscard]] Facets transformed(const Eigen::Affine3d& X, Facets facets);

/// Triangles of the facets in canonical form, whatever the order of points and loops: vertices on the grid, each once,
/// sorted; triangles sorted; turned outward.
[[nodiscard]] Solid triangulated(const Facets& facets);

/// Body minus the cuts, one after the other, canonical. Adds to `problems` what could not be cut off.
[[nodiscard]] Solid without(Solid body, const std::vector<Solid>& cuts, std::vector<std::string>& problems);
/// The solid of a shape.
[[nodiscard]] Solid solid_of(const Shape& shape, std::vector<std::string>& problems);

/// Both as one mesh; they are not united.
[[nodiscard]] Solid joined(const std::vector<Solid>& solids);

}  // namespace plumbline::bim
