// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/localization/pipeline.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

struct Walked {
  synthetic::Recording recording;
  std::vector<Output> outputs;

  [[nodiscard]] double error_m(std::size_t i, const Pose& X_WR) const {
    return (X_WR.t - recording.truth[i].X_FR.t).norm();
  }
};

Walked localize(synthetic::Recording recording, const synthetic::House& house, bool has_odometry, bool yaw_known) {
  MethodInput input;
  input.seed = 17;
  input.calibration = recording.calibration;
  input.plan = std::make_shared<bim::Plan>(synthetic::plan_of(house));
  input.has_odometry = has_odometry;
  if (yaw_known) input.prior.yaw_W = recording.truth.front().X_FR.yaw();
  const std::unique_ptr<Method> method = make_s_graph_localization(input);
  Walked walked;
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    while (has_odometry && next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp)
      method->on_odometry(recording.odometry[next++]);
    walked.outputs.push_back(method->on_scan(scan));
  }
  walked.recording = std::move(recording);
  return walked;
}

// Scan matching holds a robot that sees nothing where it was last seen, or lets it go on as before.
TEST(Relocalization, ALidarAloneIsNotSureAfterAWayThatNothingMeasured) {
  for (const double blank_s : {1.5, 5.0}) {
    synthetic::WalkConfig config;
    config.duration_s = 13.0 + blank_s;
    const synthetic::House house = synthetic::corridor_house();
    synthetic::Recording recording = synthetic::walk(house, synthetic::corridor_house_walk(), config);
    const double from_s = 6.0;
    for (Scan& scan : recording.scans) {
      const double t = seconds(scan.stamp);
      if (t > from_s && t < from_s + blank_s) std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0);
    }
    const Walked walked = localize(std::move(recording), house, false, false);
    bool converged_before = false, converged_after = false, lost = false;
    int wrong = 0;
    for (std::size_t i = 0; i < walked.outputs.size(); ++i) {
      const Output& output = walked.outputs[i];
      lost = lost || output.state == State::lost;
      if (output.state != State::converged) continue;
      (seconds(output.stamp) < from_s ? converged_before : converged_after) = true;
      if (walked.error_m(i, *output.X_FR) > 0.5) ++wrong;
    }
    EXPECT_TRUE(converged_before);
    EXPECT_TRUE(converged_after) << blank_s << " s";
    EXPECT_TRUE(lost || blank_s < 2.0) << blank_s << " s";
    EXPECT_EQ(wrong, 0) << blank_s << " s";
  }
}

// All but every 23rd return are cut short, so that nothing contradicts the pose but that nothing confirms it.
TEST(Relocalization, ScansOfWhichHardlyABeamMeetsItsFaceTakeAConvergenceBack) {
  synthetic::WalkConfig config;
  config.duration_s = 22.0;
  const synthetic::House house = synthetic::corridor_house();
  synthetic::Recording recording = synthetic::walk(house, synthetic::corridor_house_walk(), config);
  const double from_s = 6.0, share = 0.4;
  constexpr std::size_t kept = 23;
  for (Scan& scan : recording.scans) {
    if (seconds(scan.stamp) < from_s) continue;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (i % kept == 0) continue;
      scan.range_m[i] *= share;
      scan.point_L[i] *= share;
    }
  }
  const Walked walked = localize(std::move(recording), house, true, false);
  std::optional<double> lost_m;
  double m = 0.0;
  bool converged = false;
  for (std::size_t i = 1; i < walked.outputs.size() && !lost_m; ++i) {
    const double t = seconds(walked.outputs[i].stamp);
    converged = converged || (t < from_s && walked.outputs[i].state == State::converged);
    if (t >= from_s) m += (walked.recording.truth[i].X_FR.t - walked.recording.truth[i - 1].X_FR.t).norm();
    if (walked.outputs[i].state == State::lost) lost_m = m;
  }
  EXPECT_TRUE(converged);
  ASSERT_TRUE(lost_m.has_value());
  // Measured: 4.1 m, of 24 scans 0.2 m apart that each count half; 7.6 m where twice as many are needed.
  EXPECT_GT(*lost_m, 3.0);
  EXPECT_LT(*lost_m, 5.5);
}

/// A walk of which a part is seen in another house, which contradicts the plan.
synthetic::Recording walk_with_strange_scans(const synthetic::House& house, const synthetic::House& other,
                                             double from_s, double to_s) {
  synthetic::WalkConfig config;
  config.seed = 6;
  const std::vector<Eigen::Vector2d> way = {{1.0, 1.0}, {4.0, 1.0}, {4.0, 3.0}, {1.0, 3.0},
                                            {1.2, 1.0}, {4.0, 1.2}, {3.8, 3.0}, {1.0, 2.8}};
  synthetic::Recording recording = synthetic::walk(house, way, config);
  const synthetic::Recording strange = synthetic::walk(other, way, config);
  for (std::size_t i = 0; i < recording.scans.size(); ++i)
    if (seconds(recording.scans[i].stamp) > from_s && seconds(recording.scans[i].stamp) < to_s)
      recording.scans[i] = strange.scans[i];
  return recording;
}

// Odometry of the footprint, as base_footprint of many robots.
TEST(Relocalization, ARobotWhoseFrameLiesOnTheFloorStaysOnIt) {
  synthetic::WalkConfig config;
  config.duration_s = 20.0;
  const synthetic::House house = synthetic::corridor_house();
  synthetic::Recording recording = synthetic::walk(house, synthetic::corridor_house_walk(), config);
  const double standing_m = recording.calibration.sensor_height_m - recording.calibration.X_RL.t.z();
  const Pose X_RF{Eigen::Quaterniond::Identity(), -standing_m * Eigen::Vector3d::UnitZ()};
  recording.calibration.X_RL = X_RF.inverse() * recording.calibration.X_RL;
  for (Odometry& odometry : recording.odometry) odometry.X_OR = odometry.X_OR * X_RF;
  for (StampedPose& pose : recording.truth) pose.X_FR = pose.X_FR * X_RF;
  const Walked walked = localize(std::move(recording), house, true, false);
  int converged = 0;
  for (std::size_t i = 0; i < walked.outputs.size(); ++i) {
    if (walked.outputs[i].state != State::converged) continue;
    ++converged;
    EXPECT_LT(walked.error_m(i, *walked.outputs[i].X_FR), 0.1) << i;
  }
  EXPECT_GT(converged, 100);
}

// A recording need not say how high the LiDAR is.
TEST(Relocalization, AWrongHeightOfTheLidarHidesNoContradiction) {
  const synthetic::House house = synthetic::one_room(5.0, 4.0);
  synthetic::Recording recording = walk_with_strange_scans(house, synthetic::one_room(8.0, 7.0), 8.0, 14.0);
  recording.calibration.sensor_height_m += 0.8;
  const Walked walked = localize(std::move(recording), house, true, true);
  bool converged = false, lost = false;
  for (const Output& output : walked.outputs) {
    converged = converged || (output.state == State::converged && seconds(output.stamp) < 8.0);
    lost = lost || output.state == State::lost;
  }
  EXPECT_TRUE(converged);
  EXPECT_TRUE(lost);
}

// A clock that counts from when a computer was started.
TEST(Relocalization, ALateClockLeavesTheHeadingKnown) {
  const synthetic::House house = synthetic::one_room(5.0, 4.0);
  synthetic::Recording recording = walk_with_strange_scans(house, house, 0.0, 0.0);
  constexpr Nanoseconds late = 3'600'000'000'000;
  for (Scan& scan : recording.scans) scan.stamp += late;
  for (Odometry& odometry : recording.odometry) odometry.stamp += late;
  const Walked walked = localize(std::move(recording), house, true, true);
  EXPECT_TRUE(std::any_of(walked.outputs.begin(), walked.outputs.end(),
                          [](const Output& output) { return output.state == State::converged; }));
  EXPECT_LT(walked.error_m(walked.outputs.size() - 1, *walked.outputs.back().X_FR), 0.1);
}

// A room of two proper turns: without the heading either is as likely.
TEST(Relocalization, AKnownHeadingLeadsAfterTheRobotWasLost) {
  const synthetic::House house = synthetic::one_room(5.0, 4.0);
  const Walked walked =
      localize(walk_with_strange_scans(house, synthetic::one_room(8.0, 7.0), 8.0, 14.0), house, true, true);
  bool converged = false, lost = false;
  for (std::size_t i = 0; i < walked.outputs.size(); ++i) {
    const Output& output = walked.outputs[i];
    converged = converged || output.state == State::converged;
    lost = lost || output.state == State::lost;
    if (output.state == State::converged && seconds(output.stamp) < 8.0) {
      EXPECT_LT(walked.error_m(i, *output.X_FR), 0.1);
    }
    // It may have been turned.
    if (seconds(output.stamp) > 14.0) {
      EXPECT_NE(output.state, State::converged);
    }
  }
  EXPECT_TRUE(converged);
  ASSERT_TRUE(lost);
  const std::vector<Hypothesis>& last = walked.outputs.back().hypotheses;
  ASSERT_GE(last.size(), 2U);
  EXPECT_LT(walked.error_m(walked.outputs.size() - 1, last.front().X_WR), 0.1);
  EXPECT_GT(last.front().mass, 0.9);
  EXPECT_LT(last.front().mass, 0.99);
  // The other turn, and what the strange scans supported.
  for (std::size_t i = 1; i < last.size(); ++i) EXPECT_LT(last[i].mass, 0.05);
}

}  // namespace
}  // namespace plumbline::slam
