// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/rough_points.h"

#include <utility>

namespace plumbline::slam {

void RoughMap::add(std::vector<Eigen::Vector3d> points_R, const Pose& X_MR, std::size_t keep) {
  for (Eigen::Vector3d& p : points_R) p = X_MR * p;
  keyframes_.push_back(std::move(points_R));
  if (keyframes_.size() > keep) keyframes_.pop_front();
  std::vector<Eigen::Vector3d> all_M;
  for (const std::vector<Eigen::Vector3d>& points_M : keyframes_)
    all_M.insert(all_M.end(), points_M.begin(), points_M.end());
  tree_ = std::make_shared<const KdTree>(std::move(all_M));
}

std::vector<RoughMatch> RoughMap::match(std::span<const Eigen::Vector3d> points_R, const Pose& X_MR,
                                        double reach_m) const {
  std::vector<RoughMatch> matches;
  if (empty()) return matches;
  for (const Eigen::Vector3d& p_R : points_R) {
    const Neighbour nearest = tree_->nearest(X_MR * p_R, 1).front();
    if (nearest.distance2 <= reach_m * reach_m) matches.push_back({p_R, tree_->points()[nearest.index]});
  }
  return matches;
}

Normal6 linearize(std::span<const RoughMatch> matches, const Pose& X_MR, double sigma_m) {
  const Eigen::Matrix3d R_MR = X_MR.rotation();
  const double variance = sigma_m * sigma_m;
  Normal6 sum;
  for (const RoughMatch& match : matches) {
    const Eigen::Vector3d arm_M = R_MR * match.p_R;
    const Eigen::Vector3d e = arm_M + X_MR.t - match.p_M;
    const double weight = 1.0 / (variance + e.squaredNorm());
    add_point(sum, arm_M, weight * Eigen::Matrix3d::Identity(), weight * e);
  }
  to_right_increment(sum, R_MR);
  return sum;
}

}  // namespace plumbline::slam
