// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/localized.h"

namespace plumbline::slam {
namespace {

constexpr Nanoseconds second = 1'000'000'000;

/// To and fro in a room of 6 x 4 m.
synthetic::Recording walk_in(const synthetic::House& house, double seconds) {
  synthetic::WalkConfig config;
  config.duration_s = seconds;
  std::vector<Eigen::Vector2d> way;
  for (int i = 0; i < 5; ++i)
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(1.2, 1.2), Eigen::Vector2d(4.6, 1.6), Eigen::Vector2d(3.0, 2.8)})
      way.push_back(p);
  return synthetic::walk(house, way, config);
}

/// Nothing is received for so long after `from`, and nothing moves.
synthetic::Recording silenced(synthetic::Recording recording, Nanoseconds from, Nanoseconds silent) {
  const auto shift = [&](Nanoseconds& stamp) { stamp += stamp > from ? silent : 0; };
  for (Odometry& odometry : recording.odometry) shift(odometry.stamp);
  for (Scan& scan : recording.scans) shift(scan.stamp);
  for (StampedPose& pose : recording.truth) shift(pose.stamp);
  return recording;
}

/// The first recording, then the second one on another storey: the lift takes 10 s, and odometry goes on from where it
/// was.
synthetic::Recording by_lift(synthetic::Recording first, const synthetic::Recording& second_one, double rise_m) {
  const Nanoseconds at = first.scans.back().stamp + 10 * second;
  const Pose X = first.odometry.back().X_OR * second_one.odometry.front().X_OR.inverse();
  for (Odometry odometry : second_one.odometry) first.odometry.push_back({odometry.stamp + at, X * odometry.X_OR});
  for (Scan scan : second_one.scans) {
    scan.stamp += at;
    first.scans.push_back(std::move(scan));
  }
  for (StampedPose pose : second_one.truth) {
    pose.X_FR.t.z() += rise_m;
    first.truth.push_back({pose.stamp + at, pose.X_FR});
  }
  return first;
}

bim::Plan on_top(bim::Plan below, const bim::Plan& above, double rise_m) {
  const bim::Plan raised = synthetic::moved(above, Pose::from_xyz_yaw({0.0, 0.0, rise_m}, 0.0));
  below.storeys.push_back(raised.storeys.front());
  below.storeys.back().name = "upper";
  for (bim::PlanFace face : raised.faces) {
    face.id = static_cast<int>(below.faces.size());
    face.wall_id = "u" + face.wall_id;
    face.storey = 1;
    below.faces.push_back(face);
  }
  for (bim::PlanRoom room : raised.rooms) {
    room.id = static_cast<int>(below.rooms.size());
    room.name = "u" + room.name;
    room.storey = 1;
    below.rooms.push_back(room);
  }
  return below;
}

// A bare room is its own image, turned by 180 degrees: only the heading of the start tells them apart.
TEST(CarriedRobot, IsNotSureAfterALongSilenceWhereAnotherPoseFits) {
  const synthetic::House house = synthetic::one_room();
  for (const Nanoseconds silent : {2 * second, 8 * second}) {
    const synthetic::Recording recording = silenced(walk_in(house, 12.0), 8 * second, silent);
    const Answers result = run(recording, input_for(recording, synthetic::plan_of(house), true));
    bool converged_before = false, converged_after = false;
    for (const Output& output : result.outputs) {
      const bool converged = output.state == State::converged;
      (output.stamp <= 8 * second ? converged_before : converged_after) |= converged;
    }
    EXPECT_TRUE(converged_before);
    EXPECT_EQ(converged_after, silent < 5 * second) << "nobody carries a robot in two seconds";
  }
}

TEST(CarriedRobot, IsStillSureWhereNoOtherPoseFits) {
  synthetic::House house = synthetic::one_room();
  house.boxes.push_back({{5.2, 3.0, 0.0}, {6.0, 4.0, 2.5}});
  const synthetic::Recording recording = silenced(walk_in(house, 12.0), 8 * second, 8 * second);
  const Answers result = run(recording, input_for(recording, synthetic::plan_of(house), true));
  for (const Output& output : result.outputs)
    if (output.stamp > 7 * second) {
      EXPECT_EQ(output.state, State::converged) << seconds(output.stamp);
    }
}

// On equal storeys it would otherwise never be found again. It is lost since its odometry leads elsewhere; it does not
// stop.
TEST(CarriedRobot, IsFoundOnItsStoreyWhereItNeverStood) {
  constexpr double rise_m = 3.0;
  const synthetic::House house = synthetic::corridor_house();
  synthetic::WalkConfig config;
  config.duration_s = 30.0;
  const synthetic::Recording recording =
      kidnapped(synthetic::walk(house, synthetic::corridor_house_walk(), config), 6 * second, 20 * second);
  MethodInput input = input_for(recording, on_top(synthetic::plan_of(house), synthetic::plan_of(house), rise_m), true);
  input.prior.storey = "ground";
  const Answers result = run(recording, input);
  const bool lost = std::any_of(result.outputs.begin(), result.outputs.end(),
                                [](const Output& output) { return output.state == State::lost; });
  EXPECT_TRUE(lost);
  const Output& last = result.outputs.back();
  EXPECT_EQ(last.state, State::converged);
  ASSERT_TRUE(last.X_FR.has_value());
  EXPECT_LT((last.X_FR->t - recording.truth.back().X_FR.t).norm(), 0.1);
}

TEST(CarriedRobot, IsFoundOnAnotherStoreyThanItsStart) {
  constexpr double rise_m = 3.0;
  const synthetic::House ground = synthetic::one_room();
  const synthetic::House upper = synthetic::corridor_house();
  synthetic::WalkConfig config;
  config.duration_s = 20.0;
  const synthetic::Recording above = synthetic::walk(upper, synthetic::corridor_house_walk(), config);
  const synthetic::Recording recording = by_lift(walk_in(ground, 8.0), above, rise_m);
  MethodInput input = input_for(recording, on_top(synthetic::plan_of(ground), synthetic::plan_of(upper), rise_m), true);
  input.prior.storey = "ground";
  const Answers result = run(recording, input);
  const Output& last = result.outputs.back();
  EXPECT_EQ(last.state, State::converged);
  ASSERT_TRUE(last.X_FR.has_value());
  EXPECT_LT((last.X_FR->t - recording.truth.back().X_FR.t).norm(), 0.1);
}

}  // namespace
}  // namespace plumbline::slam
