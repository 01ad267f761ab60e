// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/lego_features.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "slam/scan/voxel.h"

namespace plumbline::slam::lego {

namespace {

constexpr std::size_t reach = 5;
constexpr int near_columns = 10;

class Ring {
 public:
  Ring(const std::vector<ImagePoint>& points, const FeatureConfig& config)
      : points_(points), config_(config), curvature_(points.size(), 0.0), barred_(points.size(), false) {}

  void pick(Features& features) {
    const auto sectors = static_cast<std::size_t>(config_.sectors);
    if (points_.size() < 2 * reach + sectors) return;
    for (std::size_t i = reach; i + reach < points_.size(); ++i) {
      double sum = -10.0 * points_[i].range_m;
      for (std::size_t k = 1; k <= reach; ++k) sum += points_[i - k].range_m + points_[i + k].range_m;
      curvature_[i] = sum * sum;
    }
    bar_occluded();
    std::vector<ImagePoint> rest;
    const std::size_t inner = points_.size() - 2 * reach;
    for (std::size_t s = 0; s < sectors; ++s)
      pick_sector(reach + inner * s / sectors, reach + inner * (s + 1) / sectors, features, rest);
    thin(rest, features);
  }

 private:
  /// The far side of a jump in depth, and points on surfaces that the beam grazes.
  void bar_occluded() {
    for (std::size_t i = reach; i + reach + 1 < points_.size(); ++i) {
      const double now = points_[i].range_m, next = points_[i + 1].range_m, before = points_[i - 1].range_m;
      if (std::abs(points_[i + 1].column - points_[i].column) < near_columns) {
        if (now - next > 0.3)
          for (std::size_t k = 0; k <= reach; ++k) barred_[i - k] = true;
        else if (next - now > 0.3)
          for (std::size_t k = 1; k <= reach + 1; ++k) barred_[i + k] = true;
      }
      if (std::abs(before - now) > 0.02 * now && std::abs(next - now) > 0.02 * now) barred_[i] = true;
    }
  }

  void pick_sector(std::size_t begin, std::size_t end, Features& features, std::vector<ImagePoint>& rest) {
    std::vector<std::size_t> order;
    for (std::size_t i = begin; i < end; ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return curvature_[a] < curvature_[b]; });
    std::vector<bool> edge(points_.size(), false);
    int picked = 0;
    for (auto i = order.rbegin(); i != order.rend() && picked < config_.less_sharp; ++i) {
      if (barred_[*i] || !(curvature_[*i] > config_.curvature_m2) || points_[*i].cell == Cell::ground) continue;
      if (picked++ < config_.sharp) features.sharp.push_back(points_[*i]);
      features.less_sharp.push_back(points_[*i]);
      edge[*i] = true;
      bar_around(*i);
    }
    picked = 0;
    for (const std::size_t i : order) {
      if (picked == config_.flat) break;
      if (barred_[i] || !(curvature_[i] < config_.curvature_m2) || points_[i].cell != Cell::ground) continue;
      features.flat.push_back(points_[i]);
      ++picked;
      bar_around(i);
    }
    for (std::size_t i = begin; i < end; ++i)
      if (!edge[i]) rest.push_back(points_[i]);
  }

  void bar_around(std::size_t i) {
    barred_[i] = true;
    const auto near = [&](std::size_t a, std::size_t b) {
      return std::abs(points_[a].column - points_[b].column) <= near_columns;
    };
    for (std::size_t k = 1; k <= reach && near(i + k, i + k - 1); ++k) barred_[i + k] = true;
    for (std::size_t k = 1; k <= reach && near(i - k, i - k + 1); ++k) barred_[i - k] = true;
  }

  void thin(const std::vector<ImagePoint>& rest, Features& features) const {
    VoxelIndex seen;
    for (const ImagePoint& point : rest) {
      const int before = seen.size();
      if (seen.insert(VoxelKey::of(point.p_R, config_.less_flat_leaf_m)) == before) features.less_flat.push_back(point);
    }
  }

  const std::vector<ImagePoint>& points_;
  const FeatureConfig& config_;
  std::vector<double> curvature_;
  std::vector<bool> barred_;
};

}  // namespace

Features find_features(const SegmentedCloud& cloud, const FeatureConfig& config) {
  Features features;
  for (const std::vector<ImagePoint>& row : cloud.rows) Ring(row, config).pick(features);
  return features;
}

}  // namespace plumbline::slam::lego
