// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/mount_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "bim/geometry/pose.h"
#include "bim/random/stream.h"

namespace plumbline::scenarios {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Eigen::Quaterniond turn_by(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// Three normals a tick and lane.
Eigen::Vector3d normals(const Stream& random, int tick, std::uint32_t lane) {
  const auto t = static_cast<std::uint64_t>(tick);
  return {random.gauss(t, lane, 0), random.gauss(t, lane, 1), random.gauss(t, lane, 2)};
}

struct Walk {
  double yaw_rate_radps = 0.5;  ///< to and fro
  double speed_mps = 0.6;
  bool odometry = true, imu = false;
};

/// Twenty seconds at 10 Hz of a robot whose LiDAR is turned by `q` against the mount that is given, and what is said.
std::optional<std::string> said_of(const Walk& walk, const Eigen::Quaterniond& q,
                                   const Eigen::Quaterniond& mount_RL = Eigen::Quaterniond::Identity()) {
  constexpr double dt = 0.1;
  MountCheck check;
  std::vector<slam::StampedPose> by_scans;
  Pose X_OR, X_MR;
  for (int k = 1; k <= 200; ++k) {
    const double rate = k % 60 < 30 ? walk.yaw_rate_radps : -0.7 * walk.yaw_rate_radps;
    const Pose step = Pose::from_xyz_yaw({walk.speed_mps * dt, 0.0, 0.0}, rate * dt);
    const Pose turned{q, Eigen::Vector3d::Zero()};
    X_OR = X_OR * step;
    X_MR = X_MR * (turned.inverse() * step * turned);
    slam::SensorFrame frame;
    frame.scan.stamp = k * slam::Nanoseconds{100'000'000};
    if (walk.odometry) frame.odometry.push_back({frame.scan.stamp, X_OR});
    for (int i = 1; walk.imu && i <= 10; ++i)
      frame.imu.push_back({frame.scan.stamp + (i - 10) * slam::Nanoseconds{10'000'000}, Eigen::Vector3d(0.0, 0.0, rate),
                           Eigen::Vector3d(0.0, 0.0, 9.81)});
    check.add(frame);
    by_scans.push_back({frame.scan.stamp, X_MR});
  }
  return check.warning(by_scans, mount_RL);
}

TEST(MountCheck, SaysNothingOfAMountThatFits) {
  EXPECT_FALSE(said_of({}, Eigen::Quaterniond::Identity()));
  EXPECT_FALSE(said_of({.odometry = false, .imu = true}, Eigen::Quaterniond::Identity()));
  EXPECT_FALSE(said_of({}, turn_by(5.0 * degree, Eigen::Vector3d::UnitZ()))) << "feet slip sideways";
  EXPECT_FALSE(said_of({.odometry = false}, turn_by(1.0, Eigen::Vector3d::UnitX()))) << "neither odometry nor IMU";
}

TEST(MountCheck, NeedsMotion) {
  const Eigen::Quaterniond turned = turn_by(1.0, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(said_of({.yaw_rate_radps = 0.0, .speed_mps = 0.0}, turned));
  EXPECT_TRUE(said_of({.yaw_rate_radps = 0.0}, turned)) << "a way is enough";
}

TEST(MountCheck, SaysHowTheLidarIsTurned) {
  const std::optional<std::string> yaw = said_of({}, turn_by(90.0 * degree, Eigen::Vector3d::UnitZ()));
  ASSERT_TRUE(yaw);
  EXPECT_NE(yaw->find("roll 0, pitch 0, yaw 90 degrees"), std::string::npos) << *yaw;
  EXPECT_NE(yaw->find("[0, 0, 0.707, 0.707]"), std::string::npos) << *yaw;
  EXPECT_EQ(yaw->find("wrong sign"), std::string::npos) << *yaw;
  const std::optional<std::string> pitch = said_of({}, turn_by(-20.0 * degree, Eigen::Vector3d::UnitY()));
  ASSERT_TRUE(pitch);
  EXPECT_NE(pitch->find("roll 0, pitch -20, yaw 0 degrees"), std::string::npos) << *pitch;
}

TEST(MountCheck, GivesTheMountThatWouldFitWhateverWasGiven) {
  const Stream random(1, "bim.generate");
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond mount_RL = exp_so3(normals(random, i, 0));
    const double angle = 10.0 + 160.0 * random.uniform(static_cast<std::uint64_t>(i), 1);
    const Eigen::Quaterniond q = turn_by(angle * degree, normals(random, i, 2));
    const std::optional<std::string> said = said_of({}, q, mount_RL);
    ASSERT_TRUE(said) << i;
    double x = 0.0, y = 0.0, z = 0.0, w = 0.0;
    const std::size_t at = said->find('[');
    ASSERT_EQ(std::sscanf(said->c_str() + at, "[%lf, %lf, %lf, %lf]", &x, &y, &z, &w), 4) << *said;
    EXPECT_LT((q * mount_RL).angularDistance(Eigen::Quaterniond(w, x, y, z).normalized()), 0.3 * degree) << *said;
  }
}

TEST(MountCheck, AGyroAloneTellsTheTiltButNotTheTurnAboutItsAxis) {
  const Walk walk{.odometry = false, .imu = true};
  EXPECT_FALSE(said_of(walk, turn_by(1.0, Eigen::Vector3d::UnitZ())));
  const std::optional<std::string> said = said_of(walk, turn_by(std::numbers::pi, Eigen::Vector3d::UnitX()));
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("of the gyro"), std::string::npos) << *said;
  EXPECT_NE(said->find("y of all points has the wrong sign"), std::string::npos) << *said;
}

TEST(CommonRotation, IsFoundAtRandomAndTheLeastOneAlongALine) {
  const Stream random(2, "bim.generate");
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond q = exp_so3(normals(random, i, 0));
    std::vector<Eigen::Vector3d> a, b;
    for (std::uint32_t k = 0; k < 4; ++k) {
      b.push_back(normals(random, i, 1 + k));
      a.emplace_back(q * b.back());
    }
    const std::optional<CommonRotation> found = common_rotation(a, b);
    ASSERT_TRUE(found);
    EXPECT_LT(found->q_AB.angularDistance(q), 1e-6);
    EXPECT_NEAR(found->fit, 1.0, 1e-9);
    const std::optional<CommonRotation> line = common_rotation({a[0], -2.0 * a[0]}, {b[0], -2.0 * b[0]});
    ASSERT_TRUE(line);
    EXPECT_LT((line->q_AB * b[0] - a[0]).norm(), 1e-6);
    EXPECT_NEAR(log_so3(line->q_AB).norm(), std::acos(std::clamp(a[0].normalized().dot(b[0].normalized()), -1.0, 1.0)),
                1e-5);
  }
  EXPECT_FALSE(common_rotation({}, {}));
}

}  // namespace
}  // namespace plumbline::scenarios
