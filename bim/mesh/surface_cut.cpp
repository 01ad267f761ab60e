// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/surface_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bim/geometry/plane.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// A face of the solid: its plane, and where it is.
struct CuttingFace {
  Plane plane;
  Eigen::AlignedBox3d box;
};

Triangle corners(const Solid& solid, const Eigen::Vector3i& t) {
  return {solid.vertices[static_cast<std::size_t>(t[0])], solid.vertices[static_cast<std::size_t>(t[1])],
          solid.vertices[static_cast<std::size_t>(t[2])]};
}

Eigen::AlignedBox3d box_of(const Triangle& t) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : t) box.extend(p);
  return box;
}

/// Faces of one plane as one, so that a prism has as many as it has sides.
std::vector<CuttingFace> faces_of(const Solid& solid, double grid_m) {
  std::vector<CuttingFace> faces;
  for (const Eigen::Vector3i& triangle : solid.triangles) {
    const Triangle t = corners(solid, triangle);
    const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
    if (n.norm() <= grid_m * grid_m) continue;
    const Plane plane{n.normalized(), -n.normalized().dot(t[0])};
    const auto same = std::find_if(faces.begin(), faces.end(), [&](const CuttingFace& face) {
      return std::all_of(t.begin(), t.end(),
                         [&](const Eigen::Vector3d& p) { return std::abs(face.plane.distance(p)) <= grid_m; });
    });
    if (same == faces.end())
      faces.push_back({plane, box_of(t)});
    else
      same->box.extend(box_of(t));
  }
  return faces;
}

/// The pieces of a triangle on either side of a plane; the triangle itself where it lies on one side.
void split(const Triangle& t, const Plane& plane, double grid_m, std::vector<Triangle>& pieces) {
  std::array<double, 3> d;
  for (std::size_t k = 0; k < 3; ++k) d[k] = plane.distance(t[k]);
  const bool above = std::any_of(d.begin(), d.end(), [&](double v) { return v > grid_m; });
  const bool below = std::any_of(d.begin(), d.end(), [&](double v) { return v < -grid_m; });
  if (!above || !below) return pieces.push_back(t);
  for (const double sign : {1.0, -1.0}) {
    std::vector<Eigen::Vector3d> side;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = (k + 1) % 3;
      if (sign * d[k] >= 0.0) side.push_back(t[k]);
      if ((d[k] > 0.0 && d[n] < 0.0) || (d[k] < 0.0 && d[n] > 0.0))
        side.emplace_back(t[k] + (t[n] - t[k]) * (d[k] / (d[k] - d[n])));
    }
    for (std::size_t i = 1; i + 1 < side.size(); ++i) pieces.push_back({side[0], side[i], side[i + 1]});
  }
}

/// Solid angle of a closed surface seen from a point over 4 pi: 1 inside, 0 outside [vanoosterom1983].
double winding(const Solid& solid, const Eigen::Vector3d& at) {
  double sum = 0.0;
  for (const Eigen::Vector3i& triangle : solid.triangles) {
    const Triangle t = corners(solid, triangle);
    const Eigen::Vector3d a = t[0] - at, b = t[1] - at, c = t[2] - at;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    sum += std::atan2(a.dot(b.cross(c)), below);
  }
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace

Solid surface_cut(const Solid& surface, const BooleanStep& step, double grid_m) {
  const std::vector<CuttingFace> faces = faces_of(step.other, grid_m);
  Eigen::AlignedBox3d whole;
  for (const CuttingFace& face : faces) whole.extend(face.box);
  const double wanted = step.operation == BooleanOperation::intersection ? 1.0 : 0.0;
  Solid rest;
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    std::vector<Triangle> pieces = {corners(surface, triangle)};
    if (!whole.intersects(box_of(pieces.front()))) {
      if (wanted == 1.0) continue;
    } else {
      for (const CuttingFace& face : faces) {
        std::vector<Triangle> next;
        for (const Triangle& piece : pieces) {
          if (face.box.intersects(box_of(piece)))
            split(piece, face.plane, grid_m, next);
          else
            next.push_back(piece);
        }
        pieces = std::move(next);
      }
      std::erase_if(pieces, [&](const Triangle& t) {
        return std::abs(winding(step.other, (t[0] + t[1] + t[2]) / 3.0) - wanted) > 0.5;
      });
    }
    for (const Triangle& t : pieces) {
      const int first = static_cast<int>(rest.vertices.size());
      rest.vertices.insert(rest.vertices.end(), t.begin(), t.end());
      rest.triangles.emplace_back(first, first + 1, first + 2);
    }
  }
  return welded(rest, grid_m);
}

}  // namespace plumbline::bim
