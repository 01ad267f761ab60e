// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/range_bias.h"

#include "bim/geometry/symmetric.h"
#include "slam/localization/tracker_factors.h"

namespace plumbline::slam {

void RangeBias::add(const TrackedPose& pose, const StoreyIndex& storey, double share, const TrackerConfig& config) {
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  Eigen::Matrix<double, 7, 7> H = Eigen::Matrix<double, 7, 7>::Zero();
  Vector7d b = Vector7d::Zero();
  for (const WallLink& link : pose.walls) {
    const PlaneResidual residual = wall_residual(pose, link, storey, 0.0);
    const double sigma = wall_sigmas(link, config)[2];
    Vector7d J;
    J << residual.J_pose.row(2).transpose(), bias_share(link.observed);
    H += link.weight / (sigma * sigma) * J * J.transpose();
    b -= link.weight / (sigma * sigma) * residual.e[2] * J;
  }
  // Whatever else holds the pose is left out, so that the bias of before does not come back as news.
  constexpr double pose_sigma_m = 0.5;
  H.topLeftCorner<6, 6>() += Matrix6d::Identity() / (pose_sigma_m * pose_sigma_m);
  const Vector6d H_pb = H.topRightCorner<6, 1>();
  const Vector6d to_pose = solve_ldlt(Matrix6d(H.topLeftCorner<6, 6>()), H_pb);
  const double information = share * (H(6, 6) - to_pose.dot(H_pb));
  if (information <= 0.0) return;
  const double measured = share * (b[6] - to_pose.dot(b.head<6>())) / information;
  const double joined = 1.0 / (1.0 / variance_ + information);
  mean_ += joined * information * (measured - mean_);
  variance_ = joined;
}

}  // namespace plumbline::slam
