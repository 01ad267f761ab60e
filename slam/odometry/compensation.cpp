// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/compensation.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "bim/geometry/pose.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t fewest = 200;
constexpr double nearest_m = 1.0;    ///< nearer, where a laser sits in the sensor matters
constexpr double uneven_rad = 0.25;  ///< of azimuths about a line; lasers of one firing may point degrees apart
constexpr double least_way_m = 0.03;
constexpr double known = 0.15;  ///< standard deviation of the coefficient from which it decides

/// Axis about which the head turns: a ring's returns lie on a cone about it. z, unless the cloud's frame is plainly
/// tilted against the head, as where the driver turned the cloud into the robot's axes.
Eigen::Vector3d axis_of(const Scan& scan) {
  constexpr double least_tilt_rad = 0.03;
  constexpr double most_width = 0.01;  // variance along the axis over that across
  const auto rings = static_cast<std::size_t>(scan.rings);
  if (rings < 2) return Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t ring = 0; ring < rings; ++ring) {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (std::size_t i = ring; i < scan.size(); i += rings) {
      if (scan.range_m[i] < nearest_m || !scan.point_L[i].allFinite() || scan.point_L[i].isZero(0.0)) continue;
      const Eigen::Vector3d u = scan.point_L[i].normalized();
      squares += u * u.transpose();
      sum += u;
      count += 1.0;
    }
    if (count > 0.0) scatter += squares - sum * sum.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Eigen::Vector3d axis = solver.eigenvectors().col(0) * (solver.eigenvectors()(2, 0) < 0.0 ? -1.0 : 1.0);
  const bool clear = solver.eigenvalues()(0) < most_width * solver.eigenvalues()(1);
  return clear && axis.head<2>().norm() > least_tilt_rad ? axis : Eigen::Vector3d::UnitZ();
}

struct Ray {
  double time_s = 0.0;
  double azimuth = 0.0;
  double across = 0.0;  ///< change of azimuth for a second of the velocity
};

std::vector<Ray> rays_of(const Scan& scan, const Eigen::Vector3d& velocity_L) {
  const Eigen::Quaterniond upright = Eigen::Quaterniond::FromTwoVectors(axis_of(scan), Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d velocity = upright * velocity_L;
  constexpr std::size_t most = 8000;
  const std::size_t stride = std::max<std::size_t>(1, scan.size() / most);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < scan.size(); i += stride) {
    const Eigen::Vector3d p = upright * scan.point_L[i];
    const double range2 = p.head<2>().squaredNorm();
    if (scan.range_m[i] <= 0.0 || !p.allFinite() || range2 < nearest_m * nearest_m) continue;
    rays.push_back(
        {seconds(scan.offset_ns[i]), std::atan2(p.y(), p.x()), (p.x() * velocity.y() - p.y() * velocity.x()) / range2});
  }
  std::stable_sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) { return a.time_s < b.time_s; });
  for (std::size_t k = 1; k < rays.size(); ++k)
    rays[k].azimuth = rays[k - 1].azimuth + wrap_angle(rays[k].azimuth - rays[k - 1].azimuth);
  return rays;
}

}  // namespace

void CompensationTest::add(const Scan& scan, const Eigen::Vector3d& velocity_L) {
  const std::vector<Ray> rays = rays_of(scan, velocity_L);
  if (rays.size() < fewest) return;
  const double sweep_s = rays.back().time_s - rays.front().time_s;
  if (!(velocity_L.norm() * sweep_s >= least_way_m)) return;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  double squared = 0.0;
  const auto row = [&](const Ray& ray) {
    const double t = ray.time_s / sweep_s;
    return Eigen::Vector4d(1.0, t, ray.across * sweep_s, ray.across * ray.time_s);
  };
  for (const Ray& ray : rays) {
    A += row(ray) * row(ray).transpose();
    b += row(ray) * ray.azimuth;
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(A);
  const Eigen::Vector4d x = solver.solve(b);
  for (const Ray& ray : rays) squared += std::pow(ray.azimuth - row(ray).dot(x), 2);
  const double variance = squared / static_cast<double>(rays.size());
  const Eigen::Vector4d column = solver.solve(Eigen::Vector4d::UnitW());
  if (!x.allFinite() || !(column.w() > 0.0) || variance > uneven_rad * uneven_rad) return;
  const double information = 1.0 / (variance * column.w());
  coefficient_ = (coefficient_ * information_ + x.w() * information) / (information_ + information);
  information_ += information;
}

bool CompensationTest::compensated() const { return information_ * known * known > 1.0 && coefficient_ > 0.5; }

// Twice as sure: what decides is then 7 standard deviations from what raw clouds give.
bool CompensationTest::is_settled() const { return information_ * known * known > 4.0; }

}  // namespace plumbline::slam
