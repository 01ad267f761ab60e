// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "scenarios/localizability/constants.h"

namespace plumbline::scenarios {

/// A place and heading of the levelled sensor.
struct SensorPose {
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
  double yaw = 0.0;
  [[nodiscard]] Pose pose() const { return Pose::from_xyz_yaw(position_W, yaw); }
};
/// Position and heading differ by no more than this.
[[nodiscard]] bool same_pose(const SensorPose& a, const SensorPose& b, double metres, double degrees);

/// The levelled, noise-free scan of a place: elevations x azimuths, index elevation * azimuths + azimuth.
struct RangeImage {
  std::vector<double> range_m;            ///< infinity: nothing hit
  std::vector<Eigen::Vector3d> normal_W;  ///< of the face hit
  std::vector<int> element;               ///< of the scene's mesh, -1: nothing hit
};

/// Casts views and compares them. Directions are fixed tables in the levelled sensor frame.
class RangeImager {
 public:
  explicit RangeImager(int azimuths = localizability_constants.azimuths,
                       std::span<const double> elevations_deg = localizability_constants.elevations_deg);
  [[nodiscard]] RangeImage cast(const bim::RayScene& scene, const SensorPose& place) const;
  /// Negative log-likelihood of seeing `seen` where `expected` is predicted (ranges of two views).
  [[nodiscard]] double cost(const std::vector<double>& seen, const std::vector<double>& expected) const;
  [[nodiscard]] const std::vector<Eigen::Vector3d>& directions() const { return directions_; }
  [[nodiscard]] int azimuths() const { return azimuths_; }

 private:
  int azimuths_;
  std::vector<Eigen::Vector3d> directions_;
};

/// What one beam adds to RangeImager::cost.
[[nodiscard]] double beam_cost(double seen_m, double expected_m);

/// What one beam adds to the log-likelihood ratio of a pose, where the plan predicts own_m, over another, where it
/// predicts other_m. `loose`: the beam ends on what may have moved and does not stand as planned. It then tells what
/// the way up to there tells, that no face of the other pose stands in it; and its end never speaks for the pose, but
/// may for the other.
[[nodiscard]] double beam_evidence(double seen_m, double own_m, double other_m, bool loose);

/// The same against what the plan predicts for a beam of the other pose, or next to that beam by what a plan leaves
/// open: beside an edge either side of it may be seen.
[[nodiscard]] double beam_evidence(const bim::RayScene& as_planned, const SensorPose& other,
                                   const Eigen::Vector3d& direction, double seen_m, double own_m, double other_m,
                                   bool loose);

}  // namespace plumbline::scenarios
