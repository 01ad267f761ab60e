// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "bim/config/visit.h"
#include "bim/plan/plan.h"
#include "slam/plan_map/float4.h"
#include "slam/plan_map/pose2.h"
#include "slam/planes/plane_detector.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

struct LocalizationScanConfig {
  int beams = 180;
  int grid_columns = 900;
  int grid_rings = 8;
  double min_height_m = 0.3;
  double max_height_m = 2.5;
  double min_range_m = 0.5;
  double max_range_m = 25.0;
  double min_wall_length_m = 0.6;
  double min_wall_top_m = 0.8;
  double floor_max_tilt_rad = 0.1;

  template <class V>
  void visit(V& v) {
    v("beams", beams,
      Field{.doc = "beams spread over a full turn; particles use every beam_stride-th", .min = 8, .max = 10000});
    v("grid_columns", grid_columns,
      Field{.doc = "columns of the beam grid by which hypotheses are compared",
            .min = 8,
            .max = 2000,
            .former = "sweep_columns"});
    v("grid_rings", grid_rings,
      Field{.doc = "most rings of the beam grid", .min = 1, .max = 128, .former = "sweep_rings"});
    v("min_height_m", min_height_m,
      Field{.doc = "least height of a return above the floor; lower ones are floor or feet", .min = 0});
    v("max_height_m", max_height_m,
      Field{.doc = "largest height of a return above the floor; higher ones are ceiling", .min = 0});
    v("min_range_m", min_range_m,
      Field{.doc = "least range of a return that is used; nearer is the robot's own body", .min = 0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 0});
    v("min_wall_length_m", min_wall_length_m,
      Field{.doc = "least length of a wall patch; shorter ones are often furniture", .min = 0});
    v("min_wall_top_m", min_wall_top_m,
      Field{.doc = "least height of a wall patch's top above the floor; lower ones are furniture", .min = 0});
    v("floor_max_tilt_rad", floor_max_tilt_rad,
      Field{.doc = "largest tilt of a plane that is taken for the floor", .min = 0});
  }
};

/// One return seen from the sensor in the heading frame H (origin at R, z along gravity, x ahead).
struct Beam {
  Eigen::Vector2d direction_H = Eigen::Vector2d::UnitX();  ///< unit
  double range = 0.0;                                      ///< horizontal, m
  double slope = 0.0;                                      ///< rise per horizontal metre
};

/// Returns of four rings at one step of the turn; seen like a Beam.
struct BeamGridBlock {
  Float4 x = all(1.0F), y = all(0.0F);  ///< unit directions in H
  Float4 range = all(0.0F);             ///< horizontal, m; 0: no return
  Float4 slope = all(0.0F);             ///< rise per horizontal metre
  Float4 aside = all(0.0F);             ///< how far beside the line to the sensor at the stamp the beam began, m
};

/// Returns spread evenly over turn and rings.
struct BeamGrid {
  int columns = 0;
  std::vector<BeamGridBlock> blocks;  ///< four rings after four rings, in each by the turn
};

/// A wall patch seen from the sensor, in H [shaheer2023, eq. 3, as (n, d) with n towards the sensor].
struct WallObservation {
  double azimuth = 0.0;         ///< of the normal, rad
  double distance = 0.0;        ///< of the sensor from the plane, m
  double s0 = 0.0, s1 = 0.0;    ///< ends along the wall from the sensor's foot point, free space on the left
  double sigma_azimuth = 0.0;   ///< of the fit, rad
  double sigma_distance = 0.0;  ///< of the fit, m
  int observation = -1;         ///< index into the observations it was made of
};

/// Most walls of a scan, so that the inner loops need no memory of their own.
inline constexpr std::size_t max_walls = 32;

/// One scan as the localization uses it. It is compared with the plan in the sensor's heading frame, not in W: a
/// residual in W would grow with the distance from W's origin.
struct LocalizationScan {
  Nanoseconds stamp = 0;
  Pose X_OR;
  Eigen::Quaterniond q_HR;                             ///< roll and pitch, from gravity
  double tilt_sigma = 0.0;                             ///< of either beyond what an IMU leaves, rad
  Eigen::Vector2d sensor_H = Eigen::Vector2d::Zero();  ///< position of L
  Eigen::Vector3d sensor_R = Eigen::Vector3d::Zero();  ///< the same in R
  double sensor_height = 0.0;                          ///< of L above the floor, m
  std::vector<Beam> beams;                             ///< by azimuth of the scan
  BeamGrid beam_grid;
  std::vector<WallObservation> walls;  ///< in the order of the observations (largest first), at most max_walls

  /// Whether a plane facing up may be the floor: R stands above it or, as the footprint, on it, and L well above.
  [[nodiscard]] bool is_below(const Plane& plane_R) const {
    return plane_R.d > 0.1 || (plane_R.d > -0.1 && plane_R.distance(sensor_R) > 0.15);
  }
};

/// Gravity comes from the odometry's attitude, the height from the floor plane where one is seen, else from the
/// calibration. height_tolerance_m: a floor that lies farther from the calibrated height is not the one below; a level
/// plane 0.3 m over it is a table.
[[nodiscard]] LocalizationScan make_localization_scan(
    const DeskewedScan& scan, const std::vector<PlaneObservation>& planes, const Pose& X_OR,
    const Calibration& calibration, const LocalizationScanConfig& config,
    double height_tolerance_m = std::numeric_limits<double>::infinity());

/// Height above the floor up to which returns are no ceiling's, m: at most the one configured, lower where the ceilings
/// of a tenth of the rooms' area are.
[[nodiscard]] double wall_height(const bim::Plan& plan, const LocalizationScanConfig& config);

}  // namespace plumbline::slam
