// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/face.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

constexpr double area_min_m2 = 1e-12;

}  // namespace

bool Face::pierced_by(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d a = v[0] - origin;
  const Eigen::Vector3d b = v[1] - origin;
  const Eigen::Vector3d c = v[2] - origin;
  const double ab = direction.dot(a.cross(b));
  const double bc = direction.dot(b.cross(c));
  const double ca = direction.dot(c.cross(a));
  const bool left = ab >= 0.0 && bc >= 0.0 && ca >= 0.0;
  const bool right = ab <= 0.0 && bc <= 0.0 && ca <= 0.0;
  return left != right;
}

RayTolerances tolerances_at(double half_extent_m) {
  constexpr double float_spacings = 2.0;  // vertex and origin may each be off by half of one along three axes: 1.73
  RayTolerances tolerances;
  const auto extent = static_cast<float>(half_extent_m);
  const auto spacing = static_cast<double>(std::nextafter(extent, std::numeric_limits<float>::infinity()) - extent);
  if (half_extent_m < 256.0) return tolerances;
  tolerances.inflation = float_spacings * spacing;
  tolerances.coplanar = 2.0 * tolerances.tie + 2.5 * tolerances.inflation;
  tolerances.edge_band = 2.0 * tolerances.coplanar;
  return tolerances;
}

std::vector<Face> make_faces(const BuildingMesh& mesh) {
  if (mesh.element.size() != mesh.triangles.size()) throw InternalError("mesh has triangles without an element");
  std::vector<Face> faces;
  faces.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Face face;
    for (int k = 0; k < 3; ++k)
      face.v[static_cast<std::size_t>(k)] = mesh.vertices.at(static_cast<std::size_t>(mesh.triangles[i][k]));
    const Eigen::Vector3d normal = (face.v[1] - face.v[0]).cross(face.v[2] - face.v[0]);
    const double norm = normal.norm();
    if (!(norm > 2.0 * area_min_m2)) continue;
    face.n = normal / norm;
    face.element = mesh.element[i];
    face.triangle = static_cast<int>(i);
    faces.push_back(face);
  }
  return faces;
}

InflatedTriangle inflate(const Face& face, const RayTolerances& tolerances) {
  InflatedTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d e = (face.v[(k + 1) % 3] - face.v[k]).normalized();
    const Eigen::Vector3d f = (face.v[(k + 2) % 3] - face.v[k]).normalized();
    // Both sides move out by the inflation; their new meeting point is -inflation / sin(angle) along e and f.
    const double sine = e.cross(f).norm();
    Eigen::Vector3d shift = -(e + f) * (tolerances.inflation / sine);
    const double length = shift.norm();
    if (!(length <= tolerances.mitre_max)) {
      result.exact = false;
      shift = -(e + f).normalized() * tolerances.mitre_max;
    }
    result.v[k] = face.v[k] + shift;
  }
  return result;
}

}  // namespace plumbline::bim
