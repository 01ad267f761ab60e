// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/scan_to_scan.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "slam/registration/match.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam::loam {

namespace {

/// Points of the former scan, ring by ring.
class FormerPoints {
 public:
  explicit FormerPoints(std::vector<FeaturePoint> points) : points_(std::move(points)) {
    for (std::size_t i = 0; i < points_.size(); ++i)
      while (static_cast<int>(begins_.size()) <= points_[i].ring) begins_.push_back(i);
  }

  /// Nearest point on the rings [first, last] but `without`, -1 when none is within max_distance2.
  [[nodiscard]] int nearest(const Eigen::Vector3d& p, double max_distance2, int first, int last, int without) const {
    double best = max_distance2;
    int found = -1;
    for (std::size_t i = begin_of(first); i < begin_of(last + 1); ++i) {
      const double distance2 = (points_[i].p_R - p).squaredNorm();
      if (distance2 >= best || static_cast<int>(i) == without) continue;
      best = distance2;
      found = static_cast<int>(i);
    }
    return found;
  }
  /// Nearest of all.
  [[nodiscard]] int nearest(const Eigen::Vector3d& p, double max_distance2) const {
    return nearest(p, max_distance2, 0, rings(), -1);
  }
  /// Nearest on the rings beside that of point a, up to `reach` away (ties: the lower ring).
  [[nodiscard]] int nearest_beside(const Eigen::Vector3d& p, double max_distance2, int a, int reach) const {
    const int ring = (*this)[a].ring;
    const int below = nearest(p, max_distance2, ring - reach, ring - 1, -1);
    const int above = nearest(p, max_distance2, ring + 1, ring + reach, -1);
    if (below < 0 || above < 0) return std::max(below, above);
    return ((*this)[above].p_R - p).squaredNorm() < ((*this)[below].p_R - p).squaredNorm() ? above : below;
  }
  [[nodiscard]] int nearest_on_ring(const Eigen::Vector3d& p, double max_distance2, int a) const {
    return nearest(p, max_distance2, (*this)[a].ring, (*this)[a].ring, a);
  }
  [[nodiscard]] const FeaturePoint& operator[](int i) const { return points_[static_cast<std::size_t>(i)]; }

 private:
  [[nodiscard]] int rings() const { return static_cast<int>(begins_.size()); }
  [[nodiscard]] std::size_t begin_of(int ring) const {
    if (ring <= 0) return 0;
    return ring < rings() ? begins_[static_cast<std::size_t>(ring)] : points_.size();
  }

  std::vector<FeaturePoint> points_;
  std::vector<std::size_t> begins_;  ///< first point of each ring
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
  const int a = former.nearest(p_L, config.max_distance2_m2);
  if (a < 0) return std::nullopt;
  const int b = former.nearest_beside(p_L, config.max_distance2_m2, a, config.max_rings);
  if (b < 0) return std::nullopt;
  return line_match(p_R, former[a].p_R, former[b].p_R);
}

std::optional<Match> match_plane(const Eigen::Vector3d& p_R, const Eigen::Vector3d& p_L, const FormerPoints& former,
                                 const ScanToScanConfig& config) {
  const int a = former.nearest(p_L, config.max_distance2_m2);
  if (a < 0) return std::nullopt;
  const int same = former.nearest_on_ring(p_L, config.max_distance2_m2, a);
  const int beside = former.nearest_beside(p_L, config.max_distance2_m2, a, config.max_rings);
  if (same < 0 || beside < 0) return std::nullopt;
  return plane_match(p_R, former[a].p_R, former[same].p_R, former[beside].p_R);
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
