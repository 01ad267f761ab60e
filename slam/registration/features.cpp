// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/features.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "slam/scan/range_noise.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam::loam {

namespace {

constexpr std::size_t reach = 5;  // neighbours on each side that make a curvature

constexpr double sum_of(std::size_t n) { return static_cast<double>(n * (n + 1)) / 2.0; }

/// From a curvature of fewer neighbours on each side to one of `reach`: a corner's sum of vectors grows with the sum of
/// their distances.
double scale_of(std::size_t window) {
  const double longer = sum_of(reach) / sum_of(window);
  return longer * longer;
}

/// Curvature that range noise hardly makes, m^2: the sum of vectors takes each neighbour once and the middle as many
/// times as there are neighbours, so that ten make its variance 110 times that of ranges. 1 return of 370 on a flat
/// wall is beyond three standard deviations. With noise of 1 cm that is the limit of the papers.
double curvature_of_noise(double range_sigma_m, std::size_t window) {
  constexpr double sigmas = 3.0;
  const double neighbours = 2.0 * static_cast<double>(window);
  return scale_of(window) * sigmas * sigmas * (neighbours + neighbours * neighbours) * range_sigma_m * range_sigma_m;
}

/// One ring's returns in firing order.
class Ring {
 public:
  Ring(const DeskewedScan& scan, int ring, const FeatureConfig& config) : ring_(ring), config_(config) {
    constexpr int gap = 3;  // columns; one or two are lost here and there
    int last = -1;
    for (int column = 0; column < scan.columns; ++column) {
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (scan.range_m[i] < config.min_range_m || scan.range_m[i] > config.max_range_m) continue;
      if (column - last > gap) first_after_gap_.push_back(points_.size());
      last = column;
      columns_.push_back(column);
      points_.push_back(scan.point_R[i]);
      ranges_.push_back(scan.range_m[i]);
    }
    ends_ = points_;
    window_.assign(points_.size(), reach);
    casts_shadow_.assign(points_.size(), false);
  }

  /// Ranges of the farther returns beside gaps, in which nothing came back.
  void add_ranges_at_gaps(std::vector<double>& ranges) const {
    for (const std::size_t i : first_after_gap_)
      if (i > 0) ranges.push_back(std::max(ranges_[i - 1], ranges_[i]));
  }
  /// Returns about this far beside gaps are no edges.
  void end_at(double reach_m) { reach_m_ = reach_m; }
  /// Nor are borders of shadows, which go along with the robot [zhang2014], nor anything that noise makes sharp. What
  /// casts a shadow ends there: on average half a step beyond its last return. Neighbours of others are those on this
  /// side of the border: a narrow recess holds true edges, too.
  void end_at_shadows(double range_sigma_m) {
    range_sigma_m_ = range_sigma_m;
    bends_alone_ = true;
    for (std::size_t i = 1; i + 2 < points_.size(); ++i) {
      if (!jumps_after(i)) continue;
      const bool in_front = ranges_[i] < ranges_[i + 1];
      const std::size_t last = in_front ? i : i + 1, before = in_front ? i - 1 : i + 2;
      if (std::abs(ranges_[last] - ranges_[before]) < std::abs(ranges_[i + 1] - ranges_[i]))
        ends_[last] = points_[last] + 0.5 * (points_[last] - points_[before]);
      for (std::size_t k = 0; k < reach; ++k) {
        if (k <= i) window_[i - k] = std::min(window_[i - k], k);
        if (i + 1 + k < window_.size()) window_[i + 1 + k] = std::min(window_[i + 1 + k], k);
      }
      casts_shadow_[last] = true;
    }
    for (std::size_t i = 0; i < window_.size(); ++i)
      if (casts_shadow_[i]) window_[i] = reach;
  }

  /// Edges alone unless `all`.
  void pick(Features& features, bool all) {
    const auto sectors = static_cast<std::size_t>(config_.sectors);
    if (points_.size() < sectors * (2 * reach + 1)) return;
    measure();
    const std::size_t inner = points_.size() - 2 * reach;
    for (std::size_t s = 0; s < sectors; ++s)
      pick_sector(reach + inner * s / sectors, reach + inner * (s + 1) / sectors, features, all);
  }

 private:
  void measure() {
    curvature_.assign(points_.size(), 0.0);
    suppressed_.assign(points_.size(), false);
    for (std::size_t i = reach; i + reach < points_.size(); ++i) {
      if (window_[i] == 0) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t k = 1; k <= window_[i]; ++k) sum += points_[i - k] + points_[i + k] - 2.0 * points_[i];
      if (bends_alone_ && !casts_shadow_[i]) sum = across(sum, points_[i + window_[i]] - points_[i - window_[i]]);
      curvature_[i] = scale_of(window_[i]) * sum.squaredNorm();
    }
  }

  /// Steps along a wall that is seen at a grazing angle grow with range; what they sum up to lies along it.
  [[nodiscard]] static Eigen::Vector3d across(const Eigen::Vector3d& sum, const Eigen::Vector3d& chord) {
    const double length2 = chord.squaredNorm();
    return length2 > 0.0 ? Eigen::Vector3d(sum - chord * (chord.dot(sum) / length2)) : sum;
  }

  /// Sharper than range noise alone makes it.
  [[nodiscard]] bool is_sharp(std::size_t i) const {
    return curvature_[i] > config_.edge_curvature_m2 && curvature_[i] > curvature_of_noise(range_sigma_m_, window_[i]);
  }

  void pick_sector(std::size_t begin, std::size_t end, Features& features, bool all) {
    std::vector<std::size_t> sharp;
    std::vector<std::size_t> flat;
    for (std::size_t i = begin; i < end; ++i)
      if (is_sharp(i))
        sharp.push_back(i);
      else if (all && curvature_[i] < config_.edge_curvature_m2)
        flat.push_back(i);
    std::vector<bool> edge(end - begin);
    pick_edges(by_curvature(std::move(sharp)), begin, edge, features);
    if (!all) return;
    pick_flat(by_curvature(std::move(flat)), features);
    for (std::size_t i = begin; i < end; ++i)
      if (!edge[i - begin]) features.less_flat.push_back({points_[i], ring_});
  }

  [[nodiscard]] std::vector<std::size_t> by_curvature(std::vector<std::size_t> order) const {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return curvature_[a] < curvature_[b]; });
    return order;
  }

  void pick_edges(std::span<const std::size_t> order, std::size_t begin, std::vector<bool>& edge, Features& features) {
    int picked = 0;
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
      if (suppressed_[*i] || is_at_reach(*i)) continue;
      if (++picked > config_.less_sharp) break;
      if (picked <= config_.sharp) features.sharp.push_back({points_[*i], ring_});
      features.less_sharp.push_back({ends_[*i], ring_});
      edge[*i - begin] = true;
      suppress_around(*i);
    }
  }

  /// Whether the range jumps from a return to the next one: by more than noise and several times the steps to either
  /// side. A wall seen at a grazing angle has long steps, but even ones.
  [[nodiscard]] bool jumps_after(std::size_t i) const {
    constexpr double times = 3.0, sigmas = 6.0;
    if (columns_[i + 1] - columns_[i] > static_cast<int>(reach)) return false;
    const auto step = [&](std::size_t k) { return std::abs(ranges_[k + 1] - ranges_[k]); };
    return step(i) >= std::max(times * std::min(step(i - 1), step(i + 1)), sigmas * range_sigma_m_);
  }

  [[nodiscard]] bool is_at_reach(std::size_t i) const {
    constexpr double about = 0.9;
    if (ranges_[i] < about * reach_m_) return false;
    const auto next = std::lower_bound(first_after_gap_.begin(), first_after_gap_.end(), i + 1 - reach);
    return next != first_after_gap_.end() && *next <= i + reach;
  }

  void pick_flat(std::span<const std::size_t> order, Features& features) {
    int picked = 0;
    for (const std::size_t i : order) {
      if (picked == config_.flat) break;
      if (suppressed_[i]) continue;
      features.flat.push_back({points_[i], ring_});
      ++picked;
      suppress_around(i);
    }
  }

  /// No two features from one neighbourhood; a jump in depth ends it.
  void suppress_around(std::size_t i) {
    suppressed_[i] = true;
    const auto joined = [&](std::size_t a, std::size_t b) {
      return (points_[a] - points_[b]).norm() < config_.neighbour_gap_m;
    };
    for (std::size_t k = 1; k <= reach && joined(i + k, i + k - 1); ++k) suppressed_[i + k] = true;
    for (std::size_t k = 1; k <= reach && joined(i - k, i - k + 1); ++k) suppressed_[i - k] = true;
  }

  int ring_;
  const FeatureConfig& config_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> curvature_;
  std::vector<bool> suppressed_;
  std::vector<double> ranges_;
  std::vector<int> columns_;
  std::vector<Eigen::Vector3d> ends_;  ///< the returns, or the ends of surfaces that they are the last ones of
  std::vector<std::size_t> window_;    ///< neighbours on each side that count; 0 at the border of a shadow
  std::vector<bool> casts_shadow_;
  std::vector<std::size_t> first_after_gap_;
  bool bends_alone_ = false;    ///< whether what lies along a surface is no curvature
  double range_sigma_m_ = 0.0;  ///< where noise is to be left out
  double reach_m_ = std::numeric_limits<double>::infinity();
};

/// Where most gaps begin at one range, that is as far as the LiDAR reaches: the ends of surfaces there go along with it
/// and are no edges. Infinite where that is not seen.
double reach_of(const std::vector<Ring>& rings) {
  constexpr std::size_t fewest = 8;
  constexpr double about = 0.95;
  std::vector<double> ranges;
  for (const Ring& ring : rings) ring.add_ranges_at_gaps(ranges);
  if (ranges.size() < fewest) return std::numeric_limits<double>::infinity();
  const double farthest = *std::max_element(ranges.begin(), ranges.end());
  const auto at_reach = std::count_if(ranges.begin(), ranges.end(), [&](double r) { return r > about * farthest; });
  return 2 * static_cast<std::size_t>(at_reach) > ranges.size() ? farthest : std::numeric_limits<double>::infinity();
}

}  // namespace

Features find_features(const DeskewedScan& scan, const FeatureConfig& config) {
  Features features;
  if (!has_rings(scan)) return features;
  for (int ring = 0; ring < scan.rings; ++ring) Ring(scan, ring, config).pick(features, true);
  return features;
}

std::vector<FeaturePoint> find_edges(const DeskewedScan& scan, const FeatureConfig& config) {
  const double range_sigma_m = range_noise(scan);
  std::vector<Ring> rings;
  for (int ring = 0; ring < scan.rings; ++ring) rings.emplace_back(scan, ring, config);
  const double reach_m = reach_of(rings);
  Features features;
  for (Ring& ring : rings) {
    ring.end_at(reach_m);
    ring.end_at_shadows(range_sigma_m);
    ring.pick(features, false);
  }
  return std::move(features.less_sharp);
}

std::vector<Eigen::Vector3d> first_of_each_leaf(const std::vector<FeaturePoint>& features, double leaf_m) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(features.size());
  VoxelIndex seen;
  for (const FeaturePoint& feature : features) {
    const int before = seen.size();
    if (seen.insert(VoxelKey::of(feature.p_R, leaf_m)) == before) out.push_back(feature.p_R);
  }
  return out;
}

}  // namespace plumbline::slam::loam
