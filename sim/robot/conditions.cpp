// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/conditions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::sim {

namespace {

enum Draw : std::uint32_t { when, strength, direction };

std::int64_t steps(double seconds, double step_s) { return std::max<std::int64_t>(1, std::llround(seconds / step_s)); }

}  // namespace

Pushes::Pushes(const PushConfig& config, double step_s, Seed seed)
    : config_(config),
      span_steps_(steps(config.every_s, step_s)),
      push_steps_(steps(config.duration_s, step_s)),
      stream_(seed, "sim.robot.push") {}

Eigen::Vector2d Pushes::force_W(std::int64_t step) const {
  if (config_.max_n <= 0.0 || step < 0) return Eigen::Vector2d::Zero();
  const auto span = static_cast<std::uint64_t>(step / span_steps_);
  const double third = static_cast<double>(span_steps_) / 3.0;
  const auto begin = static_cast<std::int64_t>(third * (1.0 + stream_.uniform(span, 0, when)));
  const std::int64_t into = step % span_steps_ - begin;
  if (into < 0 || into >= push_steps_) return Eigen::Vector2d::Zero();
  const double n = config_.min_n + (config_.max_n - config_.min_n) * stream_.uniform(span, 0, strength);
  const double angle = 2.0 * std::numbers::pi * stream_.uniform(span, 0, direction);
  return n * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

}  // namespace plumbline::sim
