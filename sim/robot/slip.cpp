// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/slip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::sim {

namespace {

constexpr std::uint32_t slip_begin = 0;  // draws
constexpr std::uint32_t slip_direction = 1;

std::int64_t steps(double seconds, double step_s) { return std::max<std::int64_t>(1, std::llround(seconds / step_s)); }

}  // namespace

Slips::Slips(const SlipConfig& config, double step_s, Seed seed)
    : config_(config),
      span_steps_(steps(config.every_s, step_s)),
      slip_steps_(steps(config.duration_s, step_s)),
      stream_(seed, "sim.faults.slip") {}

Eigen::Vector3d Slips::velocity_R(std::int64_t step) const {
  if (config_.speed_mps <= 0.0 || step < 0) return Eigen::Vector3d::Zero();
  const auto span = static_cast<std::uint64_t>(step / span_steps_);
  const double third = static_cast<double>(span_steps_) / 3.0;
  const auto begin = static_cast<std::int64_t>(third * (1.0 + stream_.uniform(span, 0, slip_begin)));
  const std::int64_t into = step % span_steps_ - begin;
  if (into < 0 || into >= slip_steps_) return Eigen::Vector3d::Zero();
  const double angle = 2.0 * std::numbers::pi * stream_.uniform(span, 0, slip_direction);
  return config_.speed_mps * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
}

}  // namespace plumbline::sim
