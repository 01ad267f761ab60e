// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>

#include "slam/localization/pipeline.h"
#include "slam/localization/tracker.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

constexpr double drift_m_per_s = 0.005, drift_rad_per_s = 0.002;  // as leg odometry on the spot

/// Odometry of a robot that has stood for so long.
Pose drifted(const Pose& X_OR, double seconds_stood) {
  return X_OR * Pose::from_xyz_yaw({drift_m_per_s * seconds_stood, 0.0, 0.0}, drift_rad_per_s * seconds_stood);
}

// Odometry moves by less than update_m, so that no scan is due by the way.
TEST(StandingRobot, IsFollowedWhereItsOdometryDrifts) {
  synthetic::WalkConfig config;
  config.duration_s = 10.0;
  const synthetic::House house = synthetic::corridor_house();
  const synthetic::Recording recording = synthetic::walk(house, synthetic::corridor_house_walk(), config);
  MethodInput input;
  input.seed = 17;
  input.calibration = recording.calibration;
  input.plan = std::make_shared<bim::Plan>(synthetic::plan_of(house));
  input.prior.yaw_W = recording.truth.front().X_FR.yaw();
  const std::unique_ptr<Method> method = make_s_graph_localization(input);
  Output last;
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    while (next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp)
      method->on_odometry(recording.odometry[next++]);
    last = method->on_scan(scan);
  }
  ASSERT_EQ(last.state, State::converged);
  const Pose X_WR = recording.truth.back().X_FR;
  Odometry odometry = recording.odometry[next - 1];
  const Pose X_OR = odometry.X_OR;
  Scan scan = synthetic::standing_scan(house, X_WR, config);
  const Nanoseconds stood_from = recording.scans.back().stamp;
  for (int tick = 1; tick <= 3000; ++tick) {
    const double stood_s = 0.01 * tick;
    odometry.stamp = stood_from + tick * Nanoseconds{10'000'000};
    odometry.X_OR = drifted(X_OR, stood_s);
    method->on_odometry(odometry);
    if (tick % 10 != 0) continue;
    scan.stamp = odometry.stamp;
    last = method->on_scan(scan);
    EXPECT_EQ(last.state, State::converged);
    ASSERT_TRUE(last.X_FR);
    // Odometry alone would be 15 cm and 60 mrad off at the end. 3 mm and 3 mrad are measured.
    EXPECT_LT((last.X_FR->t - X_WR.t).head<2>().norm(), 0.03) << stood_s;
    EXPECT_LT(std::abs(wrap_angle(last.X_FR->yaw() - X_WR.yaw())), 0.01) << stood_s;
  }
}

TEST(StandingRobot, KeepsWhatItKnowsByItsWay) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  PlanTracker tracker({}, index.storeys.front(), 0.46);
  const auto pose_at = [](int i) { return Pose::from_xyz_yaw({3.0 + 0.25 * i, 1.0, 0.46}, 0.1); };
  const Pose X_OW = pose_at(0).inverse();
  for (int i = 0; i < 8; ++i) {
    synthetic::HouseScan seen = synthetic::house_scan(house, pose_at(i), X_OW * pose_at(i), 3);
    seen.scan.stamp = i * Nanoseconds{300'000'000};
    if (i == 0)
      tracker.start(seen.scan, seen.planes, index.X_WI.inverse() * pose_at(0));
    else
      static_cast<void>(tracker.update(seen.scan, seen.planes));
  }
  const std::size_t poses = tracker.window().size();
  const Eigen::Matrix3d before = tracker.covariance();
  for (int k = 1; k <= 60; ++k) {
    synthetic::HouseScan seen =
        synthetic::house_scan(house, pose_at(7), drifted(X_OW * pose_at(7), k), static_cast<std::uint64_t>(k));
    seen.scan.stamp = 2'100'000'000 + k * Nanoseconds{1'000'000'000};
    const std::optional<TrackedPose> replaced = tracker.update_standing(seen.scan, seen.planes);
    EXPECT_EQ(replaced.has_value(), k > 1);
    EXPECT_EQ(tracker.window().size(), poses + 1);
    // The same walls seen again do not make the pose better known.
    EXPECT_GT(tracker.covariance()(1, 1), 0.8 * before(1, 1));
  }
  const Pose X_WR = index.X_WI * tracker.window().back().X_IR;
  EXPECT_LT(std::abs(X_WR.t.y() - pose_at(7).t.y()), 0.03);
  EXPECT_LT(std::abs(wrap_angle(X_WR.yaw() - 0.1)), 0.01);
  synthetic::HouseScan seen = synthetic::house_scan(house, pose_at(8), drifted(X_OW * pose_at(8), 60), 70);
  seen.scan.stamp = 63'000'000'000;
  static_cast<void>(tracker.update(seen.scan, seen.planes));
  EXPECT_LE(tracker.window().size(), static_cast<std::size_t>(TrackerConfig{}.window));
}

}  // namespace
}  // namespace plumbline::slam
