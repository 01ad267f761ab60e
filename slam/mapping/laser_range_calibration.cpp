// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/laser_range_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bim/geometry/symmetric.h"
#include "slam/mapping/wall_faces.h"

namespace plumbline::slam {

namespace {

/// A return near a wall.
struct Hit {
  std::uint32_t face = 0;
  std::uint8_t laser = 0;
  float e_m = 0.0F;     ///< its distance from the face
  float cosine = 0.0F;  ///< between the ray and the face's normal: -1 head on
};

std::vector<Hit> hits_of(std::span<const CloudKeyframe> clouds, std::span<const WallFace> faces,
                         const Eigen::Vector3d& sensor_R, const LaserRangeCalibrationConfig& config) {
  constexpr double edge_m = 0.15;  // at a wall's end a return may come from the adjoining surface
  const FacesNear near(faces, config.gate_m);
  std::vector<Hit> hits;
  Eigen::Vector3d last = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (const CloudKeyframe& cloud : clouds) {
    if ((cloud.X_FR.t - last).norm() < config.clouds_m) continue;
    last = cloud.X_FR.t;
    const Eigen::Vector3d origin = cloud.X_FR * sensor_R;
    for (std::size_t k = 0; k < cloud.lasers.size(); ++k) {
      const Eigen::Vector3d p = cloud.X_FR * cloud.points_R[k].cast<double>();
      for (const std::uint32_t f : near.of(p)) {
        const WallFace& face = faces[f];
        const double e = face.plane.distance(p);
        const double s = face.along.dot(p.head<2>());
        if (std::abs(e) > config.gate_m || s < face.seen_s0 + edge_m || s > face.seen_s1 - edge_m) continue;
        const double cosine = face.plane.n.dot((p - origin).normalized());
        if (cosine < 0.0) hits.push_back({f, cloud.lasers[k], static_cast<float>(e), static_cast<float>(cosine)});
      }
    }
  }
  return hits;
}

/// Least squares over e = o + b c, o of each face and b of each laser; the faces are eliminated.
class Fit {
 public:
  Fit(std::size_t faces, std::size_t lasers, const LaserRangeCalibrationConfig& config)
      : config_(config), faces_(faces), offset_m_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lasers))) {}

  /// By the hits within the gate of what was found so far.
  void solve(std::span<const Hit> hits, double gate_m) {
    const Eigen::Index lasers = offset_m_.size();
    std::vector<Face> sums(faces_.size());
    for (Face& face : sums) face.c = Eigen::VectorXd::Zero(lasers);
    Eigen::VectorXd cc = Eigen::VectorXd::Zero(lasers), ce = Eigen::VectorXd::Zero(lasers);
    for (const Hit& hit : hits) {
      const double e = static_cast<double>(hit.e_m), c = static_cast<double>(hit.cosine);
      const auto laser = static_cast<Eigen::Index>(hit.laser);
      if (std::abs(e - faces_[hit.face].at_m - offset_m_(laser) * c) > gate_m) continue;
      Face& face = sums[hit.face];
      face.n += 1.0;
      face.e += e;
      face.c(laser) += c;
      cc(laser) += c * c;
      ce(laser) += c * e;
    }
    const double information = 1.0 / (config_.point_sigma_m * config_.point_sigma_m * config_.inflation);
    Eigen::MatrixXd A = (information * cc).asDiagonal();
    Eigen::VectorXd rhs = information * ce;
    for (const Face& face : sums) {
      if (face.n == 0.0) continue;
      A.noalias() -= (information / face.n) * face.c * face.c.transpose();
      rhs -= (information / face.n * face.e) * face.c;
    }
    offset_m_ = solve_ldlt(Eigen::MatrixXd(A + prior_information()), rhs);
    for (Face& face : sums) face.at_m = face.n > 0.0 ? (face.e - face.c.dot(offset_m_)) / face.n : 0.0;
    faces_ = std::move(sums);
  }

  [[nodiscard]] std::vector<double> offsets() const { return {offset_m_.begin(), offset_m_.end()}; }

 private:
  /// Inverse of unit^2 1 1^T + laser^2 I.
  [[nodiscard]] Eigen::MatrixXd prior_information() const {
    const Eigen::Index n = offset_m_.size();
    const double unit = config_.unit_sigma_m * config_.unit_sigma_m;
    const double laser = config_.laser_sigma_m * config_.laser_sigma_m;
    return (Eigen::MatrixXd::Identity(n, n) -
            Eigen::MatrixXd::Constant(n, n, unit / (laser + unit * static_cast<double>(n)))) /
           laser;
  }

  struct Face {
    double n = 0.0, e = 0.0;
    Eigen::VectorXd c;  ///< sum of its hits' cosines, by laser
    double at_m = 0.0;  ///< where it stands, from where it was taken to stand
  };

  LaserRangeCalibrationConfig config_;
  std::vector<Face> faces_;
  Eigen::VectorXd offset_m_;
};

}  // namespace

std::vector<double> calibrate_laser_ranges(std::span<const CloudKeyframe> clouds, std::span<const PlaneNode> walls,
                                           const Eigen::Vector3d& sensor_R, const LaserRangeCalibrationConfig& config,
                                           const MirrorGhostConfig& walls_config) {
  const std::vector<WallFace> faces = wall_faces(walls, walls_config);
  const std::vector<Hit> hits = hits_of(clouds, faces, sensor_R, config);
  if (hits.empty()) return {};
  const auto last =
      std::max_element(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.laser < b.laser; });
  Fit fit(faces.size(), static_cast<std::size_t>(last->laser) + 1, config);
  for (const double share : {1.0, 0.7, 0.5, 0.5}) fit.solve(hits, share * config.gate_m);
  return fit.offsets();
}

void correct_ranges(std::vector<CloudKeyframe>& clouds, std::span<const double> offset_m,
                    const Eigen::Vector3d& sensor_R) {
  for (CloudKeyframe& cloud : clouds)
    for (std::size_t k = 0; k < cloud.lasers.size(); ++k) {
      if (cloud.lasers[k] >= offset_m.size()) continue;
      const Eigen::Vector3d p = cloud.points_R[k].cast<double>();
      cloud.points_R[k] = (p - offset_m[cloud.lasers[k]] * (p - sensor_R).normalized()).cast<float>();
    }
}

}  // namespace plumbline::slam
