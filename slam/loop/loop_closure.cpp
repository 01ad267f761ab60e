// SPDX-License-Identifier: Apache-2.0
#include "slam/loop/loop_closure.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace plumbline::slam {

std::optional<PoseFactor> LoopClosure::update(const Graph& graph, const DeskewedScan& scan, double walked_m) {
  entries_.push_back({make_surfels(scan, config_.surfels), walked_m});
  if (walked_m - last_attempt_m_ < config_.min_since_last_m) return {};
  const std::optional<int> old = candidate(graph);
  if (!old) return {};
  last_attempt_m_ = walked_m;
  return verify(graph, *old);
}

std::optional<int> LoopClosure::candidate(const Graph& graph) const {
  const KeyframeVertex& now = graph.keyframes.back();
  std::optional<int> nearest;
  double distance = config_.radius_m;
  for (std::size_t k = 0; k + 1 < graph.keyframes.size(); ++k) {
    if (entries_.back().walked_m - entries_[k].walked_m < config_.min_walked_m) break;
    if (graph.keyframes[k].storey != now.storey) continue;
    const double d = (graph.keyframes[k].X_MR.t - now.X_MR.t).head<2>().norm();
    if (d >= distance) continue;
    distance = d;
    nearest = static_cast<int>(k);
  }
  return nearest;
}

std::optional<PoseFactor> LoopClosure::verify(const Graph& graph, int old) const {
  const int now = static_cast<int>(graph.keyframes.size()) - 1;
  const Pose X_MI = graph.keyframes[static_cast<std::size_t>(old)].X_MR;
  const Pose X_IM = X_MI.inverse();
  SurfelMap map_I(config_.voxel_m);
  const int first = std::max(0, old - config_.map_keyframes);
  const int last = std::min(now - 1, old + config_.map_keyframes);
  for (int k = first; k <= last; ++k) {
    const KeyframeVertex& keyframe = graph.keyframes[static_cast<std::size_t>(k)];
    if (keyframe.storey == graph.keyframes.back().storey)
      map_I.add(entries_[static_cast<std::size_t>(k)].surfels, X_IM * keyframe.X_MR);
  }
  const Pose start_IR = X_IM * graph.keyframes.back().X_MR;
  const Registration found = align(entries_.back().surfels, map_I, start_IR, std::nullopt, config_.registration);
  if (!found.converged || found.matched < config_.min_matched || found.rms > config_.max_rms) return {};
  const Pose correction = start_IR.inverse() * found.X_MR;
  const double walked = entries_.back().walked_m - entries_[static_cast<std::size_t>(old)].walked_m;
  if (correction.t.norm() > config_.max_shift_m + config_.max_shift_per_m * walked) return {};
  if (log_so3(correction.q).norm() > config_.max_turn_rad) return {};
  return PoseFactor{old, now, found.X_MR,
                    trusted_information(found.information, config_.inflation, config_.sigma_m, config_.sigma_rad),
                    true};
}

Matrix6d trusted_information(const Matrix6d& hessian, double inflation, double sigma_m, double sigma_rad) {
  constexpr double unknown_m = 1.0, unknown_rad = 1.0;
  Vector6d prior, added;
  prior << Eigen::Vector3d::Constant(1.0 / (unknown_m * unknown_m)),
      Eigen::Vector3d::Constant(1.0 / (unknown_rad * unknown_rad));
  added << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  const Matrix6d information = hessian / inflation + Matrix6d(prior.asDiagonal());
  const Matrix6d covariance = information.llt().solve(Matrix6d::Identity()) + Matrix6d(added.asDiagonal());
  const Matrix6d result = covariance.llt().solve(Matrix6d::Identity());
  return 0.5 * (result + result.transpose());
}

}  // namespace plumbline::slam
