// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/ndt.h"

#include <algorithm>
#include <cmath>

#include "bim/geometry/symmetric.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

constexpr double min_points = 6.0;             // of a voxel with a Gaussian
constexpr double min_eigenvalue_ratio = 0.01;  // of a covariance, as of NDT's implementations

bool in_hole(const PlanSegment& segment, double s, double z) {
  return std::any_of(segment.holes.begin(), segment.holes.end(), [&](const bim::FaceHole& hole) {
    return s > hole.s0 && s < hole.s1 && z > hole.z0 && z < hole.z1;
  });
}

Eigen::Matrix3d information_of(const Eigen::Matrix3d& covariance) {
  const SymmetricEigen<3> eigen = symmetric_eigen(covariance);
  const Eigen::Vector3d widened = eigen.values.cwiseMax(std::max(min_eigenvalue_ratio * eigen.values.maxCoeff(), 1e-8));
  return eigen.vectors * widened.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

NdtMap::NdtMap(const StoreyIndex& storey, const NdtConfig& config) : config_(config), size_(config.resolution_m) {
  lay_out(storey);
  std::vector<Sums> sums(index_.size());
  add_faces(storey, sums);
  add_rooms(storey, sums);
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const Sums& s = sums[v];
    if (s.n < min_points) continue;
    const Eigen::Vector3d mean = s.p / s.n;
    index_[v] = static_cast<int>(gaussians_.size());
    gaussians_.push_back({mean, information_of((s.pp - s.n * mean * mean.transpose()) / (s.n - 1.0))});
  }
  const double c1 = 10.0 * (1.0 - config.outlier_ratio), c2 = config.outlier_ratio / (size_ * size_ * size_);
  const double d3 = -std::log(c2), d1 = -std::log(c1 + c2) - d3;
  d1_ = -d1;
  d2_ = -2.0 * std::log((-std::log(c1 * std::exp(-0.5) + c2) - d3) / d1);
}

void NdtMap::lay_out(const StoreyIndex& storey) {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = low;
  if (!storey.segments.empty()) low = high = storey.segments.front().a;
  const auto take = [&](const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const PlanSegment& segment : storey.segments) {
    take(segment.a);
    take(segment.a + segment.length * segment.e);
  }
  for (const LocalRoom& room : storey.rooms)
    for (const Eigen::Vector2d& p : room.polygon) take(p);
  const Eigen::Vector3d extent(high.x() - low.x(), high.y() - low.y(), storey.ceiling_z - storey.floor_z);
  const auto cells = [&] { return (extent / size_).array().ceil() + 2.0; };
  while (cells().prod() > config_.max_voxels) size_ *= 2.0;
  count_ = cells().cast<int>();
  // Half a voxel off, so that floor and outer walls lie inside of voxels, not on their faces.
  origin_ = Eigen::Vector3d(low.x(), low.y(), storey.floor_z).array() - 0.5 * size_;
  index_.assign(static_cast<std::size_t>(count_.cast<long>().prod()), -1);
}

long NdtMap::voxel_at(const Eigen::Vector3d& p_I) const {
  const Eigen::Array3d cell = ((p_I - origin_) / size_).array().floor();
  if (!(cell >= 0.0).all() || !(cell < count_.cast<double>().array()).all()) return -1;
  return (static_cast<long>(cell.z()) * count_.y() + static_cast<long>(cell.y())) * count_.x() +
         static_cast<long>(cell.x());
}

void NdtMap::add(const Eigen::Vector3d& p_I, std::vector<Sums>& sums) const {
  const long v = voxel_at(p_I);
  if (v < 0) return;
  Sums& s = sums[static_cast<std::size_t>(v)];
  s.n += 1.0;
  s.p += p_I;
  s.pp += p_I * p_I.transpose();
}

void NdtMap::add_faces(const StoreyIndex& storey, std::vector<Sums>& sums) const {
  const double step = config_.sample_m;
  for (const PlanSegment& segment : storey.segments) {
    const double z1 = std::min(segment.z1, storey.ceiling_z);
    for (double s = 0.5 * step; s < segment.length; s += step)
      for (double z = std::max(segment.z0, storey.floor_z) + 0.5 * step; z < z1; z += step) {
        if (in_hole(segment, s, z)) continue;
        const Eigen::Vector2d p = segment.a + s * segment.e;
        add({p.x(), p.y(), z}, sums);
      }
  }
}

void NdtMap::add_rooms(const StoreyIndex& storey, std::vector<Sums>& sums) const {
  const double step = 2.0 * config_.sample_m;
  for (const LocalRoom& room : storey.rooms) {
    Eigen::Vector2d low = room.polygon.front(), high = low;
    for (const Eigen::Vector2d& p : room.polygon) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (double y = low.y() + 0.5 * step; y < high.y(); y += step)
      for (double x = low.x() + 0.5 * step; x < high.x(); x += step) {
        if (!contains(room.polygon, {x, y})) continue;
        add({x, y, storey.floor_z}, sums);
        add({x, y, storey.ceiling_z}, sums);
      }
  }
}

template <class F>
void NdtMap::for_neighbours(const Eigen::Vector3d& p_I, const F& f) const {
  static const Eigen::Vector3d steps[] = {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0},
                                          {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (const Eigen::Vector3d& step : steps) {
    const long v = voxel_at(p_I + size_ * step);
    const int g = v < 0 ? -1 : index_[static_cast<std::size_t>(v)];
    if (g >= 0) f(gaussians_[static_cast<std::size_t>(g)]);
  }
}

NdtScore NdtMap::score(std::span<const Eigen::Vector3d> points_R, const Pose& X_IR) const {
  NdtScore sum;
  const Eigen::Matrix3d R = X_IR.rotation();
  for (const Eigen::Vector3d& p_R : points_R) {
    const Eigen::Vector3d p_I = R * p_R + X_IR.t;
    Eigen::Matrix<double, 3, 6> J;
    J << R, -R * hat(p_R);
    for_neighbours(p_I, [&](const Gaussian& gaussian) {
      const Eigen::Vector3d e = p_I - gaussian.mean, Be = gaussian.information * e;
      const double weight = d1_ * std::exp(-0.5 * d2_ * e.dot(Be));
      sum.value -= weight;
      if (weight < 1e-9 * d1_) return;
      const Eigen::Matrix<double, 6, 3> Jt = d2_ * weight * J.transpose();
      sum.gradient += Jt * Be;
      sum.hessian += Jt * gaussian.information * J;
    });
  }
  return sum;
}

double NdtMap::inliers(std::span<const Eigen::Vector3d> points_R, const Pose& X_IR) const {
  int near = 0;
  for (const Eigen::Vector3d& p_R : points_R) {
    const Eigen::Vector3d p_I = X_IR * p_R;
    double least = config_.inlier_sigmas * config_.inlier_sigmas;
    bool found = false;
    for_neighbours(p_I, [&](const Gaussian& gaussian) {
      const Eigen::Vector3d e = p_I - gaussian.mean;
      found = found || e.dot(gaussian.information * e) <= least;
    });
    near += found ? 1 : 0;
  }
  return points_R.empty() ? 0.0 : near / static_cast<double>(points_R.size());
}

NdtMatch NdtMap::align(std::span<const Eigen::Vector3d> points_R, const Pose& start) const {
  NdtMatch match{start, 0.0};
  if (points_R.empty()) return match;
  NdtScore now = score(points_R, match.X_IR);
  double damping = 1e-3;
  for (int i = 0; i < config_.max_iterations; ++i) {
    Matrix6d H = now.hessian;
    H.diagonal() *= 1.0 + damping;
    H.diagonal().array() += 1e-6;
    const Vector6d step = -solve_ldlt(H, now.gradient);
    if (!step.allFinite()) break;
    const Pose next = match.X_IR * exp_se3(step);
    const NdtScore there = score(points_R, next);
    if (there.value > now.value) {
      damping = std::max(10.0 * damping, 1e-2);
      if (damping > 1e4) break;
      continue;
    }
    match.X_IR = next;
    match.X_IR.q.normalize();
    now = there;
    damping = std::max(0.1 * damping, 1e-6);
    if (step.cwiseAbs().maxCoeff() < config_.epsilon) break;
  }
  match.inliers = inliers(points_R, match.X_IR);
  return match;
}

std::vector<Eigen::Vector3d> ndt_points(const DeskewedScan& scan, const NdtConfig& config) {
  return voxel_downsample(points_between(scan, config.min_range_m, config.max_range_m), config.scan_voxel_m);
}

}  // namespace plumbline::slam
