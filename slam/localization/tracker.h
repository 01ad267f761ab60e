// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "slam/localization/range_bias.h"
#include "slam/localization/wall_tolerance.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

struct TrackerConfig {
  int window = 12;
  int iterations = 4;
  double gate = 3.5;
  double overlap_min = 0.5;
  double overlap_margin_m = 0.3;
  double plane_angle_sigma = 0.012;
  double plane_offset_sigma_m = 0.025;
  bool room_factor = true;
  double pair_sigma_m = 0.012;
  double pair_min_cos = 0.999;
  double floor_offset_sigma_m = 0.02;
  double floor_angle_sigma = 0.01;
  double floor_gate_m = 0.3;
  double ground_sigma_m = 0.08;
  double ground_gate_m = 0.35;
  double floor_max_tilt = LocalizationScanConfig{}.floor_max_tilt_rad;
  double odometry_trans_per_m = 0.03;
  double odometry_rot_per_rad = 0.02;
  double odometry_min_m = 0.004;
  double odometry_min_rad = 0.002;
  double odometry_height_per_m = 0.05;
  double odometry_standing_m_per_s = 0.005;
  double odometry_standing_rad_per_s = 0.002;
  double anchor_sigma_m = 0.03;
  double anchor_sigma_rad = 0.01;
  double drift_per_m = 0.03;
  double huber = 2.0;
  double clutter_sigmas = 1.5;
  double misplaced_sigmas = 3.0;
  double range_bias_sigma_m = 0.03;
  double wall_tolerance_m = 0.008;
  double wall_tolerance_min_m = 0.002;
  double wall_tolerance_weight = 1.0;
  double wall_forgetting = 0.2;
  double wall_residual_max_m = 0.1;
  double wall_angle_min = 0.001;
  double position_sigma_min_m = 0.0005;
  double yaw_sigma_min = 0.0001;

  template <class V>
  void visit(V& v) {
    // 0.2 m apart: 2.5 m of way.
    v("window", window, Field{.doc = "latest poses that are optimised together", .min = 2, .max = 1000});
    v("iterations", iterations, Field{.doc = "Gauss-Newton iterations", .min = 1});
    v("gate", gate,
      plain_field("standard deviations up to which an observed wall matches a face of the plan", {.min = 0}));
    v("overlap_min", overlap_min, share_field("least share of the observed patch that lies on the face"));
    v("overlap_margin_m", overlap_margin_m,
      Field{.doc = "length by which a face is extended for this overlap", .min = 0});
    v("plane_angle_sigma", plane_angle_sigma,
      Field{.doc = "standard deviation of a plane's direction, added: plan tolerance and body sway",
            .unit = "rad",
            .min = 1e-6});
    v("plane_offset_sigma_m", plane_offset_sigma_m,
      Field{.doc = "standard deviation of a plane's distance, added: plan tolerance and range bias", .min = 1e-6});
    v("room_factor", room_factor,
      Field{.doc = "whether the middle between opposed walls of the robot's room is a factor", .basic = true});
    v("pair_sigma_m", pair_sigma_m,
      Field{.doc = "standard deviation of the middle between opposed walls, where the range bias cancels",
            .min = 1e-6});
    v("pair_min_cos", pair_min_cos, share_field("cosine of the angle up to which opposed walls are parallel"));
    v("floor_offset_sigma_m", floor_offset_sigma_m,
      Field{.doc = "standard deviation of the height above the floor", .min = 1e-6});
    v("floor_angle_sigma", floor_angle_sigma,
      Field{.doc = "standard deviation of the floor's tilt", .unit = "rad", .min = 1e-6});
    v("floor_gate_m", floor_gate_m,
      Field{.doc = "largest difference of an observed floor from the plan's; on a stair there are others", .min = 0});
    // Half a riser.
    v("ground_sigma_m", ground_sigma_m,
      Field{.doc = "standard deviation of the robot's height above the floor or step that the plan has below it",
            .min = 1e-6});
    v("ground_gate_m", ground_gate_m,
      Field{.doc = "largest difference from that height for which it counts", .min = 0});
    v("floor_max_tilt", floor_max_tilt,
      Field{.doc = "largest tilt of a plane that is taken for the floor", .unit = "rad", .min = 0});
    v("odometry_trans_per_m", odometry_trans_per_m,
      Field{.doc = "standard deviation of the odometry's translation per metre walked", .unit = "m/m", .min = 0});
    v("odometry_rot_per_rad", odometry_rot_per_rad,
      Field{.doc = "standard deviation of the odometry's rotation per radian turned", .unit = "rad/rad", .min = 0});
    v("odometry_min_m", odometry_min_m, Field{.doc = "least standard deviation of a step's translation", .min = 1e-6});
    v("odometry_min_rad", odometry_min_rad, Field{.doc = "least standard deviation of a step's rotation", .min = 1e-6});
    // docs/methods/robot.md
    v("odometry_height_per_m", odometry_height_per_m,
      Field{.doc = "standard deviation of the odometry's height per metre walked, its worst axis",
            .unit = "m/m",
            .min = 0});
    // Leg odometry of a robot that stands on the spot, in a walk through a duplex: 5 mm/s and 1.6 mrad/s.
    v("odometry_standing_m_per_s", odometry_standing_m_per_s,
      Field{.doc = "standard deviation of the odometry's translation per second while the robot stands",
            .unit = "m/s",
            .min = 0});
    v("odometry_standing_rad_per_s", odometry_standing_rad_per_s,
      Field{.doc = "standard deviation of the odometry's rotation per second while the robot stands",
            .unit = "rad/s",
            .min = 0});
    v("anchor_sigma_m", anchor_sigma_m,
      Field{.doc = "standard deviation of the prior position that anchors the oldest pose",
            .min = 1e-6,
            .former = "hold_m"});
    v("anchor_sigma_rad", anchor_sigma_rad,
      Field{.doc = "standard deviation of the prior attitude that anchors the oldest pose",
            .min = 1e-6,
            .former = "hold_rad"});
    // Leg odometry is off by up to 0.02 of the way, always to the same side.
    v("drift_per_m", drift_per_m,
      Field{.doc = "growth of the position's standard deviation per metre walked, where no wall holds it",
            .unit = "m/m",
            .min = 0});
    v("clutter_sigmas", clutter_sigmas,
      plain_field("whitened residual at which a wall observed too near counts a quarter: something stands before it",
                  {.min = 0.1}));
    v("misplaced_sigmas", misplaced_sigmas,
      plain_field("the same of a wall observed too far, which only an error of the plan explains", {.min = 0.1}));
    // A VLP-16 is given as accurate to 3 cm.
    v("range_bias_sigma_m", range_bias_sigma_m,
      Field{.doc = "standard deviation of the LiDAR's range bias before any wall is seen", .min = 1e-6});
    v("wall_tolerance_m", wall_tolerance_m,
      Field{.doc = "standard deviation of a wall's offset from the plan, before residuals of walls are measured",
            .min = 1e-6,
            .max = 0.05});
    v("wall_tolerance_min_m", wall_tolerance_min_m,
      Field{.doc = "and its least value, however small they are", .min = 1e-6, .max = 0.05});
    // Least value: chosen on 46 furnished walks, with NEES. Weight: on four (generator seeds 10302 to 10304 and 10307)
    // and on quickstart, with walls as planned and walls that stand off by 15 and 20 mm (1 sigma), with NEES.
    v("wall_tolerance_weight", wall_tolerance_weight,
      plain_field("number of walls, beyond those that fix a pose, that this value counts for beside those seen",
                  {.min = 0.1}));
    // Five windows.
    v("wall_forgetting", wall_forgetting,
      share_field("share of the walls seen before that a window's way takes away from this measurement"));
    v("wall_residual_max_m", wall_residual_max_m,
      Field{.doc = "residual beyond which a wall's counts no further", .min = 0});
    v("wall_angle_min", wall_angle_min,
      Field{.doc = "least standard deviation of a wall's direction", .unit = "rad", .min = 1e-6});
    // Both chosen on five furnished walks (generator seeds 44, 45, 50, 51, 53), with NEES.
    v("position_sigma_min_m", position_sigma_min_m,
      Field{.doc = "standard deviation of the position that no number of walls lessens", .min = 1e-6});
    v("yaw_sigma_min", yaw_sigma_min,
      Field{.doc = "standard deviation of the yaw that no number of walls lessens", .unit = "rad", .min = 1e-6});
    v("huber", huber, plain_field("whitened residual above which a factor counts linearly (Huber)", {.min = 1e-6}));
  }
};

/// An observed wall and the plan's wall it was found to be.
struct WallLink {
  int line = -1;  ///< index into StoreyIndex::lines
  PlaneObservation observed;
  double weight = 1.0;  ///< by its residual
};

/// One pose of the robot-tracking layer.
struct TrackedPose {
  Nanoseconds stamp = 0;
  Pose X_OR;
  Pose X_IR;              ///< estimate
  double waited_s = 0.0;  ///< since the pose before it, where the robot has stood there
  int room = -1;          ///< index into StoreyIndex::rooms
  std::vector<WallLink> walls;
  std::vector<PlaneObservation> floor;  ///< at most one
  Plane floor_I;                        ///< the plan's floor that it was found to be
};

/// Localization on the plan's own graph [shaheer2023, section 3.4]: the metric-semantic layer (walls) and the
/// topological layer (rooms) come from the plan and stand still; the robot-tracking layer is a window of poses tied to
/// them. An error of the plan or of the sensor ends up in the residuals, never in the plan.
class PlanTracker {
 public:
  /// standing_m: height of R above the ground of a robot that stands.
  PlanTracker(TrackerConfig config, StoreyIndex storey, double standing_m)
      : config_(config),
        storey_(std::move(storey)),
        standing_m_(standing_m),
        range_bias_(config.range_bias_sigma_m),
        wall_tolerances_(config) {}

  /// Starts at a pose in I.
  void start(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes, const Pose& X_IR,
             const Eigen::Matrix2d& position_covariance = Eigen::Matrix2d::Zero());
  /// Adds a pose by odometry, associates, optimises. Returns the pose that left the window, if one did.
  std::vector<TrackedPose> update(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes);

  /// The same for a robot that stands: its newest pose there takes the place of the one before, which is returned if
  /// there was one. What is known by all of its way is not forgotten, and nothing counts twice.
  std::optional<TrackedPose> update_standing(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes);

  /// The direction that walls leave open, as along a corridor; none where they hold the position.
  [[nodiscard]] std::optional<Eigen::Vector2d> open_direction() const;
  /// Takes in that the newest position is off by so much along a direction: a measurement with this variance.
  void correct_along(const Eigen::Vector2d& direction_I, double off_m, double variance);

  /// Goes on on another storey, whose walls are associated from the next pose on.
  void change_storey(StoreyIndex storey);

  /// Height in I of the robot's feet by the newest pose, m.
  [[nodiscard]] double feet_z() const { return window_.back().X_IR.t.z() - standing_m_; }
  /// The same above the storey's floor there.
  [[nodiscard]] double height_over_floor() const {
    return feet_z() - storey_.floor_at(window_.back().X_IR.t.head<2>());
  }
  /// Pose at odometry X_OR by the last correction [shaheer2023, eq. 10].
  [[nodiscard]] Pose pose(const Pose& X_OR) const { return X_IO() * X_OR; }
  [[nodiscard]] Pose X_IO() const;
  [[nodiscard]] const std::deque<TrackedPose>& window() const { return window_; }
  [[nodiscard]] const StoreyIndex& storey() const { return storey_; }
  /// Covariance of (x, y, yaw) of the newest pose in I.
  [[nodiscard]] const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  /// Standard deviations grow by the way gone; walls take back what they hold.
  void carry_anchor_covariance(const TrackedPose& from, const TrackedPose& to);
  [[nodiscard]] TrackedPose associate(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes,
                                      const Pose& X_IR) const;
  void optimise();
  /// Takes the window's walls into what is known of the walls' tolerance; then the covariance anew.
  void measure_walls();
  void weigh_walls();
  /// Of (x, y, yaw) of the newest pose in I.
  [[nodiscard]] Eigen::Matrix3d covariance_of_newest(const std::vector<SeenWall>& walls) const;

  TrackerConfig config_;
  StoreyIndex storey_;
  double standing_m_;
  std::deque<TrackedPose> window_;
  Pose anchor_X_IR_;
  Eigen::Matrix2d anchor_covariance_ = Eigen::Matrix2d::Identity();  ///< of its position in I
  RangeBias range_bias_;                                             ///< by the poses that left the window
  double range_bias_m_ = 0.0;                                        ///< by those of the window, too
  WallTolerances wall_tolerances_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
};

}  // namespace plumbline::slam
