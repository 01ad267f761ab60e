// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "slam/baselines/ukf/grid_match.h"
#include "slam/baselines/ukf/ndt.h"
#include "slam/plan_method/plan_baseline.h"
#include "slam/scan/scan_slice.h"

namespace plumbline::slam {

/// What moves the filter between scans: the IMU as in the reference, nothing (constant velocity), or the legs.
enum class UkfMotion { imu, constant_velocity, odometry };

}  // namespace plumbline::slam

namespace plumbline {
template <>
struct EnumNames<slam::UkfMotion> {
  static constexpr std::array<std::string_view, 3> names = {"imu", "constant_velocity", "odometry"};
};
}  // namespace plumbline

namespace plumbline::slam {

/// Defaults: those of hdl_localization [facts: localization 2.2].
struct UkfConfig {
  UkfMotion motion = UkfMotion::imu;
  double q_position = 1.0;  ///< variances of a second
  double q_velocity = 1.0;
  double q_attitude = 0.5;
  double q_bias = 1e-6;
  double r_position = 0.01;  ///< variances of NDT's pose
  double r_attitude = 0.001;
  double p0 = 0.01;
  double lambda = 1.0;
  double lost_inliers = 0.4;  ///< share of the points on their Gaussian below which a scan does not fit
  int lost_scans = 20;
  bool relocalize = false;  ///< search again when lost; the reference does so only when asked
  double slice_height_m = 0.7;
  ScanSliceConfig slice{.min_height_m = 0.5, .max_height_m = 0.9};
  GridMatchConfig search;
  NdtConfig ndt;
  PlanBaselineConfig plan{.update_m = 0.0, .update_rad = 0.0};
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("motion", motion, Field{.doc = "what moves the filter between scans"});
    v("q_position", q_position, Field{.doc = "variance a second", .min = 0});
    v("q_velocity", q_velocity, Field{.doc = "variance a second", .min = 0});
    v("q_attitude", q_attitude, Field{.doc = "variance a second, of the quaternion", .min = 0});
    v("q_bias", q_bias, Field{.doc = "variance a second, of the IMU's biases", .min = 0});
    v("r_position", r_position, Field{.doc = "variance of NDT's position", .min = 1e-12});
    v("r_attitude", r_attitude, Field{.doc = "variance of NDT's quaternion", .min = 1e-12});
    v("p0", p0, Field{.doc = "variance at the start", .min = 1e-12});
    v("lambda", lambda, Field{.doc = "of the sigma points", .min = 1e-3});
    v("lost_inliers", lost_inliers,
      Field{.doc = "share of points below which a scan does not fit", .min = 0, .max = 1});
    v("lost_scans", lost_scans, Field{.doc = "so many in a row: LOST", .min = 1});
    v("relocalize", relocalize, Field{.doc = "search again when lost"});
    v("slice_height_m", slice_height_m, Field{.doc = "above the floor, of the plan's slice that is searched"});
    v("slice", slice);
    v("search", search);
    v("ndt", ndt);
    v("plan", plan);
    v("map", map);
  }
};

/// NDT of each scan on points drawn on the plan, smoothed by an unscented filter over position, velocity, quaternion
/// and IMU biases, in the style of hdl_localization. It starts where an exhaustive search of the plan's slice puts the
/// first scan, believes that at once (CONVERGED), and is a tracker from then on; no gate stops a correction. LOST is
/// what the reference publishes as a low share of inliers. Throws InputError when there is no plan, no such storey, or
/// no room in it.
[[nodiscard]] std::unique_ptr<Method> make_ukf(const MethodInput& input, const UkfConfig& config = {});

}  // namespace plumbline::slam
