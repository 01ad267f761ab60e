// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// One triangle as the ray scene decides on it: its canonical plane n.(x - v0) = 0 in W, in double.
struct Face {
  std::array<Eigen::Vector3d, 3> v;
  Eigen::Vector3d n;  ///< unit, by the right hand around v
  int element = -1;
  int triangle = -1;

  /// Distance along the ray to the plane; nothing when the ray is parallel to it.
  [[nodiscard]] std::optional<double> plane_range(const Eigen::Vector3d& origin,
                                                  const Eigen::Vector3d& direction) const {
    const double slope = n.dot(direction);
    if (slope == 0.0) return std::nullopt;
    return n.dot(v[0] - origin) / slope;
  }

  /// True when the line through origin along direction meets the triangle, its border included. Two triangles with
  /// a common edge leave no gap: the sign of an edge is the exact opposite seen from the other side.
  [[nodiscard]] bool pierced_by(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// Order of preference among faces at the same range.
  [[nodiscard]] bool precedes(const Face& other) const {
    return element != other.element ? element < other.element : triangle < other.triangle;
  }
};

/// Distances within which hits on faces and edges are decided in double, m.
struct RayTolerances {
  double tie = 1e-4;         ///< faces this close along a ray are one: the lowest id wins
  double coplanar = 2.5e-4;  ///< faces this close to each other may tie: twice `tie` and 2.5 times the inflation
  double edge_band = 5e-4;   ///< hits nearer to an edge than this are settled in double: twice `coplanar`
  double inflation = 2e-5;   ///< Embree's triangles are this much larger, so that it proposes every near miss too
  double mitre_max = 2e-2;   ///< farthest a vertex moves when its triangle is inflated
};

/// Those of a scene whose faces lie up to half_extent_m from its centre along an axis: Embree's error grows with the
/// spacing of floats there. Up to 256 m they are the defaults.
[[nodiscard]] RayTolerances tolerances_at(double half_extent_m);

/// Faces of all triangles with an area above 1e-12 m^2, by triangle id.
[[nodiscard]] std::vector<Face> make_faces(const BuildingMesh& mesh);

/// The triangle moved outwards by `inflation` on each side. exact is false where a sharp corner was cut short.
struct InflatedTriangle {
  std::array<Eigen::Vector3d, 3> v;
  bool exact = true;
};
[[nodiscard]] InflatedTriangle inflate(const Face& face, const RayTolerances& tolerances);

}  // namespace plumbline::bim
