// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "bim/config/visit.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

struct TrackerConfig {
  int window = 12;           ///< poses optimised together, 0.2 m apart: 2.5 m of way
  int iterations = 4;        ///< Gauss-Newton steps
  double gate = 3.5;         ///< sigmas of an observed wall to a face of the plan
  double overlap_min = 0.5;  ///< share of the patch on the face
  double overlap_margin_m = 0.3;
  double plane_angle_sigma = 0.012;     ///< rad, plan tolerance and body sway, added to the fit's
  double plane_offset_sigma_m = 0.025;  ///< plan tolerance and the unit's range bias (15 mm), added to the fit's
  double pair_sigma_m = 0.012;          ///< of the middle between two opposed walls, where the range bias cancels
  double pair_min_cos = 0.999;          ///< opposed walls of a room are this parallel
  double floor_offset_sigma_m = 0.02;
  double floor_angle_sigma = 0.01;  ///< rad
  double floor_max_tilt = ViewConfig{}.floor_max_tilt_rad;
  double odometry_trans_per_m = 0.03;
  double odometry_rot_per_rad = 0.02;
  double odometry_min_m = 0.004;
  double odometry_min_rad = 0.002;
  double odometry_height_per_m = 0.05;  ///< leg odometry's height is its worst axis [facts: legged 10]
  double hold_m = 0.03;                 ///< sigma with which the oldest pose stays where it was
  double hold_rad = 0.01;
  double huber = 2.0;  ///< sigmas

  template <class V>
  void visit(V& v) {
    v("window", window, Field{.doc = "poses optimised together, 0.2 m apart: 2.5 m of way", .min = 2, .max = 1000});
    v("iterations", iterations, Field{.doc = "Gauss-Newton steps", .min = 1});
    v("gate", gate, Field{.doc = "sigmas of an observed wall to a face of the plan", .min = 0});
    v("overlap_min", overlap_min, Field{.doc = "share of the patch on the face", .min = 0, .max = 1});
    v("overlap_margin_m", overlap_margin_m, Field{.min = 0});
    v("plane_angle_sigma", plane_angle_sigma,
      Field{.doc = "rad, plan tolerance and body sway, added to the fit's", .min = 1e-6});
    v("plane_offset_sigma_m", plane_offset_sigma_m,
      Field{.doc = "plan tolerance and the unit's range bias (15 mm), added to the fit's", .min = 1e-6});
    v("pair_sigma_m", pair_sigma_m,
      Field{.doc = "of the middle between two opposed walls, where the range bias cancels", .min = 1e-6});
    v("pair_min_cos", pair_min_cos, Field{.doc = "opposed walls of a room are this parallel", .min = 0, .max = 1});
    v("floor_offset_sigma_m", floor_offset_sigma_m, Field{.min = 1e-6});
    v("floor_angle_sigma", floor_angle_sigma, Field{.doc = "rad", .min = 1e-6});
    v("floor_max_tilt", floor_max_tilt, Field{.doc = "rad", .min = 0});
    v("odometry_trans_per_m", odometry_trans_per_m, Field{.min = 0});
    v("odometry_rot_per_rad", odometry_rot_per_rad, Field{.min = 0});
    v("odometry_min_m", odometry_min_m, Field{.min = 0});
    v("odometry_min_rad", odometry_min_rad, Field{.min = 0});
    v("odometry_height_per_m", odometry_height_per_m,
      Field{.doc = "leg odometry's height is its worst axis", .min = 0});
    v("hold_m", hold_m, Field{.doc = "sigma with which the oldest pose stays where it was", .min = 1e-6});
    v("hold_rad", hold_rad, Field{.min = 1e-6});
    v("huber", huber, Field{.doc = "sigmas", .min = 1e-6});
  }
};

/// An observed wall and the plan's wall it was found to be.
struct WallLink {
  int line = -1;  ///< index into StoreyIndex::lines
  PlaneObservation observed;
};

/// One pose of the robot-tracking layer.
struct TrackedPose {
  Nanoseconds stamp = 0;
  Pose X_OR;
  Pose X_IR;      ///< estimate
  int room = -1;  ///< index into StoreyIndex::rooms
  std::vector<WallLink> walls;
  std::vector<PlaneObservation> floor;  ///< at most one
};

/// Localization on the plan's own graph [BIM-Loc section 3.4]: the metric-semantic layer (walls) and the topological
/// layer (rooms) come from the plan and stand still; the robot-tracking layer is a window of poses tied to them. An
/// error of the plan or of the sensor ends up in the residuals, never in the plan.
class PlanTracker {
 public:
  PlanTracker(TrackerConfig config, StoreyIndex storey) : config_(config), storey_(std::move(storey)) {}

  /// Starts at a pose in I.
  void start(const View& view, const std::vector<PlaneObservation>& planes, const Pose& X_IR);
  /// Adds a pose by odometry, associates, optimises. Returns the pose that left the window, if one did.
  std::vector<TrackedPose> update(const View& view, const std::vector<PlaneObservation>& planes);

  /// Pose at odometry X_OR by the last correction [BIM-Loc eq. 10].
  [[nodiscard]] Pose pose(const Pose& X_OR) const { return X_IO() * X_OR; }
  [[nodiscard]] Pose X_IO() const;
  [[nodiscard]] const std::deque<TrackedPose>& window() const { return window_; }
  [[nodiscard]] const StoreyIndex& storey() const { return storey_; }
  /// Covariance of (x, y, yaw) of the newest pose in I.
  [[nodiscard]] const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  [[nodiscard]] TrackedPose associate(const View& view, const std::vector<PlaneObservation>& planes,
                                      const Pose& X_IR) const;
  void optimise();

  TrackerConfig config_;
  StoreyIndex storey_;
  std::deque<TrackedPose> window_;
  Pose held_X_IR_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
};

}  // namespace plumbline::slam
