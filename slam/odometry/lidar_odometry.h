// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "bim/config/visit.h"
#include "slam/loam/aloam.h"
#include "slam/loam/floam.h"
#include "slam/odometry/health.h"
#include "slam/registration/registration.h"
#include "slam/registration/vgicp.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Which front end a method walks on. legs: dead reckoning alone.
enum class OdometryKind { vgicp, floam, aloam, legs };

struct LidarOdometryConfig {
  OdometryKind kind = OdometryKind::vgicp;
  VgicpConfig vgicp;
  loam::FloamConfig floam;
  loam::AloamConfig aloam;
  HealthConfig health;
  double legs_m = 0.02;    ///< standard deviation of a metre of dead reckoning, per root metre
  double legs_rad = 0.01;  ///< and of its heading

  template <class V>
  void visit(V& v) {
    v("kind", kind, Field{.doc = "vgicp, floam, aloam or legs"});
    v("vgicp", vgicp);
    v("floam", floam);
    v("aloam", aloam);
    v("health", health);
    v("legs_m", legs_m, Field{.doc = "of a metre of dead reckoning, m", .min = 1e-4});
    v("legs_rad", legs_rad, Field{.doc = "of a metre of dead reckoning, rad", .min = 1e-5});
  }
};

/// Scan by scan pose in M, which starts at the first pose: X_MR = identity. A scan that does not fit leaves the pose to
/// dead reckoning, see Registration::believed. What odometry says of a time over which it was silent, or of a jump, is
/// no step of the robot's: scans alone tell of it.
class LidarOdometry {
 public:
  virtual ~LidarOdometry() = default;
  /// X_OR: leg odometry at scan.stamp, in a frame whose z is up; only its increments and its tilt may be used.
  [[nodiscard]] virtual Registration update(const DeskewedScan& scan, const Pose& X_OR) = 0;
};

/// Information of a step by dead reckoning over `way_m` walked, of the right increment: errors grow with its root.
[[nodiscard]] Matrix6d reckoned_information(const LidarOdometryConfig& config, double way_m);
/// Information of a step of which only the time is known: all that a robot can do in it.
[[nodiscard]] Matrix6d unknown_information(const HealthConfig& limits, Nanoseconds dt);

[[nodiscard]] std::unique_ptr<LidarOdometry> make_lidar_odometry(const LidarOdometryConfig& config);

}  // namespace plumbline::slam

namespace plumbline {

template <>
struct EnumNames<slam::OdometryKind> {
  static constexpr std::array<std::string_view, 4> names = {"vgicp", "floam", "aloam", "legs"};
};

}  // namespace plumbline
