// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/geometry/plane.h"

namespace plumbline::slam {

/// Sums of points, enough to fit planes to them and to pool them.
struct Moments {
  double n = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();  ///< sum of p p^T

  void add(const Eigen::Vector3d& p, double weight = 1.0) {
    n += weight;
    sum += weight * p;
    outer += weight * p * p.transpose();
  }
  void add(const Moments& other) {
    n += other.n;
    sum += other.sum;
    outer += other.outer;
  }
  [[nodiscard]] Eigen::Vector3d mean() const { return sum / n; }
  [[nodiscard]] Eigen::Matrix3d covariance() const {
    const Eigen::Vector3d m = mean();
    return outer / n - m * m.transpose();
  }
  /// Of the same points, each moved.
  [[nodiscard]] Moments moved(const Eigen::Vector3d& by) const {
    const Eigen::Matrix3d mixed = sum * by.transpose();
    return {n, sum + n * by, outer + mixed + mixed.transpose() + n * by * by.transpose()};
  }
  /// The same along one axis, to the last bit.
  [[nodiscard]] Moments moved_along(int axis, double by) const {
    Moments m = *this;
    for (int i = 0; i < 3; ++i) {
      m.outer(i, axis) += sum(i) * by;
      m.outer(axis, i) += sum(i) * by;
    }
    m.outer(axis, axis) += n * by * by;
    m.sum(axis) += n * by;
    return m;
  }
};

/// Moments while points are added, in scalars that stay in registers; to the last bit what Moments::add gives.
class MomentSums {
 public:
  void add(const Eigen::Vector3d& p, double weight = 1.0) {
    const double x = weight * p.x(), y = weight * p.y(), z = weight * p.z();
    n_ += weight;
    x_ += x;
    y_ += y;
    z_ += z;
    xx_ += x * p.x();
    xy_ += x * p.y();
    xz_ += x * p.z();
    yx_ += y * p.x();
    yy_ += y * p.y();
    yz_ += y * p.z();
    zx_ += z * p.x();
    zy_ += z * p.y();
    zz_ += z * p.z();
  }
  [[nodiscard]] Moments moments() const {
    Moments m;
    m.n = n_;
    m.sum = {x_, y_, z_};
    m.outer << xx_, xy_, xz_, yx_, yy_, yz_, zx_, zy_, zz_;
    return m;
  }

 private:
  double n_ = 0.0, x_ = 0.0, y_ = 0.0, z_ = 0.0;
  double xx_ = 0.0, xy_ = 0.0, xz_ = 0.0, yx_ = 0.0, yy_ = 0.0, yz_ = 0.0, zx_ = 0.0, zy_ = 0.0, zz_ = 0.0;
};

/// Sum over the points of (J^T J) with J the derivative of n.p + d by (angle towards u, angle towards v, d).
[[nodiscard]] Eigen::Matrix3d plane_normal_matrix(const Moments& moments, const Plane& plane);

/// One Gauss-Newton step of the least-squares plane, from `plane`. tilt_weight (in points times m^2) pulls the normal
/// towards the horizontal; 0 for none. The sums must span a plane, or tilt_weight be positive.
[[nodiscard]] Plane refine_plane(const Moments& moments, const Plane& plane, double tilt_weight);

/// rms distance of the points to the plane, m.
[[nodiscard]] double plane_rms(const Moments& moments, const Plane& plane);

/// Covariance of (angle towards u, angle towards v, d) from independent noise sigma, m, plus a systematic part that no
/// number of points averages away: standard deviations of the two angles, rad, and of the offset at the centroid, m.
[[nodiscard]] Eigen::Matrix3d plane_covariance(const Moments& moments, const Plane& plane, double sigma,
                                               const Eigen::Vector3d& bias);

}  // namespace plumbline::slam
