// SPDX-License-Identifier: Apache-2.0
#include "bim/random/stream.h"

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bim/digest/digest.h"
#include "bim/errors.h"

namespace plumbline {

namespace {

constexpr std::array<std::string_view, 24> names = {
    "bim.generate",
    "scenario.prior",
    "scenario.start",
    "sim.gait.command",
    "sim.ground.uneven",
    "sim.imu.accelerometer",
    "sim.imu.bias",
    "sim.imu.gyro",
    "sim.lidar.bias",
    "sim.lidar.dropout",
    "sim.lidar.phase",
    "sim.lidar.range",
    "sim.lidar.reflectivity",
    "sim.odometry.contact",
    "sim.odometry.encoder",
    "sim.odometry.scale",
    "sim.odometry.velocity",
    "sim.robot.push",
    "slam.localize.init",
    "slam.localize.motion",
    "slam.localize.resample",
    "slam.localize.recover",
    "slam.loop",
    "slam.ransac",
};

std::array<std::uint32_t, 4> philox(std::uint64_t key, std::uint64_t tick, std::uint32_t lane, std::uint32_t draw) {
  const r123::Philox4x32::ctr_type counter = {
      {static_cast<std::uint32_t>(tick), static_cast<std::uint32_t>(tick >> 32U), lane, draw}};
  const r123::Philox4x32::key_type k = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32U)}};
  const auto r = r123::Philox4x32()(counter, k);
  return {r[0], r[1], r[2], r[3]};
}

std::uint64_t join(std::uint32_t high, std::uint32_t low) { return (static_cast<std::uint64_t>(high) << 32U) | low; }

double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1.0p-53; }

}  // namespace

std::span<const std::string_view> stream_names() { return names; }

Stream::Stream(std::uint64_t seed, std::string_view name) : key_(Digest().add(seed).add(name).value()) {
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InternalError("random stream '" + std::string(name) + "' is not in the list of streams");
}

std::uint64_t Stream::bits(std::uint64_t tick, std::uint32_t lane, std::uint32_t draw) const {
  const auto r = philox(key_, tick, lane, draw);
  return join(r[0], r[1]);
}

double Stream::uniform(std::uint64_t tick, std::uint32_t lane, std::uint32_t draw) const {
  return unit(bits(tick, lane, draw));
}

double Stream::gauss(std::uint64_t tick, std::uint32_t lane, std::uint32_t draw) const {
  const auto r = philox(key_, tick, lane, draw);
  const double u1 = unit(join(r[0], r[1])) + 0x1.0p-54;
  const double u2 = unit(join(r[2], r[3]));
  return std::sqrt(-2.0 * std::log(u1)) * std::cos(2.0 * std::numbers::pi * u2);
}

std::uint64_t method_seed(std::uint64_t run_seed, std::string_view method) {
  return Digest().add(std::string_view("method")).add(run_seed).add(method).value();
}

}  // namespace plumbline
