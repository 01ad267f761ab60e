// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/method_recorder.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "scenarios/run/as_written.h"

namespace plumbline::scenarios {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

slam::Output answer() {
  slam::Output output;
  output.stamp = 1;
  output.X_FR = Pose();
  slam::Hypothesis hypothesis;
  hypothesis.mass = 1.0;
  hypothesis.walls.push_back({{7}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}});
  output.hypotheses.push_back(hypothesis);
  output.particles.push_back({1.0, 2.0, 0.5, 1.0});
  return output;
}

slam::Estimate last_answer() {
  slam::Estimate estimate;
  estimate.trajectory.push_back({1, Pose()});
  estimate.planes.emplace_back();
  estimate.rooms.emplace_back();
  estimate.rooms.back().polygon_F = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  estimate.floors.emplace_back();
  estimate.map_F.emplace_back(1.0F, 2.0F, 3.0F);
  estimate.loops.emplace().push_back({1, 2, Pose()});
  estimate.segmented.emplace_back();
  estimate.graph = Tree::map().set("error", 0.0);
  return estimate;
}

MethodRecord recorded(const slam::Output& output, const slam::Estimate& estimate) {
  MethodRecorder recorder("mine", true);
  recorder.on_scan(1, [&] { return output; });
  return recorder.finish([&] { return estimate; });
}

TEST(MethodRecorder, WhatIsFiniteIsKept) {
  MethodRecord record = recorded(answer(), last_answer());
  EXPECT_FALSE(record.crashed) << record.error;
  EXPECT_EQ(record.beliefs.size(), 1U);
  EXPECT_FALSE(record.estimate.graph.is_null());
  EXPECT_NO_THROW(round_as_written(record));
}

// Else the record could not be written, and the whole run would end there.
TEST(MethodRecorder, AMethodHasCrashedThatAnswersWhatIsNotFinite) {
  const std::vector<std::function<void(slam::Output&)>> outputs = {
      [](slam::Output& output) { output.X_FR->t.x() = nan; },
      [](slam::Output& output) { output.hypotheses[0].mass = nan; },
      [](slam::Output& output) { output.hypotheses[0].X_WR.t.y() = nan; },
      [](slam::Output& output) { output.hypotheses[0].covariance(1, 2) = nan; },
      [](slam::Output& output) { output.hypotheses[0].walls[0].p1_R.z() = nan; },
      [](slam::Output& output) { output.particles[0].weight = nan; },
      [](slam::Output& output) { output.particles[0].x = 1e307; },  // infinite once it is rounded
  };
  const std::vector<std::function<void(slam::Estimate&)>> estimates = {
      [](slam::Estimate& estimate) { estimate.trajectory[0].X_FR.q.w() = nan; },
      [](slam::Estimate& estimate) { estimate.planes[0].plane_F.d = nan; },
      [](slam::Estimate& estimate) { estimate.planes[0].p1.x() = nan; },
      [](slam::Estimate& estimate) { estimate.rooms[0].center_F.y() = nan; },
      [](slam::Estimate& estimate) { estimate.rooms[0].polygon_F[1].x() = nan; },
      [](slam::Estimate& estimate) { estimate.floors[0].center_F.z() = nan; },
      [](slam::Estimate& estimate) { estimate.map_F[0].y() = std::numeric_limits<float>::infinity(); },
      [](slam::Estimate& estimate) { estimate.loops->front().X_FT.t.x() = nan; },
      [](slam::Estimate& estimate) { estimate.segmented[0].sensor_R.x() = nan; },
      [](slam::Estimate& estimate) { estimate.graph.set("error", nan); },
  };
  for (std::size_t i = 0; i < outputs.size() + estimates.size(); ++i) {
    slam::Output output = answer();
    slam::Estimate estimate = last_answer();
    if (i < outputs.size()) outputs[i](output);
    if (i >= outputs.size()) estimates[i - outputs.size()](estimate);
    MethodRecord record = recorded(output, estimate);
    EXPECT_TRUE(record.crashed) << i;
    EXPECT_FALSE(record.error.empty()) << i;
    EXPECT_EQ(record.beliefs.size(), i < outputs.size() ? 0U : 1U) << i;
    EXPECT_TRUE(record.estimate.planes.empty()) << i;
    EXPECT_NO_THROW(round_as_written(record)) << i;
  }
}

}  // namespace
}  // namespace plumbline::scenarios
