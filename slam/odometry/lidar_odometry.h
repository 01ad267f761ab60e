// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "bim/config/visit.h"
#include "slam/loam/aloam.h"
#include "slam/loam/floam.h"
#include "slam/odometry/health.h"
#include "slam/registration/registration.h"
#include "slam/registration/vgicp.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Which front end a method uses. legs: dead reckoning alone.
enum class OdometryKind { vgicp, floam, aloam, legs };
[[nodiscard]] constexpr std::array<std::string_view, 4> names_of(OdometryKind) {
  return {"vgicp", "floam", "aloam", "legs"};
}

struct LidarOdometryConfig {
  OdometryKind kind = OdometryKind::vgicp;
  VgicpConfig vgicp;
  loam::FloamConfig floam;
  loam::AloamConfig aloam;
  HealthConfig health;
  double dead_reckoning_sigma_m = 0.02;
  double dead_reckoning_sigma_rad = 0.01;

  template <class V>
  void visit(V& v) {
    v("kind", kind, Field{.doc = "front end; legs: dead reckoning by leg odometry", .basic = true});
    v("vgicp", vgicp);
    v("floam", floam, Field{.advanced = true});
    v("aloam", aloam, Field{.advanced = true});
    v("health", health);
    v("dead_reckoning_sigma_m", dead_reckoning_sigma_m,
      Field{.doc = "standard deviation of dead reckoning's position, per root metre walked",
            .unit = "m/√m",
            .min = 1e-4,
            .former = "legs_m"});
    v("dead_reckoning_sigma_rad", dead_reckoning_sigma_rad,
      Field{.doc = "standard deviation of dead reckoning's heading, per root metre walked",
            .unit = "rad/√m",
            .min = 1e-5,
            .former = "legs_rad"});
  }
};

/// The scan that was last matched, deskewed by the step that was found for it. When it is the second of all, so is the
/// first: nothing was known of its motion before.
struct DeskewedAgain {
  DeskewedScan scan;
  std::optional<DeskewedScan> first;
};
/// Nothing where it is no better.
using DeskewAgain = std::function<std::optional<DeskewedAgain>(const Pose& step)>;

/// Scan by scan pose in M, which starts at the first pose: X_MR = identity. A scan that does not fit leaves the pose to
/// dead reckoning, see Registration::accepted. Odometry's motion over a gap in its records, or over a jump, is
/// discarded: scans alone measure it.
class LidarOdometry {
 public:
  virtual ~LidarOdometry() = default;
  /// X_OR: leg odometry at scan.stamp, in a frame whose z is up; only its increments and its tilt may be used.
  [[nodiscard]] virtual Registration update(const DeskewedScan& scan, const Pose& X_OR) = 0;
  /// From scans alone: a search starts as if the motion before went on.
  [[nodiscard]] virtual Registration update_alone(const DeskewedScan& scan, const DeskewAgain& again) = 0;
  /// After the scan that began a map, from scans alone: as if the robot went at this velocity, in R. `first` is that
  /// scan, deskewed so, and begins the map in its place.
  virtual void assume_velocity(const DeskewedScan& first, const Eigen::Vector3d& mps) = 0;
  [[nodiscard]] virtual std::unique_ptr<LidarOdometry> clone() const = 0;
  /// The place of the map is known again, from outside: a loop closure to before it was lost.
  virtual void locate_map() = 0;
  /// R's motion from the last scan until `stamp` if the motion before goes on.
  [[nodiscard]] virtual Pose continued_step(Nanoseconds stamp) const = 0;
};

/// Information of a step by dead reckoning over `way_m` walked, of the right increment: errors grow with its root.
[[nodiscard]] Matrix6d dead_reckoning_information(const LidarOdometryConfig& config, double way_m);
/// Information of a step that nothing measured of a robot that last went at this speed: any plausible one.
[[nodiscard]] Matrix6d unknown_information(const HealthConfig& limits, Nanoseconds dt, double speed_mps);

[[nodiscard]] std::unique_ptr<LidarOdometry> make_lidar_odometry(const LidarOdometryConfig& config);

}  // namespace plumbline::slam
