// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

Proprioception standstill() {
  Proprioception truth;
  for (std::size_t i = 0; i < truth.q.size(); ++i) truth.q[i] = 0.1 * static_cast<double>(i);
  truth.touch = {80.0, 24.9, 25.1, 0.0};
  truth.gyro_R = {0.1, -0.2, 0.3};
  truth.accelerometer_R = {0.0, 0.0, 9.81};
  return truth;
}

std::vector<SensorReading> standing(OdometryPreset preset, std::uint64_t seed, int ticks) {
  ProprioceptiveSensors sensors(preset, seed);
  std::vector<SensorReading> out;
  for (int i = 0; i < ticks; ++i) out.push_back(sensors.read(standstill(), i));
  return out;
}

/// Standard deviation of white noise by the differences of neighbours, which drop what changes slowly.
template <class Value>
double white_sd(const std::vector<SensorReading>& readings, int lanes, const Value& value) {
  double sum = 0.0;
  for (std::size_t i = 1; i < readings.size(); ++i)
    for (int lane = 0; lane < lanes; ++lane) {
      const double d = value(readings[i], lane) - value(readings[i - 1], lane);
      sum += d * d;
    }
  return std::sqrt(sum / (2.0 * lanes * static_cast<double>(readings.size() - 1)));
}

Eigen::Vector3d mean_gyro(const std::vector<SensorReading>& readings, std::size_t begin, std::size_t end) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = begin; i < end; ++i) sum += readings[i].gyro_R;
  return sum / static_cast<double>(end - begin);
}

TEST(ProprioceptiveSensors, IdealIsTheTruth) {
  const Proprioception truth = standstill();
  for (const SensorReading& reading : standing(OdometryPreset::ideal, 1, 20)) {
    EXPECT_EQ(reading.q, truth.q);
    EXPECT_EQ(reading.qd, truth.qd);
    EXPECT_EQ(reading.gyro_R, truth.gyro_R);
    EXPECT_EQ(reading.accelerometer_R, truth.accelerometer_R);
    EXPECT_EQ(reading.contact, (std::array<bool, 4>{true, false, true, false}));
  }
}

/// N samples of neighbours' differences know a standard deviation to sqrt(1.5 / 2N): 0.35 % of 3 axes, 0.18 % of 12
/// joints; the tolerances are four of those.
TEST(ProprioceptiveSensors, WhiteNoiseIsAsConfigured) {
  const std::vector<SensorReading> readings = standing(OdometryPreset::noisy, 3, 20000);
  const ProprioceptionNoise noise = noise_of(OdometryPreset::noisy);
  const auto joint = [](const std::array<double, 12>& values, int lane) {
    return values[static_cast<std::size_t>(lane)];
  };
  const double gyro = white_sd(readings, 3, [](const SensorReading& r, int lane) { return r.gyro_R[lane]; });
  const double accelerometer =
      white_sd(readings, 3, [](const SensorReading& r, int lane) { return r.accelerometer_R[lane]; });
  const double encoder = white_sd(readings, 12, [&](const SensorReading& r, int lane) { return joint(r.q, lane); });
  const double velocity = white_sd(readings, 12, [&](const SensorReading& r, int lane) { return joint(r.qd, lane); });
  EXPECT_NEAR(gyro / noise.gyro, 1.0, 0.014);
  EXPECT_NEAR(accelerometer / noise.accelerometer, 1.0, 0.014);
  EXPECT_NEAR(encoder / noise.encoder, 1.0, 0.007);
  EXPECT_NEAR(velocity / noise.joint_velocity, 1.0, 0.007);
}

/// 900 draws know their standard deviation to 2.4 %; four of those.
TEST(ProprioceptiveSensors, TheGyrosBiasIsDrawnOnceARun) {
  constexpr std::size_t ticks = 200;
  const ProprioceptionNoise noise = noise_of(OdometryPreset::noisy);
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const std::vector<SensorReading> readings = standing(OdometryPreset::noisy, seed, ticks);
    squares += (mean_gyro(readings, 0, ticks) - standstill().gyro_R).squaredNorm();
  }
  const double expected = std::hypot(noise.gyro_bias, noise.gyro / std::sqrt(ticks));
  EXPECT_NEAR(std::sqrt(squares / 900.0) / expected, 1.0, 0.096);
}

/// Half the mean squared difference of neighbouring means over time tau: noise^2 / samples + walk^2 tau / 3.
TEST(ProprioceptiveSensors, TheGyrosBiasWalks) {
  constexpr std::size_t ticks = 20000;
  constexpr double tau = 0.5 * ticks * step_s;
  const ProprioceptionNoise noise = noise_of(OdometryPreset::noisy);
  constexpr std::uint64_t seeds = 60;
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::vector<SensorReading> readings = standing(OdometryPreset::noisy, seed, ticks);
    squares += (mean_gyro(readings, ticks / 2, ticks) - mean_gyro(readings, 0, ticks / 2)).squaredNorm();
  }
  const double white = noise.gyro * noise.gyro / (ticks / 2);
  const double walk = noise.gyro_bias_walk * noise.gyro_bias_walk * tau / 3.0;
  EXPECT_LT(white, 0.4 * walk);  // so that the walk is what is tested
  // The variance of n normal values has a relative standard deviation of sqrt(2 / n): 10.5 %. Three of those; without a
  // walk the ratio would be below 0.29.
  constexpr double n = 3.0 * seeds;
  EXPECT_NEAR(squares / n / 2.0 / (white + walk), 1.0, 3.0 * std::sqrt(2.0 / n));
}

/// A count of 160 has a standard deviation of 12.6; four of those.
TEST(ProprioceptiveSensors, ContactFlagsFlip) {
  const std::vector<SensorReading> readings = standing(OdometryPreset::noisy, 5, 20000);
  const std::array<bool, 4> truth = {true, false, true, false};
  int flips = 0;
  for (const SensorReading& reading : readings)
    for (std::size_t leg = 0; leg < truth.size(); ++leg) flips += reading.contact[leg] != truth[leg];
  EXPECT_NEAR(flips, 80000 * noise_of(OdometryPreset::noisy).contact_flip, 51.0);
}

}  // namespace
}  // namespace plumbline::sim
