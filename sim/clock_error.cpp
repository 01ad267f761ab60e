// SPDX-License-Identifier: Apache-2.0
#include "sim/clock_error.h"

#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

constexpr double jitter_max = 3.0;              ///< standard deviations
constexpr slam::Nanoseconds least_step = 1000;  ///< between the stamps of two records

}  // namespace

StampError::StampError(const ClockConfig& config, Seed seed, std::uint32_t lane)
    : config_(config), stream_(seed, "sim.faults.clock"), lane_(lane) {}

std::optional<slam::Nanoseconds> StampError::stamp(std::int64_t step, slam::Nanoseconds true_stamp) {
  if ((config_.offset_s == 0.0 && config_.jitter_s == 0.0) || step == 0) return true_stamp;
  double error_s = config_.offset_s;
  if (config_.jitter_s > 0.0)
    error_s +=
        config_.jitter_s * std::clamp(stream_.gauss(static_cast<std::uint64_t>(step), lane_), -jitter_max, jitter_max);
  const slam::Nanoseconds wanted = true_stamp + std::llround(1e9 * error_s);
  if (wanted <= 0) return std::nullopt;
  last_ = std::max(wanted, last_ + least_step);
  return last_;
}

slam::Nanoseconds longest_lead(const ClockConfig& config) {
  return std::max<slam::Nanoseconds>(0, std::llround(1e9 * (jitter_max * config.jitter_s - config.offset_s)));
}

}  // namespace plumbline::sim
