// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/loam/scan_to_scan.h"

#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

#include "slam/odometry/loam/match.h"
#include "slam/odometry/voxel.h"

namespace plumbline::slam::loam {

namespace {

/// Points of the former scan, ring by ring.
class FormerPoints {
 public:
  explicit FormerPoints(std::vector<FeaturePoint> points) : points_(std::move(points)) {}

  struct Found {
    int index = -1;
    double distance2 = std::numeric_limits<double>::infinity();
  };

  /// Nearest point that `wanted` lets through, within max_distance2.
  template <class Wanted>
  [[nodiscard]] Found nearest(const Eigen::Vector3d& p, double max_distance2, Wanted&& wanted) const {
    Found found{-1, max_distance2};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double distance2 = (points_[i].p_R - p).squaredNorm();
      if (distance2 >= found.distance2 || !wanted(static_cast<int>(i))) continue;
      found = {static_cast<int>(i), distance2};
    }
    return found;
  }
  [[nodiscard]] const FeaturePoint& operator[](int i) const { return points_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<FeaturePoint> points_;
};

/// One mean point a voxel and ring.
std::vector<FeaturePoint> thin_by_ring(const std::vector<FeaturePoint>& points, double leaf_m) {
  std::vector<FeaturePoint> out;
  for (std::size_t begin = 0; begin < points.size();) {
    std::vector<Eigen::Vector3d> ring;
    std::size_t end = begin;
    for (; end < points.size() && points[end].ring == points[begin].ring; ++end) ring.push_back(points[end].p_R);
    for (const Eigen::Vector3d& p : voxel_downsample(ring, leaf_m)) out.push_back({p, points[begin].ring});
    begin = end;
  }
  return out;
}

std::optional<Match> match_line(const Eigen::Vector3d& p_R, const Eigen::Vector3d& p_L, const FormerPoints& former,
                                const ScanToScanConfig& config) {
  const auto a = former.nearest(p_L, config.max_distance2_m2, [](int) { return true; });
  if (a.index < 0) return std::nullopt;
  const int ring = former[a.index].ring;
  const auto b = former.nearest(p_L, config.max_distance2_m2, [&](int i) {
    const int gap = std::abs(former[i].ring - ring);
    return gap > 0 && gap <= config.max_rings;
  });
  if (b.index < 0) return std::nullopt;
  return line_match(p_R, former[a.index].p_R, former[b.index].p_R);
}

std::optional<Match> match_plane(const Eigen::Vector3d& p_R, const Eigen::Vector3d& p_L, const FormerPoints& former,
                                 const ScanToScanConfig& config) {
  const auto a = former.nearest(p_L, config.max_distance2_m2, [](int) { return true; });
  if (a.index < 0) return std::nullopt;
  const int ring = former[a.index].ring;
  const auto same =
      former.nearest(p_L, config.max_distance2_m2, [&](int i) { return i != a.index && former[i].ring == ring; });
  const auto other = former.nearest(p_L, config.max_distance2_m2, [&](int i) {
    const int gap = std::abs(former[i].ring - ring);
    return gap > 0 && gap <= config.max_rings;
  });
  if (same.index < 0 || other.index < 0) return std::nullopt;
  return plane_match(p_R, former[a.index].p_R, former[same.index].p_R, former[other.index].p_R);
}

}  // namespace

Pose align_scans(const Features& now, const Features& former, const Pose& X_LR, const ScanToScanConfig& config) {
  const FormerPoints edges(former.less_sharp);
  const FormerPoints planes(thin_by_ring(former.less_flat, config.last_leaf_m));
  Pose X = X_LR;
  std::vector<Match> matches;
  for (int round = 0; round < config.rounds; ++round) {
    matches.clear();
    for (const FeaturePoint& f : now.sharp)
      if (const std::optional<Match> m = match_line(f.p_R, X * f.p_R, edges, config)) matches.push_back(*m);
    for (const FeaturePoint& f : now.flat)
      if (const std::optional<Match> m = match_plane(f.p_R, X * f.p_R, planes, config)) matches.push_back(*m);
    for (int i = 0; i < config.iterations; ++i) {
      const std::optional<Vector6d> step = solve_step(linearize(matches, X, config.huber_m));
      if (!step) return X_LR;
      X = X * exp_se3(*step);
    }
  }
  return X;
}

}  // namespace plumbline::slam::loam
