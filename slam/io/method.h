// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "bim/plan/plan.h"
#include "slam/io/estimate.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// The prior of plan localization besides the plan.
struct Prior {
  std::optional<double> yaw_W;        ///< heading of R in W at the start, rad (a compass); absent: unknown
  double yaw_sigma = 0.05;            ///< rad
  std::optional<std::string> storey;  ///< name of the storey; absent: unknown
};

/// All a method gets. No ground truth can be reached from here.
struct MethodInput {
  std::uint64_t seed = 0;  ///< the method's own, see method_seed()
  Calibration calibration;
  std::shared_ptr<const bim::Plan> plan;  ///< null when there is none; SLAM methods ignore it
  Prior prior;
  bool has_odometry = true;  ///< false: on_odometry is never called
  Tree config;               ///< values over the defaults of the method's config struct, or null
};

/// The config struct of a method: the input's values over its defaults. Throws InputError at the value that is wrong.
template <class Config>
[[nodiscard]] Config config_of(const MethodInput& input) {
  return input.config.is_null() ? Config{} : from_tree<Config>(input.config);
}

/// A SLAM or localization method. Records come in time order; within one time odometry and IMU come before the scan.
class Method {
 public:
  virtual ~Method() = default;
  virtual void on_imu(const Imu&) {}
  virtual void on_odometry(const Odometry&) {}
  [[nodiscard]] virtual Output on_scan(const Scan& scan) = 0;
  [[nodiscard]] virtual Estimate finish() = 0;
};

}  // namespace plumbline::slam
