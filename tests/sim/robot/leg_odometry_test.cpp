// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_odometry.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/robot/solid_boxes.h"
#include "sim/robot/types/kinematics.h"
#include "sim/route/pure_pursuit.h"
#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

constexpr int seconds = 50;

/// What the robot felt and where it was, every step of a walk.
struct Walk {
  std::vector<Proprioception> felt;
  std::vector<Pose> X_WR;

  void step(Robot& robot, const Command& command) {
    robot.step(command);
    felt.push_back(robot.proprioception());
    X_WR.push_back(robot.X_WR());
  }
};

/// With turns, on the flat.
const Walk& walk() {
  static const Walk made = [] {
    Walk w;
    Robot robot(Pose::from_xyz_yaw({0.0, 0.0, 1.0}, 0.0), Ground(), {});
    for (int i = 0; i < 500 * seconds; ++i) {
      const double t = i * step_s;
      w.step(robot, {0.7, 0.0, 0.6 * std::sin(0.5 * t), 1.0 + 0.04 * std::sin(2.0 * t)});
    }
    return w;
  }();
  return made;
}

/// Ten steps of 0.15 m up and down again.
Walk stair_walk() {
  std::vector<CollisionBox> steps;
  for (int k = 0; k < 10; ++k)
    steps.push_back(upright_box({2.15 + 0.3 * k, 0.0}, 0.0, {0.15, 1.0}, {0.15 * k - 0.15, 0.15 * k + 0.15}));
  steps.push_back(upright_box({7.0, 0.0}, 0.0, {2.0, 2.0}, {1.3, 1.5}));
  Robot robot(Pose::from_xyz_yaw({1.0, 0.0, 0.9}, 0.0), Ground({{0.0, {}}}, steps), {});
  PurePursuit pursuit(
      PurePursuitConfig{},
      {{{1.0, 0.0, 0.0}}, {{5.4, 0.0, 1.5}, true}, {{6.5, 0.0, 1.5}}, {{5.6, 0.0, 1.5}}, {{1.4, 0.0, 0.0}, true}}, 1);
  Walk w;
  for (std::int64_t tick = 0; !pursuit.done() && tick < 30000; ++tick)
    w.step(robot, pursuit.update(robot.X_WR(), tick));
  return w;
}

/// Straight up 8 m of a slope.
Walk ramp_walk(double slope_rad) {
  CollisionBox ramp;
  ramp.half = {4.0 / std::cos(slope_rad), 1.5, 0.1};
  ramp.X_WB.q = exp_so3({0.0, -slope_rad, 0.0});
  ramp.X_WB.t = Eigen::Vector3d(5.0, 0.0, 4.0 * std::tan(slope_rad)) - ramp.X_WB.q * Eigen::Vector3d(0.0, 0.0, 0.1);
  Robot robot(Pose::from_xyz_yaw({0.0, 0.0, 0.9}, 0.0), Ground({{0.0, {}}}, {ramp}), {});
  Walk w;
  while (robot.X_WR().t.x() < 8.0 && robot.steps() < 15000)
    w.step(robot, {0.5, 0.0, -2.0 * robot.X_WR().yaw() - robot.X_WR().t.y(), 1.0});
  return w;
}

std::vector<Pose> odometry(const Walk& walked, ProprioceptiveSensors sensors, const LegOdometryConfig& config) {
  LegOdometry legs(config);
  std::vector<Pose> X_OR;
  for (std::size_t i = 0; i < walked.felt.size(); ++i) {
    legs.update(sensors.read(walked.felt[i], static_cast<std::int64_t>(i)), step_s);
    X_OR.push_back(legs.X_OR());
  }
  return X_OR;
}

std::vector<Pose> odometry(const Walk& walked, OdometryPreset preset, std::uint64_t seed) {
  return odometry(walked, ProprioceptiveSensors(preset, seed), leg_odometry_config(preset, seed));
}

struct Drift {
  double xy_share = 0.0;  ///< RMS relative error in the plane over 10 m of way, as a share
  double scale = 0.0;     ///< odometry's distance over the true one
  double yaw_deg_per_min = 0.0;
  double z_per_10m = 0.0;  ///< worst, m
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
    const double z = X_OR[j].t.z() - X_OR[i].t.z() - X_WR[j].t.z() + X_WR[i].t.z();
    out.z_per_10m = std::max(out.z_per_10m, std::abs(z));
    moved_O += said_R.head<2>().norm();
    moved_W += true_R.head<2>().norm();
    ++count;
  }
  out.xy_share = std::sqrt(squares / count) / 10.0;
  out.scale = moved_O / moved_W;
  const double yaw = wrap_angle(X_OR.back().yaw() - X_OR[0].yaw() - X_WR.back().yaw() + X_WR[0].yaw());
  out.yaw_deg_per_min = yaw * 180.0 / std::numbers::pi * 60.0 / seconds;
  return out;
}

TEST(LegOdometry, WithoutNoiseItHardlyDrifts) {
  const Drift d = drift(odometry(walk(), OdometryPreset::ideal, 1));
  EXPECT_LT(d.xy_share, 0.002);                 // measured 0.0005 to 0.0011
  EXPECT_LT(std::abs(d.yaw_deg_per_min), 0.1);  // measured 0.00
  EXPECT_LT(d.z_per_10m, 0.02);                 // measured: 16 mm over all 35 m
}

TEST(LegOdometry, WithNoiseItDriftsAsRealLeggedRobotsDo) {
  std::vector<double> xy, yaw, z;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Drift d = drift(odometry(walk(), OdometryPreset::noisy, seed));
    xy.push_back(d.xy_share);
    yaw.push_back(std::abs(d.yaw_deg_per_min));
    z.push_back(d.z_per_10m);
    EXPECT_LT(d.xy_share, 0.03) << seed;
    EXPECT_LT(std::abs(d.yaw_deg_per_min), 9.0) << seed;  // 3 standard deviations of the bias
    // The gyro's bias times the tilt's time constant leans the attitude by 3.2 mrad, one standard deviation, and as
    // much is climbed per metre; 3.5 of those besides what is left without noise.
    EXPECT_LT(d.z_per_10m, 0.02 + 3.5 * 0.032) << seed;
  }
  for (std::vector<double>* values : {&xy, &yaw, &z}) std::sort(values->begin(), values->end());
  EXPECT_GT(xy[9], 0.003);
  EXPECT_LT(xy[10], 0.015);
  EXPECT_GT(yaw[9], 0.5);
  EXPECT_LT(yaw[10], 5.0);
  EXPECT_LT(z[10], 0.032);
}

TEST(LegOdometry, ClimbsWhatTheRobotClimbs) {
  const Walk stairs = stair_walk();
  const Walk ramp = ramp_walk(0.05), steep = ramp_walk(0.15);
  for (std::uint64_t seed = 0; seed <= 5; ++seed) {
    const OdometryPreset preset = seed == 0 ? OdometryPreset::ideal : OdometryPreset::noisy;
    double worst = 0.0;
    const std::vector<Pose> X_OR = odometry(stairs, preset, seed);
    for (std::size_t i = 0; i < X_OR.size(); ++i)
      worst = std::max(worst, std::abs(X_OR[i].t.z() - stairs.X_WR[i].t.z() + stairs.X_WR[0].t.z()));
    EXPECT_LT(worst, 0.12) << seed;
    for (const Walk* w : {&ramp, &steep}) {
      const double rise = w->X_WR.back().t.z() - w->X_WR.front().t.z();
      const double said = odometry(*w, preset, seed).back().t.z();
      // Without noise 0.955 and 0.967 of the rise; feet taken to roll on level ground would make it 0.89. The gyro's
      // bias leans the attitude by 3.2 mrad, one standard deviation, over 8 m of way.
      EXPECT_NEAR(said, 0.96 * rise, 0.02 * rise + (seed == 0 ? 0.0 : 3.5 * 3.2e-3 * 8.0)) << seed;
      EXPECT_GT(rise, 0.3);
    }
  }
}

/// Mean normalised squared error of the increments over 1 s, covariances of 10 ms compounded as if independent.
double mean_nees(std::uint64_t seed) {
  ProprioceptiveSensors sensors(OdometryPreset::noisy, seed);
  LegOdometry legs(leg_odometry_config(OdometryPreset::noisy, seed));
  const Walk& w = walk();
  Pose X_OR_record, X_OR_begin;
  Matrix6d covariance = Matrix6d::Zero();
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < w.felt.size(); ++i) {
    legs.update(sensors.read(w.felt[i], static_cast<std::int64_t>(i)), step_s);
    if (i % 5 != 0) continue;
    const Matrix6d carried = adjoint(legs.X_OR().inverse() * X_OR_record);
    covariance = carried * covariance * carried.transpose() + legs.take_covariance();
    X_OR_record = legs.X_OR();
    if (i % 500 != 0) continue;
    if (i > 0) {
      const Pose true_R = w.X_WR[i - 500].inverse() * w.X_WR[i];
      const Vector6d error = log_se3(true_R.inverse() * (X_OR_begin.inverse() * X_OR_record));
      sum += error.dot(covariance.ldlt().solve(error));
      ++count;
    }
    X_OR_begin = X_OR_record;
    covariance.setZero();
  }
  return sum / count;
}

/// Errors that last a run count once a draw, so the mean over 20 draws knows at least what 20 x 6 squares know: 99.9 %
/// of chi^2 with 120 degrees of freedom, over 20, lies in 3.8 to 8.9.
TEST(LegOdometry, CovarianceIsConsistentOverASecond) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) sum += mean_nees(seed);
  EXPECT_GT(sum / 20.0, 3.8);
  EXPECT_LT(sum / 20.0, 8.9);
}

TEST(LegOdometry, ForgettingThatFeetRollMakesItShort) {
  LegOdometryConfig config;
  config.rolling = false;
  const Drift d = drift(odometry(walk(), ProprioceptiveSensors(OdometryPreset::ideal, 1), config));
  // A leg of about 0.5 m on a sphere of 0.035 m: 1 - 0.035 / 0.5, so 5 to 8 % depending on the leg's lean.
  EXPECT_GT(d.scale, 0.92);
  EXPECT_LT(d.scale, 0.95);
  EXPECT_FALSE(leg_odometry_config(OdometryPreset::uncorrected, 1).rolling);
}

TEST(LegOdometry, SameSeedSameBits) {
  const std::vector<Pose> a = odometry(walk(), OdometryPreset::noisy, 4);
  const std::vector<Pose> b = odometry(walk(), OdometryPreset::noisy, 4);
  const std::vector<Pose> c = odometry(walk(), OdometryPreset::noisy, 5);
  EXPECT_EQ(a.back().t, b.back().t);
  EXPECT_EQ(a.back().q.coeffs(), b.back().q.coeffs());
  EXPECT_NE(a.back().t, c.back().t);
}

}  // namespace
}  // namespace plumbline::sim
