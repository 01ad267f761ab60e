// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace plumbline::sim {

struct LegSlopeConfig {
  double time_constant_s = 0.3;
  double ramp_max = 0.25;  ///< rad; what is steeper are stairs, whose treads are level
  double damping = 1e-4;   ///< on the diagonal of the plane fit
};

/// Ground normal estimated from the feet: of the plane through the last footholds. Vertical until every foot has
/// stood, and on stairs.
class LegSlope {
 public:
  explicit LegSlope(const LegSlopeConfig& config) : config_(config) {}

  /// Advances by dt seconds; foot_O: centres of the feet, of which those that stand count.
  void update(const std::array<Eigen::Vector3d, 4>& foot_O, const std::array<bool, 4>& stands, double dt);
  [[nodiscard]] Eigen::Vector3d normal_O() const;

 private:
  LegSlopeConfig config_;
  std::array<Eigen::Vector3d, 4> stood_O_{};
  std::array<bool, 4> known_{};
  Eigen::Vector3d fitted_O_ = Eigen::Vector3d::UnitZ();  ///< low-passed
};

}  // namespace plumbline::sim
