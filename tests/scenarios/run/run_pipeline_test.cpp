// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/run_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "bim/digest/digest.h"
#include "bim/digest/float_mode.h"
#include "scenarios/run/digest_log.h"

namespace plumbline::scenarios {
namespace {

constexpr int frames = 60;

/// A source of small frames: 10 odometry and 25 IMU records and a scan each.
SensorSource small_source(int count = frames) {
  return [i = 0, count](slam::SensorFrame& frame) mutable {
    if (i == count) return false;
    ++i;
    frame = slam::SensorFrame{};
    frame.scan.stamp = i * 100'000'000LL;
    for (int k = 9; k >= 0; --k)
      frame.odometry.push_back({frame.scan.stamp - k * 10'000'000LL, Pose::from_xyz_yaw({0.01 * i, 0, 0}, 0)});
    for (int k = 24; k >= 0; --k) frame.imu.emplace_back().stamp = frame.scan.stamp - k * 4'000'000LL;
    return true;
  };
}

/// What a method was given, as digests; optionally slow, or failing at a scan.
struct Probe : slam::Method {
  int fail_at = -1;
  int count = 0;
  slam::Nanoseconds last = 0;
  bool ordered = true;
  Digest digest;

  void see(slam::Nanoseconds stamp) {
    ordered = ordered && stamp >= last;
    last = stamp;
  }
  void on_imu(const slam::Imu& imu) override {
    see(imu.stamp);
    digest.add(imu.stamp);
  }
  void on_odometry(const slam::Odometry& odometry) override {
    see(odometry.stamp);
    digest.add(odometry.stamp).add(odometry.X_OR);
  }
  slam::Output on_scan(const slam::Scan& scan) override {
    see(scan.stamp);
    if (++count == fail_at) throw std::runtime_error("planned failure");
    if (!ordered) throw std::runtime_error("records out of order");
    if (float_mode() != required_float_mode) throw std::runtime_error("wrong floating-point mode");
    slam::Output output;
    output.stamp = scan.stamp;
    output.X_FR = Pose::from_xyz_yaw({0.01 * count, 0, 0}, 0);
    output.digests = {{"seen", digest.value()}};
    output.times = {{"seen", 1.0}};
    return output;
  }
  slam::Estimate finish() override { return {}; }
};

/// So many runners of what `make` gives.
template <class Make>
std::vector<std::unique_ptr<MethodRunner>> runners(Make make, int count = 1, bool needs_plan = false) {
  slam::MethodRow row;
  row.name = "method";
  row.needs_plan = needs_plan;
  row.make = [make](const slam::MethodInput&) { return make(); };
  std::vector<std::unique_ptr<MethodRunner>> runners;
  for (int i = 0; i < count; ++i) runners.push_back(std::make_unique<MethodRunner>(row, slam::MethodInput{}));
  return runners;
}

std::unique_ptr<MethodRunner> probe(std::string_view name, int fail_at = -1) {
  slam::MethodRow row;
  row.name = name;
  row.make = [fail_at](const slam::MethodInput&) {
    auto method = std::make_unique<Probe>();
    method->fail_at = fail_at;
    return method;
  };
  return std::make_unique<MethodRunner>(row, slam::MethodInput{});
}

std::vector<std::unique_ptr<MethodRunner>> two() {
  std::vector<std::unique_ptr<MethodRunner>> methods;
  methods.push_back(probe("a"));
  methods.push_back(probe("b"));
  return methods;
}

DigestLog joined(const std::vector<MethodRecord>& records) {
  std::vector<DigestLog> logs;
  for (const MethodRecord& record : records) logs.push_back(record.digests);
  return merge_logs(logs);
}

TEST(Pipeline, ThreadsChangeNothing) {
  const auto alone = run_pipeline(small_source(), two(), {.threads = 1});
  for (const int threads : {2, 3, 8}) {
    const auto together = run_pipeline(small_source(), two(), {.threads = threads, .frames_ahead = 2});
    EXPECT_FALSE(first_difference(joined(alone), joined(together))) << threads;
    ASSERT_EQ(together.size(), 2U);
    for (const MethodRecord& record : together) EXPECT_FALSE(record.crashed) << record.error;
    EXPECT_EQ(together[0].causal.size(), static_cast<std::size_t>(frames));
  }
  EXPECT_EQ(alone[0].name, "a");
  EXPECT_EQ(alone[1].name, "b");
}

TEST(Pipeline, WhatAMethodDoesAfterTheRunIsTimed) {
  const auto records = run_pipeline(small_source(), two(), {.threads = 1});
  ASSERT_EQ(records[0].times.size(), 2U);
  EXPECT_EQ(records[0].times[0].cpu_ms.size(), static_cast<std::size_t>(frames));
  EXPECT_EQ(records[0].times[1].stage, "finish");
  EXPECT_EQ(records[0].times[1].cpu_ms.size(), 1U);
}

/// A plan localization that names a wall with every other scan and settles at scan 26, which is one of them.
struct WallNamer : slam::Method {
  int count = 0;
  slam::Output on_scan(const slam::Scan& scan) override {
    ++count;
    slam::Output output;
    output.stamp = scan.stamp;
    output.state = count < 26 ? slam::State::ambiguous : slam::State::converged;
    output.hypotheses.resize(1);
    if (count % 2 == 0) output.hypotheses.front().walls.emplace_back().faces = {count};
    return output;
  }
  slam::Estimate finish() override { return {}; }
};

TEST(Pipeline, MatchedWallsAreKeptOnceASecondAndWhereTheStateChanges) {
  const auto records =
      run_pipeline(small_source(), runners([] { return std::make_unique<WallNamer>(); }, 1, true), {.threads = 1});
  ASSERT_FALSE(records[0].crashed) << records[0].error;
  std::vector<int> kept;  // scans, of 0.1 s each
  for (const BeliefRecord& belief : records[0].beliefs)
    for (const slam::WallMatch& match : belief.hypotheses.front().walls) kept.push_back(match.faces.front());
  EXPECT_EQ(kept, (std::vector<int>{10, 20, 26, 36, 46, 56}));
}

TEST(Pipeline, AMethodThatThrowsCrashesAlone) {
  for (const int threads : {1, 4}) {
    std::vector<std::unique_ptr<MethodRunner>> methods;
    methods.push_back(probe("bad", 7));
    methods.push_back(probe("good"));
    const auto records = run_pipeline(small_source(), std::move(methods), {.threads = threads});
    EXPECT_TRUE(records[0].crashed);
    EXPECT_EQ(records[0].error, "planned failure");
    EXPECT_EQ(records[0].causal.size(), 6U);
    EXPECT_FALSE(records[1].crashed);
    EXPECT_EQ(records[1].causal.size(), static_cast<std::size_t>(frames));
  }
}

TEST(Pipeline, AMethodWhosePosesCannotBeReadBackCrashes) {
  struct Wild : Probe {
    Pose X;
    bool at_the_end = false;
    slam::Output on_scan(const slam::Scan& scan) override {
      slam::Output output = Probe::on_scan(scan);
      if (count == 7 && !at_the_end) output.X_FR = X;
      return output;
    }
    slam::Estimate finish() override {
      slam::Estimate estimate;
      if (at_the_end) estimate.trajectory = {{0, X}};
      return estimate;
    }
  };
  const Pose far = Pose::from_xyz_yaw({2e8, 0, 0}, 0);
  Pose stretched, unknown;
  stretched.q.coeffs() *= 1.1;
  unknown.t.y() = std::nan("");
  for (const Pose& X : {far, stretched, unknown})
    for (const bool at_the_end : {false, true}) {
      const auto make = [&] {
        auto method = std::make_unique<Wild>();
        method->X = X;
        method->at_the_end = at_the_end;
        return method;
      };
      const auto records = run_pipeline(small_source(), runners(make), {.threads = 1});
      EXPECT_TRUE(records[0].crashed);
      EXPECT_NE(records[0].error.find("an invalid pose"), std::string::npos) << records[0].error;
      EXPECT_EQ(records[0].causal.size(), at_the_end ? static_cast<std::size_t>(frames) : 6U);
      EXPECT_TRUE(records[0].estimate.trajectory.empty());
    }
}

TEST(Pipeline, AMethodThatCannotStartCrashes) {
  const auto make = []() -> std::unique_ptr<slam::Method> { throw std::runtime_error("no plan"); };
  const auto records = run_pipeline(small_source(), runners(make), {.threads = 2});
  EXPECT_TRUE(records[0].crashed);
  EXPECT_EQ(records[0].error, "no plan");
}

TEST(Pipeline, WhatTheSourceThrowsArrives) {
  for (const int threads : {1, 4}) {
    int given = 0;
    const SensorSource failing = [&, source = small_source()](slam::SensorFrame& frame) mutable {
      if (++given == 5) throw std::runtime_error("disk");
      return source(frame);
    };
    EXPECT_THROW(static_cast<void>(run_pipeline(failing, two(), {.threads = threads})), std::runtime_error);
  }
}

/// With the standard library's semaphore a run once stood still for ever: all threads waited though permits were free.
TEST(Pipeline, ManyShortFramesComeThrough) {
  constexpr int many = 20000;
  std::atomic<int> seen = 0;
  struct Counter : slam::Method {
    std::atomic<int>* seen = nullptr;
    slam::Output on_scan(const slam::Scan& scan) override {
      ++*seen;
      slam::Output output;
      output.stamp = scan.stamp;
      return output;
    }
    slam::Estimate finish() override { return {}; }
  };
  const auto make = [&] {
    auto method = std::make_unique<Counter>();
    method->seen = &seen;
    return method;
  };
  (void)run_pipeline(small_source(many), runners(make, 5), {.threads = 2});
  EXPECT_EQ(seen, 5 * many);
}

TEST(Pipeline, NoMoreWorkAtOneTimeThanAllowed) {
  std::atomic<int> working = 0;
  std::atomic<int> most = 0;
  struct Counting : Probe {
    std::atomic<int>* working = nullptr;
    std::atomic<int>* most = nullptr;
    slam::Output on_scan(const slam::Scan& scan) override {
      const int now = ++*working;
      for (int seen = *most; now > seen && !most->compare_exchange_weak(seen, now);) continue;
      std::this_thread::yield();
      --*working;
      return Probe::on_scan(scan);
    }
  };
  const auto make = [&] {
    auto method = std::make_unique<Counting>();
    method->working = &working;
    method->most = &most;
    return method;
  };
  static_cast<void>(run_pipeline(small_source(), runners(make, 6), {.threads = 2}));
  EXPECT_LE(most, 2);
}

TEST(MethodRunner, ParticlesAreKeptAtChangesAndEverySecond) {
  struct Localizer : slam::Method {
    int count = 0;
    slam::Output on_scan(const slam::Scan& scan) override {
      slam::Output output;
      output.stamp = scan.stamp;
      output.state = ++count >= 30 ? slam::State::converged : slam::State::searching;
      output.particles = {{1, 2, 3, 1}};
      return output;
    }
    slam::Estimate finish() override { return {}; }
  };
  const auto records =
      run_pipeline(small_source(40), runners([] { return std::make_unique<Localizer>(); }, 1, true), {});
  ASSERT_EQ(records[0].beliefs.size(), 40U);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < 40; ++i)
    if (!records[0].beliefs[i].particles.empty()) kept.push_back(i);
  EXPECT_EQ(kept, (std::vector<std::size_t>{0, 10, 20, 29, 39}));
}

}  // namespace
}  // namespace plumbline::scenarios
