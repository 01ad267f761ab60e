// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "sim/robot/trot/state.h"
#include "sim/robot/trot/trot_config.h"
#include "sim/robot/trot/wrench.h"

namespace plumbline::sim {

/// Splits a wrench into foot forces inside friction pyramids, docs/methods/robot.md, by a fixed number of ADMM
/// iterations warm-started from the step before.
class ForceDistribution {
 public:
  explicit ForceDistribution(const ForceConfig& config) : config_(config) {}

  /// lever_W: from the centre of mass to each contact point, m; fz_max: N, 0 takes a leg out of the problem.
  /// Returns the ground's force on each foot, N.
  [[nodiscard]] PerLeg<Eigen::Vector3d> solve(const Wrench& wrench, const PerLeg<Eigen::Vector3d>& lever_W,
                                              const PerLeg<double>& fz_max);

 private:
  static constexpr int forces = 12;
  static constexpr int constraints = 20;  ///< per leg: mu fz +- fx, mu fz +- fy, fz
  using Force = Eigen::Matrix<double, forces, 1>;
  using Slack = Eigen::Matrix<double, constraints, 1>;

  void forget(std::size_t leg);
  [[nodiscard]] Force iterate(const Eigen::Matrix<double, forces, forces>& H, const Force& g,
                              const PerLeg<double>& fz_max);

  ForceConfig config_;
  Force previous_ = Force::Zero();
  Slack z_ = Slack::Zero();
  Slack u_ = Slack::Zero();
};

}  // namespace plumbline::sim
