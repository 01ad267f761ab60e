// SPDX-License-Identifier: Apache-2.0
// No estimator can see the truth. This file would not compile if one could.
#include <gtest/gtest.h>

#include <concepts>
#include <type_traits>

#include "scenarios/run/method_runner.h"
#include "scenarios/run/oracle_method.h"
#include "scenarios/run/run_pipeline.h"
#include "slam/io/method.h"

namespace plumbline::scenarios {
namespace {

// A frame of the simulator holds the truth; a frame of sensors does not, under any of its names.
template <class Frame>
concept HasTruth = requires(Frame frame) {
  frame.truth;
}
|| requires(Frame frame) { frame.labels; }
|| requires(Frame frame) { frame.poses; }
|| requires(Frame frame) { frame.robot_digest; }
|| requires(Frame frame) { frame.truth_W; };
static_assert(HasTruth<sim::WorldFrame> && HasTruth<sim::GroundTruth>);
static_assert(!HasTruth<slam::SensorFrame> && !HasTruth<slam::Scan> && !HasTruth<slam::MethodInput>);

// Nor does a frame of sensors hold anything but these five. Another member would break the binding.
template <class Frame>
constexpr bool holds_sensor_records() {
  const auto types = [](Frame frame) {
    auto& [imu, odometry, covariances, packets, scan] = frame;
    return std::bool_constant < std::same_as<decltype(imu), std::vector<slam::Imu>> &&
               std::same_as<decltype(odometry), std::vector<slam::Odometry>> &&
               std::same_as<decltype(covariances), std::vector<slam::OdometryCovariance>> &&
               std::same_as<decltype(packets), std::vector<slam::Vlp16Packet>> && std::same_as < decltype(scan),
           slam::Scan >> {};
  };
  return decltype(types(std::declval<Frame>()))::value;
}
static_assert(holds_sensor_records<slam::SensorFrame>());
static_assert(!std::is_base_of_v<slam::SensorFrame, sim::WorldFrame> &&
              !std::is_convertible_v<sim::WorldFrame, slam::SensorFrame> &&
              !std::is_convertible_v<slam::SensorFrame, sim::WorldFrame>);

// The runner of an estimator takes frames of sensors and nothing else; so does the pipeline that feeds it.
template <class Runner, class Frame>
concept Takes = requires(Runner runner, const Frame& frame) {
  runner.on_frame(frame);
};
static_assert(std::same_as<decltype(&MethodRunner::on_frame), void (MethodRunner::*)(const slam::SensorFrame&)>);
static_assert(Takes<MethodRunner, slam::SensorFrame>);
static_assert(!Takes<MethodRunner, sim::WorldFrame> && !Takes<MethodRunner, sim::GroundTruth>);
static_assert(!std::is_constructible_v<MethodRunner, slam::MethodRow, slam::MethodInput, sim::GroundTruth>);
static_assert(std::same_as<SensorSource, std::function<bool(slam::SensorFrame&)>>);
static_assert(!std::is_invocable_v<SensorSource, sim::WorldFrame&>);

// A method takes the three kinds of record, one at a time.
static_assert(std::same_as<decltype(&slam::Method::on_imu), void (slam::Method::*)(const slam::Imu&)>);
static_assert(std::same_as<decltype(&slam::Method::on_odometry), void (slam::Method::*)(const slam::Odometry&)>);
static_assert(std::same_as<decltype(&slam::Method::on_scan), slam::Output (slam::Method::*)(const slam::Scan&)>);
static_assert(std::same_as<decltype(&slam::Method::finish), slam::Estimate (slam::Method::*)()>);

// The oracle is no estimator: it takes the truth and no sensor.
static_assert(std::same_as<decltype(&OracleMethod::on_truth), void (OracleMethod::*)(const sim::GroundTruth&)>);
static_assert(!std::is_convertible_v<OracleMethod*, MethodRunner*> && !Takes<OracleMethod, slam::SensorFrame>);

TEST(OracleMethod, AnswersTheTruthAtEveryScan) {
  OracleMethod oracle;
  for (int i = 1; i <= 3; ++i) {
    sim::GroundTruth truth;
    truth.poses = {{i * 100 - 50, Pose::from_xyz_yaw({9, 9, 9}, 0)},
                   {i * 100, Pose::from_xyz_yaw({0.01 * i, 1, 0}, 0)}};
    oracle.on_truth(truth);
  }
  const MethodRecord record = oracle.finish();
  EXPECT_EQ(record.name, "truth");
  EXPECT_FALSE(record.crashed) << record.error;
  EXPECT_FALSE(record.localization);
  EXPECT_TRUE(record.times.empty());
  ASSERT_EQ(record.causal.size(), 3U);
  EXPECT_EQ(record.causal.back().stamp, 300);
  EXPECT_EQ(record.causal.back().X_FR.t.x(), 0.03);
}

}  // namespace
}  // namespace plumbline::scenarios
