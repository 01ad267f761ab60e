// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_odometry.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/robot/kinematics.h"

namespace plumbline::sim {
namespace {

constexpr double step_s = 0.002;
constexpr int seconds = 50;

/// One walk with turns: what the robot felt and where it was, every step.
struct Walk {
  std::vector<Proprioception> felt;
  std::vector<Pose> X_WR;
};

const Walk& walk() {
  static const Walk made = [] {
    Walk w;
    Robot robot(Pose::from_xyz_yaw({0.0, 0.0, 1.0}, 0.0), Ground(), {});
    for (int i = 0; i < 500 * seconds; ++i) {
      const double t = i * step_s;
      robot.step({0.7, 0.0, 0.6 * std::sin(0.5 * t), 1.0 + 0.04 * std::sin(2.0 * t)});
      w.felt.push_back(robot.proprioception());
      w.X_WR.push_back(robot.X_WR());
    }
    return w;
  }();
  return made;
}

std::vector<Pose> odometry(ProprioceptiveSensors sensors, const LegOdometryConfig& config) {
  LegOdometry legs(config);
  std::vector<Pose> X_OR;
  for (std::size_t i = 0; i < walk().felt.size(); ++i) {
    legs.update(sensors.read(walk().felt[i], static_cast<std::int64_t>(i)), step_s);
    X_OR.push_back(legs.X_OR());
  }
  return X_OR;
}

std::vector<Pose> odometry(OdometryPreset preset, std::uint64_t seed) {
  return odometry(ProprioceptiveSensors(preset, seed), leg_odometry_config(preset, seed));
}

struct Drift {
  double xy_share = 0.0;  ///< RMS relative error in the plane over 10 m of way, as a share
  double scale = 0.0;     ///< odometry's distance over the true one
  double yaw_deg_per_min = 0.0;
  double z_max_m = 0.0;
};

Drift drift(const std::vector<Pose>& X_OR) {
  const std::vector<Pose>& X_WR = walk().X_WR;
  std::vector<double> way = {0.0};
  for (std::size_t i = 1; i < X_WR.size(); ++i)
    way.push_back(way.back() + (X_WR[i].t - X_WR[i - 1].t).head<2>().norm());
  Drift out;
  double squares = 0.0, moved_O = 0.0, moved_W = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < way.size(); i += 500) {
    const auto j = static_cast<std::size_t>(std::lower_bound(way.begin(), way.end(), way[i] + 10.0) - way.begin());
    if (j == way.size()) break;
    const Eigen::Vector3d true_R = (X_WR[i].inverse() * X_WR[j]).t;
    const Eigen::Vector3d said_R = (X_OR[i].inverse() * X_OR[j]).t;
    squares += (said_R - true_R).head<2>().squaredNorm();
    moved_O += said_R.head<2>().norm();
    moved_W += true_R.head<2>().norm();
    ++count;
  }
  out.xy_share = std::sqrt(squares / count) / 10.0;
  out.scale = moved_O / moved_W;
  const double yaw = wrap_angle(X_OR.back().yaw() - X_OR[0].yaw() - X_WR.back().yaw() + X_WR[0].yaw());
  out.yaw_deg_per_min = yaw * 180.0 / std::numbers::pi * 60.0 / seconds;
  for (std::size_t i = 0; i < X_OR.size(); ++i)
    out.z_max_m = std::max(out.z_max_m, std::abs(X_OR[i].t.z() - (X_WR[i].t.z() - X_WR[0].t.z())));
  return out;
}

TEST(LegOdometry, WithoutNoiseItHardlyDrifts) {
  const Drift d = drift(odometry(OdometryPreset::ideal, 1));
  EXPECT_LT(d.xy_share, 0.002);                 // measured 0.0005 to 0.0011
  EXPECT_LT(std::abs(d.yaw_deg_per_min), 0.1);  // measured 0.00
  EXPECT_LT(d.z_max_m, 0.005);                  // measured 1.3 mm
}

TEST(LegOdometry, WithNoiseItDriftsAsRealLeggedRobotsDo) {
  std::vector<double> xy, yaw;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    const Drift d = drift(odometry(OdometryPreset::noisy, seed));
    xy.push_back(d.xy_share);
    yaw.push_back(std::abs(d.yaw_deg_per_min));
    EXPECT_LT(d.xy_share, 0.03) << seed;
    EXPECT_LT(std::abs(d.yaw_deg_per_min), 9.0) << seed;  // 3 standard deviations of the bias
    EXPECT_LT(d.z_max_m, 0.01) << seed;
  }
  std::sort(xy.begin(), xy.end());
  std::sort(yaw.begin(), yaw.end());
  EXPECT_GT(xy[4], 0.003);
  EXPECT_LT(xy[4], 0.015);
  EXPECT_GT(yaw[4], 0.5);
  EXPECT_LT(yaw[4], 5.0);
}

TEST(LegOdometry, ForgettingThatFeetRollMakesItShort) {
  LegOdometryConfig config;
  config.rolling = false;
  const Drift d = drift(odometry(ProprioceptiveSensors(OdometryPreset::ideal, 1), config));
  // A leg of about 0.5 m on a sphere of 0.035 m: 1 - 0.035 / 0.5, so 5 to 8 % depending on the leg's lean.
  EXPECT_GT(d.scale, 0.92);
  EXPECT_LT(d.scale, 0.95);
  EXPECT_FALSE(leg_odometry_config(OdometryPreset::uncorrected, 1).rolling);
}

TEST(LegOdometry, SameSeedSameBits) {
  const std::vector<Pose> a = odometry(OdometryPreset::noisy, 4);
  const std::vector<Pose> b = odometry(OdometryPreset::noisy, 4);
  const std::vector<Pose> c = odometry(OdometryPreset::noisy, 5);
  EXPECT_EQ(a.back().t, b.back().t);
  EXPECT_EQ(a.back().q.coeffs(), b.back().q.coeffs());
  EXPECT_NE(a.back().t, c.back().t);
}

/// A reading of a level robot whose feet stand still in the world while the base moves straight up.
SensorReading rising(double base_z, double base_vz, const std::array<double, 4>& floor_z,
                     const std::array<bool, 4>& contact) {
  SensorReading reading;
  reading.contact = contact;
  reading.accelerometer_R.z() = 9.81;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const double depth = floor_z[leg] + robot_dimensions.foot_radius - base_z;
    const Eigen::Vector3d q =
        leg_angles(leg, hip_R(leg) + Eigen::Vector3d(0.0, side_sign(leg) * robot_dimensions.abduction, depth));
    const Eigen::Vector3d qd = foot_jacobian_R(leg, q).inverse() * Eigen::Vector3d(0.0, 0.0, -base_vz);
    std::copy_n(q.data(), 3, reading.q.begin() + static_cast<std::ptrdiff_t>(3 * leg));
    std::copy_n(qd.data(), 3, reading.qd.begin() + static_cast<std::ptrdiff_t>(3 * leg));
  }
  return reading;
}

TEST(LegOdometry, SeesAStepButNotAPebble) {
  for (const double step_m : {0.17, 0.02}) {
    LegOdometry legs{LegOdometryConfig{}};
    const std::array<bool, 4> all = {true, true, true, true};
    for (int i = 0; i < 100; ++i) legs.update(rising(0.5, 0.0, {0.0, 0.0, 0.0, 0.0}, all), step_s);
    for (int i = 0; i < 100; ++i)
      legs.update(rising(0.5, 0.0, {step_m, 0.0, 0.0, step_m}, {false, true, true, false}), step_s);
    for (int i = 0; i < 100; ++i) legs.update(rising(0.5, 0.0, {step_m, 0.0, 0.0, step_m}, all), step_s);
    for (int i = 0; i < 100; ++i)
      legs.update(rising(0.5, 0.0, {step_m, step_m, step_m, step_m}, {true, false, false, true}), step_s);
    for (int i = 0; i < 500; ++i)
      legs.update(rising(0.5 + step_m * i / 500.0, step_m, {step_m, step_m, step_m, step_m}, all), step_s);
    const double expected = step_m > LegOdometryConfig{}.level_step_m ? step_m : 0.0;
    EXPECT_NEAR(legs.X_OR().t.z(), expected, 0.002);
  }
}

}  // namespace
}  // namespace plumbline::sim
