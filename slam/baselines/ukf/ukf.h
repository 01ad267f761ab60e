// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "slam/baselines/ukf/grid_match.h"
#include "slam/baselines/ukf/ndt.h"
#include "slam/plan_method/plan_method.h"
#include "slam/scan/scan_slice.h"

namespace plumbline::slam {

/// What moves the filter between scans: the IMU as in the reference, nothing (constant velocity), or odometry.
enum class UkfMotion { imu, constant_velocity, odometry };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(UkfMotion) {
  return {"imu", "constant_velocity", "odometry"};
}

/// Defaults: those of hdl_localization [koide2019].
struct UkfConfig {
  UkfMotion motion = UkfMotion::imu;
  double q_position = 1.0;
  double q_velocity = 1.0;
  double q_attitude = 0.5;
  double q_bias = 1e-6;
  double r_position = 0.01;
  double r_attitude = 0.001;
  double p0 = 0.01;
  double lambda = 1.0;
  double lost_inliers = 0.4;
  int lost_scans = 20;
  bool relocalize = false;
  double slice_height_m = 0.7;
  ScanSliceConfig slice{.min_height_m = 0.5, .max_height_m = 0.9};
  GridMatchConfig search;
  NdtConfig ndt;
  PlanMethodConfig plan{{.update_m = 0.0, .update_rad = 0.0}};
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("motion", motion, Field{.doc = "what predicts the filter between scans", .basic = true});
    v("q_position", q_position,
      Field{.doc = "process noise: variance of the position a second", .unit = "m²/s", .min = 0});
    v("q_velocity", q_velocity,
      Field{.doc = "process noise: variance of the velocity a second", .unit = "m²/s³", .min = 0});
    v("q_attitude", q_attitude,
      Field{.doc = "process noise: variance of the quaternion's components a second", .unit = "1/s", .min = 0});
    v("q_bias", q_bias,
      Field{.doc = "process noise: variance of the accelerometer's and gyro's biases a second",
            .unit = "m²/s⁵, rad²/s³",
            .min = 0});
    v("r_position", r_position,
      Field{.doc = "measurement noise: variance of NDT's position", .unit = "m²", .min = 1e-12});
    v("r_attitude", r_attitude,
      plain_field("measurement noise: variance of the components of NDT's quaternion", {.min = 1e-12}));
    v("p0", p0, Field{.doc = "variance of every state at the start, in SI units", .unit = "SI", .min = 1e-12});
    v("lambda", lambda, plain_field("scale of the spread of the sigma points", {.min = 1e-3}));
    v("lost_inliers", lost_inliers,
      share_field("share of inliers among a scan's points below which it does not fit", {.basic = true}));
    v("lost_scans", lost_scans, Field{.doc = "scans in a row without a fit after which the state is LOST", .min = 1});
    // The reference does so only when asked.
    v("relocalize", relocalize, Field{.doc = "search the whole plan again when lost", .basic = true});
    v("slice_height_m", slice_height_m,
      Field{.doc = "height above the floor of the plan's slice that is searched", .min = -10, .max = 100});
    v("slice", slice);
    v("search", search);
    v("ndt", ndt);
    v("plan", plan);
    v("map", map);
  }
};

/// NDT of each scan on points drawn on the plan, smoothed by an unscented filter over position, velocity, quaternion
/// and IMU biases, in the style of hdl_localization. It starts where an exhaustive search of the plan's slice puts the
/// first scan, accepts that at once (CONVERGED), and is a tracker from then on; no gate stops a correction. LOST is
/// what the reference publishes as a low share of inliers. Throws InputError when there is no plan, no such storey, or
/// no room in it.
[[nodiscard]] std::unique_ptr<Method> make_ukf(const MethodInput& input, const UkfConfig& config = {});

}  // namespace plumbline::slam
