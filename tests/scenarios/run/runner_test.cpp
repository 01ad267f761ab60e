// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/runner.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/data.h"

namespace plumbline::scenarios {
namespace {

/// A wall that the way leads through stops the robot: the run ends there and says so, as it does after a fall.
TEST(Runner, AStallEndsTheRunAndStandsInItsRecord) {
  ResolvedScenario resolved = resolve(project_file("tests/system/short.yaml"), {});
  const Eigen::Vector2d start_W = resolved.world.start_W;
  resolved.world.waypoints = sim::on_floor({start_W, {8.0, start_W.y()}}, 0.0);
  resolved.world.start_yaw = 0.0;
  resolved.world.duration_s = 60.0;
  RunOptions options;
  options.methods = false;
  const RunRecord record = execute(resolved, options);
  EXPECT_EQ(record.failure.rfind("the robot stalled at ", 0), 0U) << record.failure;
  // What came before the stall counts: 6 s without progress, and the way to the wall at x = 4.95 before them.
  ASSERT_FALSE(record.truth_W.empty());
  EXPECT_GT(slam::seconds(record.truth_W.back().stamp), 6.0);
  EXPECT_LT(slam::seconds(record.truth_W.back().stamp), 30.0);
  EXPECT_LT(record.truth_W.back().X_FR.t.x(), 4.95);
}

}  // namespace
}  // namespace plumbline::scenarios
