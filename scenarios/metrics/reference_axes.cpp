// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/reference_axes.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace plumbline::scenarios::score {

namespace {

/// Sum of b r^T over directions of motion and axes of turning, seen from R (r) and from B (b).
Eigen::Matrix3d correlation_of(const std::vector<PosePair>& pairs, double reach_m) {
  constexpr double least_turn_rad = 0.1;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const auto add = [&](const Eigen::Vector3d& r, const Eigen::Vector3d& b, double least) {
    if (r.norm() >= least && b.norm() >= least) sum += b.normalized() * r.normalized().transpose();
  };
  std::size_t end = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (end < pairs.size() && (pairs[end].X_WR.t - pairs[i].X_WR.t).norm() < reach_m) ++end;
    if (end == pairs.size()) break;
    const Pose of_robot = pairs[i].X_FR.inverse() * pairs[end].X_FR;
    const Pose of_body = pairs[i].X_WR.inverse() * pairs[end].X_WR;
    add(of_robot.t, of_body.t, 0.5 * reach_m);
    add(log_so3(of_robot.q), log_so3(of_body.q), least_turn_rad);
  }
  return sum;
}

}  // namespace

std::optional<TurnedReference> turned_to_robot(const std::vector<slam::StampedPose>& reference_W,
                                               const std::vector<slam::StampedPose>& poses_F, const AxesRules& rules) {
  const auto as_read = score_by_reference(reference_W, poses_F);
  if (!as_read || !as_read->rpe_1m_rmse_m || *as_read->rpe_1m_rmse_m < rules.least_error_m) return std::nullopt;
  const Eigen::Matrix3d sum = correlation_of(match_reference(reference_W, poses_F), rules.reach_m);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign(2, 2) = -1.0;
  const Eigen::Matrix3d R_BR = svd.matrixU() * sign * svd.matrixV().transpose();
  const Eigen::Quaterniond q_BR = Eigen::Quaterniond(R_BR).normalized();

  TurnedReference turned{reference_W, log_so3(q_BR).norm()};
  for (slam::StampedPose& pose : turned.reference_W) pose.X_FR.q = (pose.X_FR.q * q_BR).normalized();
  const auto after = score_by_reference(turned.reference_W, poses_F);
  if (!after || !after->rpe_1m_rmse_m || *after->rpe_1m_rmse_m > rules.most_of_as_read * *as_read->rpe_1m_rmse_m)
    return std::nullopt;
  return turned;
}

bool is_without_orientation(const std::vector<slam::StampedPose>& reference_W,
                            const std::vector<slam::StampedPose>& poses_F) {
  constexpr double same_rad = 1e-9, turns_rad = 30.0 * std::numbers::pi / 180.0;
  const auto most_turned = [](const std::vector<slam::StampedPose>& poses) {
    double most = 0.0;
    for (const slam::StampedPose& pose : poses)
      most = std::max(most, poses.front().X_FR.q.angularDistance(pose.X_FR.q));
    return most;
  };
  return most_turned(reference_W) <= same_rad && most_turned(poses_F) >= turns_rad;
}

}  // namespace plumbline::scenarios::score
