// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/wall_lines.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

PlanSegment face(double from, double length) {
  PlanSegment segment;
  segment.plan_face = 0;
  segment.a = {from, 0.0};
  segment.length = length;
  segment.z0 = 0.0;
  segment.z1 = 2.6;
  return segment;
}

TEST(WallLines, KnowDoorsAndHighWindowsOfAllTheirFaces) {
  std::vector<PlanSegment> segments = {face(4.0, 3.0), face(0.0, 3.9)};
  segments[0].holes = {{0.5, 1.5, 0.0, 2.1}};                        // a door
  segments[1].holes = {{1.0, 3.0, 0.1, 2.5}, {3.2, 3.6, 0.9, 2.1}};  // glass from floor to ceiling, a window
  const std::vector<WallLine> lines = merge_wall_lines(segments, 1.0, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].a, Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(lines[0].length, 7.0);
  const std::vector<Eigen::Vector2d> openings = {{1.0, 3.0}, {4.5, 5.5}};
  EXPECT_EQ(lines[0].openings, openings);
}

}  // namespace
}  // namespace plumbline::slam
