// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/match.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace plumbline::slam::loam {

namespace {

constexpr double least_spread_m = 1e-3;  // points nearer to each other than this have no direction
constexpr double least_sine = 0.05;      // of a plane's two directions

Eigen::Vector3d mean_of(const PointMap::Neighbours& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scatter_of(const PointMap::Neighbours& points,
                                                          const Eigen::Vector3d& mean) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  return eigen;
}

Eigen::Matrix3d across_line(const Eigen::Vector3d& along) {
  return Eigen::Matrix3d::Identity() - along * along.transpose();
}

}  // namespace

std::optional<Match> line_match(const Eigen::Vector3d& p_R, const Eigen::Vector3d& a_F, const Eigen::Vector3d& b_F) {
  const Eigen::Vector3d way = b_F - a_F;
  const double length = way.norm();
  if (length < least_spread_m) return std::nullopt;
  const Eigen::Vector3d along = way / length;
  return Match{p_R, a_F, across_line(along)};
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

std::optional<Match> line_match(const Eigen::Vector3d& p_R, const PointMap::Neighbours& points_F, double line_ratio) {
  const Eigen::Vector3d mean = mean_of(points_F);
  const auto eigen = scatter_of(points_F, mean);
  if (!(eigen.eigenvalues()(2) > line_ratio * eigen.eigenvalues()(1))) return std::nullopt;
  return Match{p_R, mean, across_line(eigen.eigenvectors().col(2))};
}

std::optional<Match> plane_match(const Eigen::Vector3d& p_R, const PointMap::Neighbours& points_F, double plane_ratio,
                                 double tolerance_m) {
  const Eigen::Vector3d mean = mean_of(points_F);
  const auto eigen = scatter_of(points_F, mean);
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  for (const Eigen::Vector3d& p : points_F)
    if (!(std::abs(normal.dot(p - mean)) <= tolerance_m)) return std::nullopt;
  if (!(eigen.eigenvalues()(1) > plane_ratio * eigen.eigenvalues()(0))) return std::nullopt;
  return Match{p_R, mean, normal * normal.transpose()};
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
