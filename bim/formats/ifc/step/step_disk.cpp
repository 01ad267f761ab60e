// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_disk.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace plumbline::bim {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Without points on the one before them.
Points apart(const Points& line) {
  constexpr double least_m = 1e-6;
  Points points;
  for (const Eigen::Vector3d& p : line)
    if (points.empty() || (p - points.back()).norm() > least_m) points.push_back(p);
  return points;
}

Points circle(const Eigen::Vector3d& middle, const Eigen::Vector3d& axis, double radius_m, int corners) {
  const Eigen::Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
  Points points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    points.emplace_back(middle + radius_m * (std::cos(angle) * x + std::sin(angle) * y));
  }
  return points;
}

/// Circles at every point of the line, each in the plane that halves the bend there; empty at a bend that is too sharp.
Points tube(const Points& line, double radius_m, int corners) {
  constexpr double least_cosine = 0.2;
  Eigen::Vector3d along = (line[1] - line[0]).normalized();
  Points ring = circle(line[0], along, radius_m, corners), points;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Eigen::Vector3d next = k + 1 < line.size() ? (line[k + 1] - line[k]).normalized() : along;
    const Eigen::Vector3d normal = (along + next).normalized();
    if (!(normal.dot(along) > least_cosine)) return {};
    for (Eigen::Vector3d& p : ring) p += normal.dot(line[k] - p) / normal.dot(along) * along;
    points.insert(points.end(), ring.begin(), ring.end());
    along = next;
  }
  return points;
}

/// Loops between two rows of corners that each begin at an index, outward where the second lies ahead of the first.
void add_band(int low, int high, int corners, Facets& facets) {
  for (int i = 0; i < corners; ++i) {
    const int k = (i + 1) % corners;
    facets.loops.push_back({low + i, low + k, high + k});
    facets.loops.push_back({low + i, high + k, high + i});
  }
}

void add_cap(int first, int corners, bool ahead, Facets& facets) {
  std::vector<int>& loop = facets.loops.emplace_back();
  for (int i = 0; i < corners; ++i) loop.push_back(first + (ahead ? i : corners - 1 - i));
}

}  // namespace

bool begins_upright(const Points& line) {
  constexpr double level = 1e-9;
  if (line.size() < 2) return false;
  const Eigen::Vector3d d = line[1] - line[0];
  return d.head<2>().norm() <= level * std::abs(d.z());
}

Facets swept_disk(const Points& line, const SweptDisk& disk) {
  constexpr double least_m = 1e-6;
  constexpr std::size_t most_corners = 1'000'000;
  const Points middle = apart(line);
  if (middle.size() < 2 || !(disk.radius_m > least_m) || !(disk.inner_m < disk.radius_m) || disk.corners < 3) return {};
  if (middle.size() > most_corners / static_cast<std::size_t>(disk.corners)) return {};
  Facets facets;
  facets.points = tube(middle, disk.radius_m, disk.corners);
  if (facets.points.empty()) return {};
  const auto outer = static_cast<int>(facets.points.size());
  const int last = outer - disk.corners;
  for (int row = 0; row < last; row += disk.corners) add_band(row, row + disk.corners, disk.corners, facets);
  if (!(disk.inner_m > least_m)) {
    add_cap(0, disk.corners, false, facets);
    add_cap(last, disk.corners, true, facets);
    return facets;
  }
  const Points hole = tube(middle, disk.inner_m, disk.corners);
  facets.points.insert(facets.points.end(), hole.begin(), hole.end());
  for (int row = 0; row < last; row += disk.corners)
    add_band(outer + row + disk.corners, outer + row, disk.corners, facets);
  add_band(outer, 0, disk.corners, facets);
  add_band(last, outer + last, disk.corners, facets);
  return facets;
}

}  // namespace plumbline::bim
