// SPDX-License-Identifier: Apache-2.0
#include "slam/io/pose_check.h"

#include <cmath>

#include "bim/config/tree.h"

namespace plumbline::slam {

namespace {

constexpr double farthest_m = 1e8;
constexpr double norm_tolerance = 0.01;

bool near_enough(const Eigen::Vector3d& t) { return (t.array().abs() <= farthest_m).all(); }

}  // namespace

bool plausible(const Pose& X) { return near_enough(X.t) && std::abs(X.q.norm() - 1.0) <= norm_tolerance; }

Pose checked_pose(const Eigen::Vector3d& t, const Eigen::Quaterniond& q, const Mark& mark) {
  if (!near_enough(t)) throw InputError(mark, "a position's coordinates must be finite and at most 100,000 km");
  const double norm = q.norm();
  if (!std::isfinite(norm)) throw InputError(mark, "the quaternion's norm is not finite; it must be 1");
  if (std::abs(norm - 1.0) > norm_tolerance)
    throw InputError(mark, "the quaternion's norm is " + format_number(norm) + ", not 1");
  Pose X;
  X.t = t;
  X.q = q;
  if (std::abs(norm - 1.0) > 1e-9) X.q.normalize();
  return X;
}

}  // namespace plumbline::slam
