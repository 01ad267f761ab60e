// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/keyframe_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/geometry/symmetric.h"
#include "slam/loam/degeneracy.h"
#include "slam/registration/match.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam::loam {

namespace {

constexpr double least_weight = 0.1;

bool five_nearest(const KdTree& map, const Eigen::Vector3d& p_M, double max_distance2, PointMap::Neighbours& found) {
  const auto near = map.nearest(p_M, found.size());
  if (near.size() < found.size() || !(near.back().distance2 < max_distance2)) return false;
  for (std::size_t k = 0; k < found.size(); ++k) found[k] = map.points()[near[k].index];
  return true;
}

/// A match's weight by its residual; the square stands in for that of the row and of the residual.
bool weigh(Match& match, const Pose& X_MR, double per_m, double scale) {
  const double residual = (match.across * (X_MR * match.p_R - match.anchor_F)).norm();
  const double weight = 1.0 - per_m * residual / scale;
  if (!(weight > least_weight)) return false;
  match.across *= weight * weight;
  return true;
}

}  // namespace

MapFeatures thinned(const MapFeatures& features, const KeyframeMapConfig& config) {
  return {voxel_downsample(features.edges_R, config.edge_leaf_m),
          voxel_downsample(features.flats_R, config.flat_leaf_m)};
}

void KeyframeMap::add(const Pose& X_MR, MapFeatures features) { keyframes_.push_back({X_MR, std::move(features)}); }

void KeyframeMap::set_pose(std::size_t keyframe, const Pose& X_MR) {
  keyframes_[keyframe].X_MR = X_MR;
  submap_.reset();
}

std::vector<std::size_t> KeyframeMap::around(const Eigen::Vector3d& p_M) const {
  VoxelIndex taken;
  std::vector<std::size_t> selected;
  for (std::size_t k = keyframes_.size(); k-- > 0;) {
    const Eigen::Vector3d& t = keyframes_[k].X_MR.t;
    if ((t - p_M).norm() > config_.radius_m) continue;
    const int before = taken.size();
    if (taken.insert(VoxelKey::of(t, config_.keyframe_voxel_m)) == before) selected.push_back(k);
  }
  std::reverse(selected.begin(), selected.end());
  return selected;
}

void KeyframeMap::update_submap(const Eigen::Vector3d& p_M) {
  std::vector<std::size_t> selected = around(p_M);
  if (submap_ && selected == selected_) return;
  selected_ = std::move(selected);
  VoxelMeans edges(config_.edge_leaf_m), flats(config_.flat_leaf_m);
  for (const std::size_t k : selected_) {
    const Keyframe& keyframe = keyframes_[k];
    for (const Eigen::Vector3d& p_R : keyframe.features.edges_R) edges.add(keyframe.X_MR * p_R);
    for (const Eigen::Vector3d& p_R : keyframe.features.flats_R) flats.add(keyframe.X_MR * p_R);
  }
  submap_.emplace(Submap{KdTree(edges.means()), KdTree(flats.means())});
}

MapAlignment KeyframeMap::align(const MapFeatures& features, const Pose& start) {
  MapAlignment result{start};
  update_submap(start.t);
  if (submap_->edges.points().size() <= static_cast<std::size_t>(config_.least_edges) ||
      submap_->flats.points().size() <= static_cast<std::size_t>(config_.least_flats))
    return result;
  Pose X_MR = start;
  std::optional<GoodDirections> good;
  constexpr double never_m = 1e9;
  for (int round = 0; round < config_.rounds; ++round) {
    std::vector<Match> matches;
    PointMap::Neighbours near;
    const auto add = [&](std::optional<Match> match, double scale) {
      if (match && (config_.residual_weight == 0.0 || weigh(*match, X_MR, config_.residual_weight, scale)))
        matches.push_back(*match);
    };
    for (const Eigen::Vector3d& p_R : features.edges_R)
      if (five_nearest(submap_->edges, X_MR * p_R, config_.max_distance2_m2, near))
        add(line_match(p_R, near, config_.line_ratio), 1.0);
    for (const Eigen::Vector3d& p_R : features.flats_R)
      if (five_nearest(submap_->flats, X_MR * p_R, config_.max_distance2_m2, near))
        add(plane_match(p_R, near, 1.0, config_.plane_tolerance_m), std::sqrt(std::max(p_R.norm(), 1e-3)));
    if (matches.size() < static_cast<std::size_t>(config_.least_matches)) return result;
    Vector6d step = Vector6d::Zero();
    for (int i = 0; i < config_.iterations; ++i) {
      const Normal6 normal = linearize(matches, X_MR, config_.huber_m > 0.0 ? config_.huber_m : never_m);
      if (!good) good = good_directions(normal.h, config_.least_eigenvalue);
      result.normal = normal.h;
      step = -solve_ldlt(Matrix6d(normal.h + 1e-9 * Matrix6d::Identity()), normal.g);
      if (!step.allFinite()) return result;
      step = good->projection * step;
      X_MR = X_MR * exp_se3(step);
      X_MR.q.normalize();
    }
    if (step.head<3>().norm() < 5e-4 && step.tail<3>().norm() < 8.7e-4) break;
  }
  result.X_MR = X_MR;
  result.found = true;
  result.degenerate = good ? good->degenerate : 0;
  return result;
}

}  // namespace plumbline::slam::loam
