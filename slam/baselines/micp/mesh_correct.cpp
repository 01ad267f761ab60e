// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/micp/mesh_correct.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/geometry/best_rotation.h"
#include "bim/geometry/symmetric.h"
#include "slam/plan_map/plan_mesh.h"

namespace plumbline::slam {

namespace {

// A beam this much longer than the range cast has no face of the plan to match anyway.
constexpr double reach_beyond_m = 5.0;
constexpr int least_pairs = 12;  // that fix a pose

struct Pairs {
  std::vector<Eigen::Vector3d> p, q, n;  ///< points, their feet on the faces, normals
};

/// Motion that brings p to q in least squares, rotation and translation [umeyama1991].
Pose umeyama(const Pairs& pairs) {
  const double count = static_cast<double>(pairs.p.size());
  Eigen::Vector3d mean_p = Eigen::Vector3d::Zero(), mean_q = mean_p;
  for (std::size_t i = 0; i < pairs.p.size(); ++i) {
    mean_p += pairs.p[i] / count;
    mean_q += pairs.q[i] / count;
  }
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.p.size(); ++i) C += (pairs.q[i] - mean_q) * (pairs.p[i] - mean_p).transpose();
  const Eigen::Matrix3d R = best_rotation(C);
  return {Eigen::Quaterniond(R).normalized(), mean_q - R * mean_p};
}

/// One Gauss-Newton step on n.(p - q), as a motion about a center.
Pose gauss_newton(const Pairs& pairs, const Eigen::Vector3d& center) {
  Matrix6d H = 1e-6 * Matrix6d::Identity();
  Vector6d b = Vector6d::Zero();
  for (std::size_t i = 0; i < pairs.p.size(); ++i) {
    Vector6d J;
    J << pairs.n[i], (pairs.p[i] - center).cross(pairs.n[i]);
    H += J * J.transpose();
    b -= J * pairs.n[i].dot(pairs.p[i] - pairs.q[i]);
  }
  const Vector6d step = solve_ldlt(H, b);
  const Pose turn{exp_so3(step.tail<3>()), Eigen::Vector3d::Zero()};
  const Pose to_center{Eigen::Quaterniond::Identity(), center};
  const Pose shift{Eigen::Quaterniond::Identity(), step.head<3>()};
  return shift * to_center * turn * to_center.inverse();
}

}  // namespace

MeshBeams pick_beams(const DeskewedScan& scan, const MeshCorrectConfig& config) {
  MeshBeams beams;
  beams.sensor_R = scan.X_RL.t;
  if (scan.columns == 0) return beams;
  const int columns = std::clamp(config.rays / std::max(scan.rings, 1), 1, scan.columns);
  for (int ring = 0; ring < scan.rings; ++ring)
    for (int k = 0; k < columns; ++k) {
      const long column = static_cast<long>(k) * scan.columns / columns;
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (scan.range_m[i] < config.min_range_m || scan.range_m[i] > config.max_range_m) continue;
      if ((scan.point_R[i] - beams.sensor_R).norm() > 0.1) beams.ends_R.push_back(scan.point_R[i]);
    }
  return beams;
}

MeshCorrector::MeshCorrector(const StoreyIndex& storey, const MeshCorrectConfig& config)
    : config_(config), scene_(plan_mesh(storey)) {}

void MeshCorrector::cast(const MeshBeams& beams, const Pose& X_IR, std::vector<Correspondence>& correspondences) const {
  const Eigen::Vector3d origin = X_IR * beams.sensor_R;
  std::vector<bim::Ray> rays;
  rays.reserve(beams.ends_R.size());
  correspondences.resize(beams.ends_R.size());
  for (std::size_t i = 0; i < beams.ends_R.size(); ++i) {
    correspondences[i].p_I = X_IR * beams.ends_R[i];
    rays.push_back({origin, (correspondences[i].p_I - origin).normalized()});
  }
  std::vector<bim::Hit> hits(rays.size());
  scene_.cast(rays, config_.max_range_m + reach_beyond_m, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    correspondences[i].hit = hits[i].element >= 0;
    if (!correspondences[i].hit) continue;
    correspondences[i].m_I = origin + hits[i].range_m * rays[i].direction_W;
    correspondences[i].n_I = hits[i].normal_W;
  }
}

Pose MeshCorrector::fit(const MeshBeams& beams, const std::vector<Correspondence>& correspondences, Pose X_IR,
                        double distance) const {
  for (int step = 0; step < config_.inner_steps; ++step) {
    Pairs pairs;
    for (std::size_t i = 0; i < correspondences.size(); ++i) {
      if (!correspondences[i].hit) continue;
      const Eigen::Vector3d p = X_IR * beams.ends_R[i];
      const double across = correspondences[i].n_I.dot(p - correspondences[i].m_I);
      if (std::abs(across) > distance) continue;
      pairs.p.push_back(p);
      pairs.q.push_back(p - across * correspondences[i].n_I);
      pairs.n.push_back(correspondences[i].n_I);
    }
    if (static_cast<int>(pairs.p.size()) < least_pairs) return X_IR;
    const Pose motion = config_.solver == MeshSolver::umeyama ? umeyama(pairs) : gauss_newton(pairs, X_IR.t);
    if (!motion.t.allFinite() || !motion.q.coeffs().allFinite()) return X_IR;
    X_IR = motion * X_IR;
    X_IR.q.normalize();
  }
  return X_IR;
}

void MeshCorrector::evaluate(const std::vector<Correspondence>& correspondences, MeshCorrection& correction) const {
  if (correspondences.empty()) return;
  double near = 0.0, cost = 0.0;
  for (const Correspondence& correspondence : correspondences) {
    const double across =
        correspondence.hit ? std::abs(correspondence.n_I.dot(correspondence.p_I - correspondence.m_I)) : 1e9;
    const double e = std::min(across / config_.sigma_m, config_.cap);
    near += across <= config_.inlier_m ? 1.0 : 0.0;
    cost += 0.5 * e * e;
  }
  correction.inliers = near / static_cast<double>(correspondences.size());
  correction.cost = cost / static_cast<double>(correspondences.size());
}

MeshCorrection MeshCorrector::correct(const MeshBeams& beams, const Pose& start, int casts, double distance_m) const {
  MeshCorrection correction{start, 0.0, 0.5 * config_.cap * config_.cap};
  std::vector<Correspondence> correspondences;
  double distance = distance_m;
  for (int k = 0; k < casts; ++k) {
    cast(beams, correction.X_IR, correspondences);
    correction.X_IR = fit(beams, correspondences, correction.X_IR, distance);
    distance = std::max(config_.shrink * distance, config_.min_distance_m);
  }
  cast(beams, correction.X_IR, correspondences);
  evaluate(correspondences, correction);
  return correction;
}

std::vector<float> MeshCorrector::range_profile(const Eigen::Vector3d& p_I, int count) const {
  std::vector<bim::Ray> rays;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / count;
    rays.push_back({p_I, {std::cos(angle), std::sin(angle), 0.0}});
  }
  std::vector<bim::Hit> hits(rays.size());
  scene_.cast(rays, config_.max_range_m, hits);
  std::vector<float> ranges;
  for (const bim::Hit& hit : hits)
    ranges.push_back(static_cast<float>(hit.element >= 0 ? hit.range_m : config_.max_range_m));
  return ranges;
}

}  // namespace plumbline::slam
