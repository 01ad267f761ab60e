// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/injected_faults.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace plumbline::scenarios {
namespace {

Scenario with_faults(const std::string& more) {
  return read_scenario("scenario: 1\nname: a\nbuilding: b.plan.yaml\nstart: {room: r}\nroute: {rooms: [s]}\n" + more,
                       "s.yaml")
      .scenario;
}

bool says(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

TEST(InjectedFaults, AreSaidInWordsAndSizes) {
  EXPECT_TRUE(injected_faults(with_faults("")).empty());
  const std::vector<std::string> all = injected_faults(
      with_faults("faults: {slip_mps: 1, clock_offset_s: -0.08, mount_error_deg: 2, mount_offset_m: [0.1, 0, 0]}\n"
                  "lidar: {airborne_per_m: 0.02}\npushes: {max_n: 100, every_s: 4}\n"));
  EXPECT_EQ(all, (std::vector<std::string>{"the feet slip at 1 m/s, for 0.2 s in every 10 s",
                                           "stamps of odometry and IMU are 0.08 s early",
                                           "methods are told a mount of the LiDAR that is off by [0.1, 0, 0] m",
                                           "methods are told a mount of the LiDAR that is off by 2°",
                                           "dust or rain gives 2 % of the beams back in each metre",
                                           "the robot is pushed with up to 100 N every 4 s"}));
}

TEST(InjectedFaults, OfAPresetHaveItsSizes) {
  const std::vector<std::string> all =
      injected_faults(with_faults("faults: {preset: harsh, slip_mps: 0}\nground: {friction: 0.4}\n"));
  EXPECT_TRUE(says(all, "stamps of odometry and IMU are 0.01 s late"));
  EXPECT_TRUE(says(all, "methods are told a mount of the LiDAR that is off by 0.5°"));
  EXPECT_TRUE(says(all, "the IMU's scale is off by 0.3 %"));
  EXPECT_TRUE(says(all, "the ground's friction is 0.4"));
  EXPECT_TRUE(std::none_of(all.begin(), all.end(), [](const std::string& one) { return one.starts_with("the feet"); }));
}

TEST(InjectedFaults, OfOneClockAreSaidByItsName) {
  using Said = std::vector<std::string>;
  EXPECT_EQ(injected_faults(with_faults("faults: {clock_jitter_s: 0.005}\n")),
            Said{"stamps of odometry and IMU jitter by 0.005 s"});
  EXPECT_EQ(injected_faults(with_faults("faults: {clock_offset_s: 0.1, clock_jitter_s: 0.005}\n")),
            (Said{"stamps of odometry and IMU are 0.1 s late", "these stamps jitter by 0.005 s"}));
}

TEST(InjectedFaults, TheSlipBeforeAMomentIsFound) {
  const Scenario scenario = with_faults("faults: {slip_mps: 1}\n");
  double t_s = 0.0;
  while (t_s < 10.0 && !slip_before(scenario, t_s)) t_s += 0.1;
  ASSERT_LT(t_s, 10.0);
  const SlipEpisode slip = *slip_before(scenario, t_s);
  EXPECT_NEAR(slip.to_s - slip.from_s, 0.2, 1e-9);
  EXPECT_GT(slip.from_s, t_s - 0.1 - 1e-9);  // in the middle third of the first 10 s
  EXPECT_GE(slip.from_s, 10.0 / 3.0);
  EXPECT_LE(slip.to_s, 20.0 / 3.0 + 0.2);
  EXPECT_NEAR(slip_before(scenario, slip.to_s + 2.9).value().from_s, slip.from_s, 1e-9);
  EXPECT_FALSE(slip_before(scenario, slip.to_s + 3.1));
  EXPECT_FALSE(slip_before(with_faults(""), slip.from_s));
}

}  // namespace
}  // namespace plumbline::scenarios
