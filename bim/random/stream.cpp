// SPDX-License-Identifier: Apache-2.0
#include "bim/random/stream.h"

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "bim/digest/digest.h"
#include "bim/errors.h"

namespace plumbline {

namespace {

constexpr std::array<std::string_view, 35> names = {
    "bim.furnish",
    "bim.furniture.alter",
    "bim.furniture.people",
    "bim.generate",
    "recording.thinned",
    "scenario.hunt",
    "scenario.prior",
    "scenario.start",
    "sim.faults.clock",
    "sim.faults.imu",
    "sim.faults.mount",
    "sim.faults.slip",
    "sim.gait.command",
    "sim.ground.uneven",
    "sim.imu.accelerometer",
    "sim.imu.bias",
    "sim.imu.gyro",
    "sim.lidar.airborne",
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
    "slam.trial",
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

// Series in place of the library's functions, which differ by CPU and take longer; two numbers side by side, each
// rounded by itself. They are as exact as 32 bits need.
using Double2 = double __attribute__((vector_size(16)));

Double2 both(double value) { return Double2{value, value}; }

/// ln((bits + 1/2) / 2^32), to 1e-13.
Double2 log_unit(std::uint32_t bits_a, std::uint32_t bits_b) {
  constexpr std::uint64_t root_half = 0x3FE6A09E667F3BCD;  // of sqrt(1/2)
  Double2 m, k;
  for (const auto& [i, bits] : {std::pair(0, bits_a), std::pair(1, bits_b)}) {
    // The number is m 2^k with m from sqrt(1/2) to sqrt(2).
    const auto raw = std::bit_cast<std::uint64_t>((static_cast<double>(bits) + 0.5) * 0x1.0p-32);
    const std::int64_t exponent = static_cast<std::int64_t>(raw - root_half) >> 52;
    k[i] = static_cast<double>(exponent);
    m[i] = std::bit_cast<double>(raw - (static_cast<std::uint64_t>(exponent) << 52U));
  }
  // ln m = 2 artanh((m - 1) / (m + 1)).
  const Double2 s = (m - 1.0) / (m + 1.0), q = s * s;
  Double2 series = both(1.0 / 15.0);
  for (const double term : {1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0})
    series = series * q + term;
  return k * std::numbers::ln2 + 2.0 * s * series;
}

/// Cosines and sines of 2 pi bits / 2^32, to 1e-13.
std::array<Double2, 2> cos_sin_turn(std::uint32_t bits_a, std::uint32_t bits_b) {
  constexpr double rad = 2.0 * std::numbers::pi * 0x1.0p-32;
  // The nearest quarter of a turn, and the rest, within an eighth to either side.
  const auto quarter = [](std::uint32_t bits) { return (bits + 0x20000000U) >> 30U; };
  const auto rest = [&](std::uint32_t bits) {
    return static_cast<double>(static_cast<std::int32_t>(bits - (quarter(bits) << 30U)));
  };
  const Double2 x = rad * Double2{rest(bits_a), rest(bits_b)}, q = x * x;
  Double2 c = both(1.0 / 87178291200.0), s = both(1.0 / 6227020800.0);
  for (const double term : {1.0 / 479001600.0, 1.0 / 3628800.0, 1.0 / 40320.0, 1.0 / 720.0, 1.0 / 24.0, 0.5, 1.0})
    c = term - c * q;
  for (const double term : {1.0 / 39916800.0, 1.0 / 362880.0, 1.0 / 5040.0, 1.0 / 120.0, 1.0 / 6.0, 1.0})
    s = term - s * q;
  s *= x;
  const std::array<Double2, 4> turned = {c, -s, -c, s};
  const std::uint32_t a = quarter(bits_a), b = quarter(bits_b);
  return {Double2{turned[a & 3U][0], turned[b & 3U][1]}, Double2{turned[(a + 3U) & 3U][0], turned[(b + 3U) & 3U][1]}};
}

std::uint64_t key_of(const Seed& seed, std::string_view name) {
  Digest digest = Digest().add(seed.run).add(name);
  if (seed.part > 0) digest.add(static_cast<std::uint64_t>(seed.part));
  return digest.value();
}

}  // namespace

std::span<const std::string_view> stream_names() { return names; }

Stream::Stream(Seed seed, std::string_view name) : key_(key_of(seed, name)) {
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

std::array<double, 4> Stream::gauss4(std::uint64_t tick, std::uint32_t lane, std::uint32_t draw) const {
  const auto r = philox(key_, tick, lane, draw);
  const Double2 squares = -2.0 * log_unit(r[0], r[2]);
  const Double2 far = {std::sqrt(squares[0]), std::sqrt(squares[1])};
  const auto [c, s] = cos_sin_turn(r[1], r[3]);
  const Double2 x = far * c, y = far * s;
  return {x[0], y[0], x[1], y[1]};
}

std::uint64_t method_seed(std::uint64_t run_seed, std::string_view method) {
  return Digest().add(std::string_view("method")).add(run_seed).add(method).value();
}

}  // namespace plumbline
