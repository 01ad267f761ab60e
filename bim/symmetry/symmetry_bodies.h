// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Upright body over a convex outline. z above the storey's floor, m.
struct BodyPrism {
  Polygon2 outline;  ///< counter-clockwise, convex
  double z0 = 0.0;
  double z1 = 0.0;
  int element = -1;  ///< into SymmetryBodies::elements
};

/// The elements of a storey that a LiDAR detects, as upright bodies that may overlap.
struct SymmetryBodies {
  int storey = -1;
  std::vector<std::string> elements;  ///< ids: walls, columns, stairs, obstacles in the order of the building
  std::vector<BodyPrism> prisms;
  std::vector<std::string> left_out;  ///< ids of bodies around so much that nothing is known of what is in them
};

struct SymmetryBodiesConfig {
  double height_min_m = 0.02;  ///< what reaches less into a storey belongs to the one above or below
  double flat = 0.3;           ///< a triangle with this upward share of its normal is a top
  double filled = 1.1;         ///< a body that fills less of the room under its tops is taken as its convex outline
  int triangles_max = 200;     ///< a body with more tops is taken as its convex outline
  double area_min_m2 = 1e-9;   ///< smaller pieces are rounding
  double hollow = 0.25;        ///< a body that fills less of its convex outline,
  double around = 0.5;         ///< which covers this share of its storey, is left out: a whole building in one piece
};

/// Walls with their openings cut out over their heights, columns, stairs and planned obstacles that reach into the
/// storey, without what light goes through, between its floor and the ceiling of most of its rooms. Sloped tops are
/// taken as level over each triangle, and bodies with free space under them (railings) as their convex outline over
/// their whole height.
[[nodiscard]] SymmetryBodies symmetry_bodies(const Building& building, int storey,
                                             const SymmetryBodiesConfig& config = {});

/// The part of a convex polygon where n.p <= d.
[[nodiscard]] Polygon2 clipped(const Polygon2& polygon, const Eigen::Vector2d& n, double d);
/// Intersection of two convex counter-clockwise polygons.
[[nodiscard]] Polygon2 convex_intersection(Polygon2 a, const Polygon2& b);
/// Convex polygons that cover the same as pieces of an area which share whole sides: of an area that is convex and has
/// no corner of a piece within it only one, however it was cut. The longest sides go first; of equal ones the first.
[[nodiscard]] std::vector<Polygon2> convex_parts(std::vector<Polygon2> pieces);
/// The bodies without their overlaps: no two share an inner point. Where two overlap the earlier keeps its place.
[[nodiscard]] std::vector<BodyPrism> without_overlaps(const std::vector<BodyPrism>& prisms,
                                                      const SymmetryBodiesConfig& config = {});
[[nodiscard]] double volume(const std::vector<BodyPrism>& disjoint);

}  // namespace plumbline::bim
