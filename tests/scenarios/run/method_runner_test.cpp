// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/method_runner.h"

#include <gtest/gtest.h>

#include "bim/errors.h"
#include "scenarios/run/estimate_file.h"

namespace plumbline::scenarios {
namespace {

/// Counts what it is given; lost after every third scan.
struct Counter : slam::Method {
  struct Seen {
    int imu = 0, odometry = 0, scans = 0;
    bool has_odometry = true;
  };
  Seen& seen;
  explicit Counter(Seen& to) : seen(to) {}
  void on_imu(const slam::Imu&) override { ++seen.imu; }
  void on_odometry(const slam::Odometry&) override { ++seen.odometry; }
  slam::Output on_scan(const slam::Scan& scan) override {
    ++seen.scans;
    slam::Output output;
    output.stamp = scan.stamp;
    output.X_FR = Pose();
    if (seen.scans % 3 == 0) output.state = slam::State::lost;
    return output;
  }
  slam::Estimate finish() override { return {}; }
};

MethodRecord run(Sensors sensors, Counter::Seen& seen) {
  slam::MethodRow row;
  row.name = "counter";
  row.make = [&seen](const slam::MethodInput& input) {
    seen.has_odometry = input.has_odometry;
    return std::make_unique<Counter>(seen);
  };
  MethodRunner runner(row, {}, sensors);
  for (int i = 1; i <= 7; ++i) {
    slam::SensorFrame frame;
    frame.scan.stamp = i * 100'000'000LL;
    frame.odometry.resize(2);
    frame.imu.resize(5);
    runner.on_frame(frame);
  }
  return runner.finish();
}

TEST(MethodRunner, WithLidarAloneAMethodGetsScansAndNothingElse) {
  Counter::Seen all, lidar;
  const MethodRecord with_all = run(Sensors::all, all), alone = run(Sensors::lidar, lidar);
  EXPECT_EQ(all.imu, 35);
  EXPECT_EQ(all.odometry, 14);
  EXPECT_TRUE(all.has_odometry);
  EXPECT_EQ(lidar.imu, 0);
  EXPECT_EQ(lidar.odometry, 0);
  EXPECT_FALSE(lidar.has_odometry);
  EXPECT_EQ(lidar.scans, 7);
  EXPECT_EQ(with_all.name, "counter");
  EXPECT_EQ(alone.name, "counter.lidar");
  EXPECT_EQ(alone.digests.back().stage, "counter.lidar/estimate");
}

TEST(MethodRunner, ItsRecordCountsScansAndThoseAfterWhichItWasLost) {
  Counter::Seen seen;
  const MethodRecord record = run(Sensors::all, seen);
  EXPECT_EQ(record.scans, 7);
  EXPECT_EQ(record.lost_scans, 2);
  ASSERT_EQ(record.lost.size(), 2U);
  EXPECT_EQ(record.lost.front().from, 300'000'000);
  EXPECT_EQ(record.lost.front().to, 300'000'000);
  MethodRecord read;
  read_estimate(write_estimate(record), "counter.estimate.json", read);
  EXPECT_EQ(read.scans, 7);
  EXPECT_EQ(read.lost_scans, 2);
  ASSERT_EQ(read.lost.size(), 2U);
  EXPECT_EQ(read.lost.back().from, 600'000'000);
  EXPECT_EQ(read.lost.back().to, 600'000'000);
}

TEST(MethodRecorder, ScansInARowAfterWhichAMethodIsLostAreOneSpan) {
  MethodRecorder recorder("sleeper", false);
  for (int i = 1; i <= 9; ++i) {
    slam::Output output;
    output.stamp = i * 100LL;
    output.state = (i >= 3 && i <= 5) || i >= 8 ? slam::State::lost : slam::State::converged;
    recorder.on_scan(output.stamp, [&] { return output; });
  }
  const MethodRecord record = recorder.finish([] { return slam::Estimate(); });
  EXPECT_EQ(record.lost_scans, 5);
  ASSERT_EQ(record.lost.size(), 2U);
  EXPECT_EQ(record.lost[0].from, 300);
  EXPECT_EQ(record.lost[0].to, 500);
  EXPECT_EQ(record.lost[1].from, 800);
  EXPECT_EQ(record.lost[1].to, 900);
}

TEST(EstimateFile, TimesOfBeingLostThatAreOutOfOrderAreRefused) {
  MethodRecord record;
  record.name = "sleeper";
  record.scans = 9;
  MethodRecord read;
  record.lost = {{300, 500}, {800, 900}};
  read_estimate(write_estimate(record), "sleeper.estimate.json", read);
  record.lost = {{800, 900}, {300, 500}};
  EXPECT_THROW(read_estimate(write_estimate(record), "sleeper.estimate.json", read), InputError);
  record.lost = {{500, 300}};
  EXPECT_THROW(read_estimate(write_estimate(record), "sleeper.estimate.json", read), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios
