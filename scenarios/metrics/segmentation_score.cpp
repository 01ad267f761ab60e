// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/segmentation_score.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace plumbline::scenarios::score {

namespace {

/// Returns of one scan by plane, by surface, and by both; planes and surfaces of -1 are left out.
struct Counts {
  std::map<int, int> plane, surface;
  std::map<std::pair<int, int>, int> both;
};

Counts count(const slam::SegmentedScan& scan, const Truth& truth, SurfaceLabels& labels) {
  const Pose X_WR = truth.at(scan.stamp);
  const Eigen::Vector3d sensor_W = X_WR * scan.sensor_R;
  Counts counts;
  for (std::size_t i = 0; i < scan.point_mm.size(); ++i) {
    const int surface = labels.of(X_WR * (1e-3 * scan.point_mm[i].cast<double>()), sensor_W);
    if (surface < 0) continue;
    ++counts.surface[surface];
    if (scan.plane[i] < 0) continue;
    ++counts.plane[scan.plane[i]];
    ++counts.both[{scan.plane[i], surface}];
  }
  return counts;
}

/// The surface that most of a plane's returns are of (ties: the lower one), and how many they are.
std::pair<int, int> main_surface(const Counts& counts, int plane) {
  std::pair<int, int> best{-1, 0};
  for (const auto& [key, n] : counts.both)
    if (key.first == plane && n > best.second) best = {key.second, n};
  return best;
}

}  // namespace

SurfaceLabels::SurfaceLabels(const bim::BuildingMesh& mesh, const SurfaceDistance& distance,
                             const SegmentationRules& rules)
    : mesh_(mesh), distance_(distance), rules_(rules), surface_of_triangle_(mesh.triangles.size(), -1) {}

Plane SurfaceLabels::plane_of(int triangle) const {
  const Eigen::Vector3i& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
  const auto vertex = [&](int k) { return mesh_.vertices[static_cast<std::size_t>(t[k])]; };
  const Eigen::Vector3d n = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).normalized();
  return {n, -n.dot((vertex(0) + vertex(1) + vertex(2)) / 3.0)};
}

int SurfaceLabels::surface_of(int triangle) {
  int& known = surface_of_triangle_[static_cast<std::size_t>(triangle)];
  if (known >= 0) return known;
  const Plane plane = plane_of(triangle);
  const Eigen::Vector3i& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
  const double cos_limit = std::cos(rules_.same_deg * std::numbers::pi / 180.0);
  const auto same = [&](const Plane& other) {
    if (other.n.dot(plane.n) < cos_limit) return false;
    for (int k = 0; k < 3; ++k)
      if (std::abs(other.distance(mesh_.vertices[static_cast<std::size_t>(t[k])])) > rules_.same_m) return false;
    return true;
  };
  const auto it = std::find_if(surfaces_.begin(), surfaces_.end(), same);
  known = static_cast<int>(it - surfaces_.begin());
  if (it == surfaces_.end()) surfaces_.push_back(plane);
  return known;
}

int SurfaceLabels::of(const Eigen::Vector3d& p_W, const Eigen::Vector3d& from_W) {
  std::vector<NearTriangle> near = distance_.near(p_W, rules_.within_m + rules_.apart_m);
  std::erase_if(near, [&](const NearTriangle& t) { return !(plane_of(t.triangle).distance(from_W) > 0.0); });
  const auto nearer = [](const NearTriangle& a, const NearTriangle& b) {
    return std::pair(a.distance_m, a.triangle) < std::pair(b.distance_m, b.triangle);
  };
  const auto nearest = std::min_element(near.begin(), near.end(), nearer);
  if (nearest == near.end() || nearest->distance_m > rules_.within_m) return -1;
  const int surface = surface_of(nearest->triangle);
  for (const NearTriangle& other : near)
    if (other.distance_m <= nearest->distance_m + rules_.apart_m && surface_of(other.triangle) != surface) return -1;
  return surface;
}

SegmentationScore score_segmentation(const std::vector<slam::SegmentedScan>& scans, const Truth& truth,
                                     const bim::BuildingMesh& mesh, const SurfaceDistance& distance,
                                     const SegmentationRules& rules) {
  SegmentationScore score;
  SurfaceLabels labels(mesh, distance, rules);
  int precise = 0, surfaces_with_planes = 0, planes_on_them = 0;
  std::int64_t returns = 0, returns_in_planes = 0;
  for (const slam::SegmentedScan& scan : scans) {
    const Counts counts = count(scan, truth, labels);
    std::map<int, std::pair<int, int>> of_surface;  // planes, and their returns on it
    for (const auto& [plane, n] : counts.plane) {
      const auto [surface, on_it] = main_surface(counts, plane);
      if (n >= rules.least_returns) {
        ++score.planes;
        precise += on_it >= rules.precise * n;
      }
      ++of_surface[surface].first;
      of_surface[surface].second += on_it;
    }
    for (const auto& [surface, n] : counts.surface) {
      if (n < rules.least_returns) continue;
      ++score.surfaces;
      returns += n;
      const auto it = of_surface.find(surface);
      if (it == of_surface.end()) continue;
      returns_in_planes += it->second.second;
      ++surfaces_with_planes;
      planes_on_them += it->second.first;
    }
  }
  if (score.planes > 0) score.precision = static_cast<double>(precise) / score.planes;
  if (returns > 0) score.recall = static_cast<double>(returns_in_planes) / static_cast<double>(returns);
  if (surfaces_with_planes > 0) score.planes_per_surface = static_cast<double>(planes_on_them) / surfaces_with_planes;
  return score;
}

}  // namespace plumbline::scenarios::score
