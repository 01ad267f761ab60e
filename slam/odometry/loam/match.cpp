// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/loam/match.h"

#include <Eigen/Geometry>

namespace plumbline::slam::loam {

namespace {

constexpr double least_spread_m = 1e-3;  // points nearer to each other than this have no direction
constexpr double least_sine = 0.05;      // of a plane's two directions

}  // namespace

std::optional<Match> line_match(const Eigen::Vector3d& p_R, const Eigen::Vector3d& a_F, const Eigen::Vector3d& b_F) {
  const Eigen::Vector3d way = b_F - a_F;
  const double length = way.norm();
  if (length < least_spread_m) return std::nullopt;
  const Eigen::Vector3d along = way / length;
  return Match{p_R, a_F, Eigen::Matrix3d::Identity() - along * along.transpose()};
}

std::optional<Match> plane_match(const Eigen::Vector3d& p_R, const Eigen::Vector3d& a_F, const Eigen::Vector3d& b_F,
                                 const Eigen::Vector3d& c_F) {
  const Eigen::Vector3d ab = b_F - a_F;
  const Eigen::Vector3d ac = c_F - a_F;
  const Eigen::Vector3d normal = ab.cross(ac);
  const double area = normal.norm();
  if (ab.norm() < least_spread_m || ac.norm() < least_spread_m || area < least_sine * ab.norm() * ac.norm())
    return std::nullopt;
  return Match{p_R, a_F, normal * normal.transpose() / (area * area)};
}

Normal6 linearize(std::span<const Match> matches, const Pose& X_FR, double huber_m) {
  const Eigen::Matrix3d R_FR = X_FR.rotation();
  Normal6 sum;
  for (const Match& match : matches) {
    const Eigen::Vector3d arm_F = R_FR * match.p_R;
    const Eigen::Vector3d e = match.across * (arm_F + X_FR.t - match.anchor_F);
    const double distance = e.norm();
    const double w = distance <= huber_m ? 1.0 : huber_m / distance;
    add_point(sum, arm_F, w * match.across, w * e);
    sum.cost += distance <= huber_m ? 0.5 * distance * distance : huber_m * (distance - 0.5 * huber_m);
    if (distance > 2.0 * huber_m) continue;
    sum.inliers += 1.0;
    sum.squared += distance * distance;
  }
  to_right_increment(sum, R_FR);
  return sum;
}

}  // namespace plumbline::slam::loam
