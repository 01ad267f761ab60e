// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/membrane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace plumbline::bim {
namespace {

struct Face {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal, middle;
  Eigen::AlignedBox3d box;
};

/// Those with a height that the grid can tell, by where they begin along x.
std::vector<Face> faces_of(const Solid& solid, double grid_m) {
  std::vector<Face> faces;
  for (const Eigen::Vector3i& t : solid.triangles) {
    Face face;
    for (int k = 0; k < 3; ++k)
      face.corners[static_cast<std::size_t>(k)] = solid.vertices[static_cast<std::size_t>(t[k])];
    const auto& [a, b, c] = face.corners;
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (cross.norm() <= 2.0 * grid_m * longest) continue;
    face.normal = cross.normalized();
    face.middle = (a + b + c) / 3.0;
    for (const Eigen::Vector3d& p : face.corners) face.box.extend(p);
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.box.min().x() < b.box.min().x(); });
  return faces;
}

/// Whether a point lies on a face, no further than `near_m` from its plane.
bool lies_on(const Eigen::Vector3d& p, const Face& face, double near_m) {
  if (std::abs(face.normal.dot(p - face.corners[0])) > near_m) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &from = face.corners[k], &to = face.corners[(k + 1) % 3];
    if (face.normal.dot((to - from).cross(p - from)) < 0.0) return false;
  }
  return true;
}

}  // namespace

bool has_membrane(const Solid& solid, double grid_m) {
  // Rounding moves a point by up to half a step along each axis, so two faces by less than two steps.
  const double near_m = 2.0 * grid_m;
  constexpr double back_to_back = -0.999;
  const std::vector<Face> faces = faces_of(solid, grid_m);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(near_m);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Eigen::AlignedBox3d reach(faces[i].box.min() - margin, faces[i].box.max() + margin);
    for (std::size_t k = i + 1; k < faces.size() && faces[k].box.min().x() <= reach.max().x(); ++k) {
      if (!reach.intersects(faces[k].box) || faces[i].normal.dot(faces[k].normal) > back_to_back) continue;
      if (lies_on(faces[i].middle, faces[k], near_m) || lies_on(faces[k].middle, faces[i], near_m)) return true;
    }
  }
  return false;
}

}  // namespace plumbline::bim
