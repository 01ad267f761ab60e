// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Faces as loops of vertices, as a file describes them; not yet triangulated.
struct Facets {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> loops;  ///< indices into points, counter-clockwise seen from outside
};

/// One item of a body before booleans: what the base has in common with all of `within`, less all of `minus` (operands
/// of IfcBooleanResults; half spaces as large boxes).
struct Shape {
  Facets base;
  std::vector<Facets> minus;
  std::vector<Facets> within = {};
};

/// Grid of the vertices of solids in their product's own frame, m: coarse against the reader's rounding.
inline constexpr double solid_grid_m = 1e-5;
/// ... and in W, where products may be turned: fine enough to keep their faces flat.
inline constexpr double placed_grid_m = 1e-6;

/// Facets moved by a transform; loops are reversed where it mirrors.
[[nodiscard]] Facets transformed(const Eigen::Affine3d& X, Facets facets);

[[nodiscard]] Shape transformed(const Eigen::Affine3d& X, Shape shape);
/// A solid of a product's frame in W, canonical.
[[nodiscard]] Solid placed(const Eigen::Affine3d& X_WP, Solid solid);

/// Adds the face with an outline, the first of the loops, and holes in it, the others, as triangles. False where these
/// cross.
[[nodiscard]] bool add_triangles(Facets& facets, const std::vector<std::vector<int>>& loops);

/// Triangles of the facets in canonical form, whatever the order of points and loops: vertices on the grid, each once,
/// sorted; triangles sorted; turned outward. `crossed` counts the faces that run across themselves.
[[nodiscard]] Solid triangulated(const Facets& facets, int& crossed);
[[nodiscard]] Solid triangulated(const Facets& facets);

/// Body minus the cuts, one after the other, canonical. Adds to `problems` what could not be cut off.
[[nodiscard]] Solid without(Solid body, const std::vector<Solid>& cuts, std::vector<std::string>& problems);
/// The solid of a shape.
[[nodiscard]] Solid solid_of(const Shape& shape, std::vector<std::string>& problems, int& crossed);
[[nodiscard]] Solid solid_of(const Shape& shape, std::vector<std::string>& problems);

/// Both as one mesh; they are not united.
[[nodiscard]] Solid joined(const std::vector<Solid>& solids);

}  // namespace plumbline::bim
