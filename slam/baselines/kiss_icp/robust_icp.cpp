// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/robust_icp.h"

#include <cmath>
#include <numbers>

#include "bim/geometry/symmetric.h"

namespace plumbline::slam::kiss {

namespace {

/// Weighted normal equations of a left increment (rho, phi) about a pivot: residual r = p - q, Jacobian [1, -[a]x] with
/// a the point seen from the pivot.
struct PointToPoint {
  double w = 0.0;
  std::size_t matched = 0;
  Eigen::Vector3d wa = Eigen::Vector3d::Zero();
  Eigen::Matrix3d waa = Eigen::Matrix3d::Zero();
  Eigen::Vector3d wr = Eigen::Vector3d::Zero();
  Eigen::Vector3d wm = Eigen::Vector3d::Zero();  ///< of a x r
  double r2 = 0.0;

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& r, double weight) {
    const Eigen::Vector3d weighted = weight * a;
    w += weight;
    wa += weighted;
    waa += weighted * a.transpose();
    wr += weight * r;
    wm += weighted.cross(r);
    r2 += r.squaredNorm();
    ++matched;
  }

  [[nodiscard]] Vector6d step() const {
    Matrix6d h;
    h.topLeftCorner<3, 3>() = w * Eigen::Matrix3d::Identity();
    h.bottomLeftCorner<3, 3>() = hat(wa);
    h.topRightCorner<3, 3>() = -hat(wa);
    h.bottomRightCorner<3, 3>() = waa.trace() * Eigen::Matrix3d::Identity() - waa;
    Vector6d g;
    g << wr, wm;
    return -solve_ldlt(h, g);
  }
};

/// Two points leave a rotation free.
constexpr std::size_t fewest_matches = 3;

bool is_motion(const Vector6d& step) { return step.allFinite() && step.tail<3>().norm() < std::numbers::pi; }

}  // namespace

RobustIcpResult register_points(std::span<const Eigen::Vector3d> points_L, const VoxelHashMap& map, const Pose& guess,
                                const RobustIcpOptions& options) {
  RobustIcpResult result;
  result.X_ML = guess;
  if (map.empty()) return result;
  const double max_distance2 = options.max_distance_m * options.max_distance_m;
  const Eigen::Vector3d pivot_M = guess.t;
  while (result.iterations < options.max_iterations) {
    const Eigen::Matrix3d R_ML = result.X_ML.rotation();
    PointToPoint sum;
    for (const Eigen::Vector3d& p_L : points_L) {
      const Eigen::Vector3d p_M = R_ML * p_L + result.X_ML.t;
      const Eigen::Vector3d* q_M = map.nearest(p_M, max_distance2);
      if (q_M == nullptr) continue;
      const Eigen::Vector3d r = p_M - *q_M;
      sum.add(p_M - pivot_M, r, geman_mcclure(r.squaredNorm(), options.kernel_m));
    }
    ++result.iterations;
    result.matched = sum.matched;
    if (sum.matched < fewest_matches) break;
    result.matched_rms = std::sqrt(sum.r2 / static_cast<double>(sum.matched));
    const Vector6d step = sum.step();
    if (!is_motion(step)) break;
    const Pose increment = exp_se3(step);
    result.X_ML = {(increment.q * result.X_ML.q).normalized(),
                   increment.q * (result.X_ML.t - pivot_M) + increment.t + pivot_M};
    if (step.norm() < options.convergence) break;
  }
  return result;
}

}  // namespace plumbline::slam::kiss
