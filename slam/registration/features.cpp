// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/features.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "slam/scan/voxel.h"

namespace plumbline::slam::loam {

namespace {

constexpr std::size_t reach = 5;  // neighbours on each side that make a curvature

/// One ring's returns in firing order.
class Ring {
 public:
  Ring(const DeskewedScan& scan, int ring, const FeatureConfig& config) : ring_(ring), config_(config) {
    for (int column = 0; column < scan.columns; ++column) {
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (scan.range_m[i] >= config.min_range_m && scan.range_m[i] <= config.max_range_m)
        points_.push_back(scan.point_R[i]);
    }
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
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t k = 1; k <= reach; ++k) sum += points_[i - k] + points_[i + k] - 2.0 * points_[i];
      curvature_[i] = sum.squaredNorm();
    }
  }

  void pick_sector(std::size_t begin, std::size_t end, Features& features, bool all) {
    std::vector<std::size_t> sharp;
    std::vector<std::size_t> flat;
    for (std::size_t i = begin; i < end; ++i)
      if (curvature_[i] > config_.edge_curvature_m2)
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
      if (suppressed_[*i]) continue;
      if (++picked > config_.less_sharp) break;
      if (picked <= config_.sharp) features.sharp.push_back({points_[*i], ring_});
      features.less_sharp.push_back({points_[*i], ring_});
      edge[*i - begin] = true;
      suppress_around(*i);
    }
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
};

}  // namespace

Features find_features(const DeskewedScan& scan, const FeatureConfig& config) {
  Features features;
  if (!has_rings(scan)) return features;
  for (int ring = 0; ring < scan.rings; ++ring) Ring(scan, ring, config).pick(features, true);
  return features;
}

std::vector<FeaturePoint> find_edges(const DeskewedScan& scan, const FeatureConfig& config) {
  Features features;
  for (int ring = 0; ring < scan.rings; ++ring) Ring(scan, ring, config).pick(features, false);
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
