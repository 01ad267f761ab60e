// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bim/geometry/polygon.h"
#include "slam/io/estimate.h"
#include "slam/io/records.h"

/// Small analytic worlds for tests of estimators: boxes, a smooth walk, a rolling-shutter VLP-16 and leg odometry with
/// known errors. Truth is for the tests' own comparisons.
namespace plumbline::slam::synthetic {

/// Axis-aligned solid in W, m.
struct Box {
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Ones();
};

/// Walls as boxes between a floor at z = 0 and a ceiling; rooms by their clear inner outlines, counter-clockwise.
struct House {
  std::vector<Box> boxes;
  std::vector<Polygon2> rooms;
  double height_m = 2.8;
};

/// One empty room x in [0, length], y in [0, width], walls 0.2 m thick outside of it.
[[nodiscard]] House one_room(double length = 6.0, double width = 4.0);
/// A corridor (room 0: 14 x 2.2 m along x, y from 0 to 2.2) with three rooms above it and two below (rooms 1-5), doors
/// 1.0 x 2.1 m, walls 0.2 m.
[[nodiscard]] House corridor_house();
/// A walk through all rooms of corridor_house(), about 57 m.
[[nodiscard]] std::vector<Eigen::Vector2d> corridor_house_walk();
/// Two storeys, 3 m apart, with the same walls: a room (6 x 4 m, y from 0) and beside it a straight flight of stairs
/// along x, with a door at either end.
[[nodiscard]] House two_storeys();
/// From the lower room up the stairs and round the upper one, about 17 m.
[[nodiscard]] std::vector<Eigen::Vector2d> two_storeys_walk();
/// Height of the floor after s m of that way.
[[nodiscard]] double two_storeys_climb(double s);

struct WalkConfig {
  std::uint64_t seed = 1;
  double speed_mps = 0.6;
  double duration_s = 1e9;       ///< ends earlier when the way is done
  double range_sigma_m = 0.012;  ///< 6-20 mm, docs/methods/lidar_model.md
  double range_bias_m = 0.0;
  double dropout = 0.05;              ///< share of returns lost
  double vibration = 1.0;             ///< scales roll 0.8 deg, pitch 0.6 deg and bounce 6 mm of a 2.1 Hz gait; 0: none
  double odometry_scale = 1.0;        ///< of translation increments
  double odometry_sigma = 0.01;       ///< m per square root of a metre walked, x, y and z
  double odometry_yaw_sigma = 0.01;   ///< rad per square root of a metre walked
  double (*climb)(double) = nullptr;  ///< height of the floor after so many metres of the way; null: 0
};

struct Recording {
  Calibration calibration;
  std::vector<Odometry> odometry;  ///< 100 Hz
  std::vector<Imu> imu;            ///< none unless put there
  std::vector<Scan> scans;
  std::vector<StampedPose> truth;  ///< X_WR at each scan's stamp
};

/// Pose of the robot's base at time t, s, of a walk along the waypoints: corners rounded, gait vibration on top.
[[nodiscard]] Pose walk_pose(const std::vector<Eigen::Vector2d>& waypoints, const WalkConfig& config, double t);
/// Whole messages until the way or the time is done. Draws are addressed by the firing number.
[[nodiscard]] Recording walk(const House& house, const std::vector<Eigen::Vector2d>& waypoints,
                             const WalkConfig& config);
/// One scan of a robot standing at X_WR.
[[nodiscard]] Scan standing_scan(const House& house, const Pose& X_WR, const WalkConfig& config);
/// The same returns as a file without ring numbers has them: those of a ring after those of the one above.
[[nodiscard]] Scan without_rings(const Scan& scan);
[[nodiscard]] Calibration calibration();

}  // namespace plumbline::slam::synthetic
