// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/segment_grid.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/random/stream.h"
#include "slam/plan_map/plan_index.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

PlanSegment random_segment(const Stream& stream, std::uint32_t lane) {
  PlanSegment segment;
  segment.a = {20.0 * stream.uniform(0, lane, 0), 12.0 * stream.uniform(0, lane, 1)};
  const double angle = 2.0 * std::numbers::pi * stream.uniform(0, lane, 2);
  segment.e = {std::cos(angle), std::sin(angle)};
  segment.n = {-segment.e.y(), segment.e.x()};
  segment.length = 0.2 + 5.0 * stream.uniform(0, lane, 3);
  segment.holes.push_back({0.3 * segment.length, 0.6 * segment.length, 0.0, 2.1});
  return segment;
}

std::vector<PlanSegment> random_segments(const Stream& stream) {
  std::vector<PlanSegment> segments;
  for (std::uint32_t i = 0; i < 40; ++i) segments.push_back(random_segment(stream, i));
  return segments;
}

/// Solves for the crossing with every segment, without a grid.
double brute_force(const std::vector<PlanSegment>& segments, const PlanRay& ray, double most) {
  double best = most;
  for (const PlanSegment& segment : segments) {
    Eigen::Matrix2d A;
    A << ray.direction, -segment.e;
    const Eigen::Vector2d ts = A.inverse() * (segment.a - ray.origin);
    const double z = ray.z + ts.x() * ray.slope;
    const bim::FaceHole& hole = segment.holes.front();
    const bool open = ts.y() > hole.s0 && ts.y() < hole.s1 && z > hole.z0 && z < hole.z1;
    const bool on_face = ts.y() >= 0.0 && ts.y() <= segment.length && z >= segment.z0 && z <= segment.z1;
    if (ts.x() > 0.0 && on_face && !open) best = std::min(best, ts.x());
  }
  return best;
}

TEST(SegmentGrid, FindsTheFirstHitOfRandomRays) {
  const Stream stream(3, "slam.localize.init");
  const std::vector<PlanSegment> segments = random_segments(stream);
  const SegmentGrid grid(segments, 0.5);
  int hits = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    // Also from outside of the grid.
    const double angle = 2.0 * std::numbers::pi * stream.uniform(1, i, 2);
    const PlanRay ray{{26.0 * stream.uniform(1, i, 0) - 3.0, 18.0 * stream.uniform(1, i, 1) - 3.0},
                      {std::cos(angle), std::sin(angle)},
                      0.3 + 2.0 * stream.uniform(1, i, 3),
                      0.4 * (stream.uniform(1, i, 4) - 0.5)};
    const PlanHit hit = grid.cast(segments, ray, 15.0);
    ASSERT_NEAR(hit.distance, brute_force(segments, ray, 15.0), 1e-9) << "ray " << i;
    hits += hit.segment >= 0 ? 1 : 0;
  }
  EXPECT_GT(hits, 1000);
}

TEST(SegmentGrid, NothingStandsWithinTheClearance) {
  const Stream stream(3, "slam.localize.init");
  const std::vector<PlanSegment> segments = random_segments(stream);
  const SegmentGrid grid(segments, 0.5);
  int wide = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const Eigen::Vector2d p(20.0 * stream.uniform(1, i, 0), 12.0 * stream.uniform(1, i, 1));
    const int cell = grid.cell_at(p);
    ASSERT_GE(cell, 0);
    const double clearance = grid.clearance(cell);
    wide += clearance > 0.2 ? 1 : 0;
    for (const PlanSegment& segment : segments) {
      const double s = std::clamp(segment.e.dot(p - segment.a), 0.0, segment.length);
      EXPECT_GE((segment.a + s * segment.e - p).norm(), clearance);
    }
  }
  EXPECT_GT(wide, 100);
}

TEST(SegmentGrid, CrossesADoorBelowItsHeadOnly) {
  PlanSegment wall;
  wall.length = 4.0;
  wall.holes.push_back({1.5, 2.5, 0.0, 2.1});
  const std::vector<PlanSegment> segments{wall};
  const SegmentGrid grid(segments, 0.5);
  const Eigen::Vector2d ahead(0.0, 1.0);
  EXPECT_EQ(grid.cast(segments, {{2.0, -1.0}, ahead, 1.0, 0.0}, 5.0).segment, -1);
  EXPECT_EQ(grid.cast(segments, {{2.0, -1.0}, ahead, 2.5, 0.0}, 5.0).segment, 0);
  EXPECT_NEAR(grid.cast(segments, {{1.0, -1.0}, ahead, 1.0, 0.0}, 5.0).distance, 1.0, 1e-12);
  EXPECT_TRUE(grid.crosses_opening(segments, {{2.0, -1.0}, ahead, 1.0, 0.0}, 0.8, 1.1));
  EXPECT_FALSE(grid.crosses_opening(segments, {{2.0, -1.0}, ahead, 1.0, 0.0}, 0.5, 0.9));
  EXPECT_FALSE(grid.crosses_opening(segments, {{2.0, -1.0}, ahead, 1.0, 0.0}, 1.1, 3.0));
  EXPECT_FALSE(grid.crosses_opening(segments, {{2.0, -1.0}, ahead, 2.5, 0.0}, 0.8, 1.1));
  EXPECT_FALSE(grid.crosses_opening(segments, {{1.0, -1.0}, ahead, 1.0, 0.0}, 0.8, 1.1));
}

TEST(SegmentGrid, ListsOfFirstFacesFindTheOpeningsThatTheMarchFinds) {
  const PlanIndex index = make_plan_index(synthetic::plan_of(synthetic::corridor_house()), "ground", {});
  std::vector<PlanSegment> segments = index.storeys.front().segments;
  for (PlanSegment& segment : segments)
    if (segment.length > 2.0) segment.holes.push_back({0.5, 1.4, 0.0, 2.0});
  const SegmentGrid grid(segments, 0.5);
  const Stream stream(4, "slam.localize.init");
  int crossing = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const int cell = static_cast<int>(stream.uniform(0, i, 0) * grid.cells());
    const double angle = 6.28 * stream.uniform(0, i, 1), from = 6.0 * stream.uniform(0, i, 2);
    const Eigen::Vector2d off(stream.uniform(0, i, 3) - 0.5, stream.uniform(0, i, 4) - 0.5);
    const PlanRay ray{grid.cell_center(cell) + 0.49 * off, {std::cos(angle), std::sin(angle)}, 0.7, 0.02};
    const bool marched = grid.crosses_opening(segments, ray, from, from + 0.4, -1);
    EXPECT_EQ(grid.crosses_opening(segments, ray, from, from + 0.4), marched) << i;
    crossing += marched ? 1 : 0;
  }
  EXPECT_GT(crossing, 50);
}

TEST(SegmentGrid, OfEqualDistancesTheLowestIndexWins) {
  PlanSegment wall;
  wall.length = 4.0;
  const std::vector<PlanSegment> segments{wall, wall};
  const SegmentGrid grid(segments, 0.5);
  EXPECT_EQ(grid.cast(segments, {{2.0, -1.0}, {0.0, 1.0}, 1.0, 0.0}, 5.0).segment, 0);
}

TEST(SegmentGrid, OfAWideSiteHasCoarserCells) {
  std::vector<PlanSegment> segments(2);
  segments[1].a = {8000.0, 9000.0};
  const SegmentGrid grid(segments, 0.5);
  EXPECT_LE(static_cast<std::size_t>(grid.cells()), RayCandidateTable::most_cells);
  for (const PlanSegment& segment : segments) {
    const PlanRay ray{segment.a + 0.5 * segment.length * segment.e - 2.0 * segment.n, segment.n, 1.0, 0.0};
    EXPECT_NEAR(grid.cast(segments, ray, 15.0).distance, 2.0, 1e-9);
  }
}

}  // namespace
}  // namespace plumbline::slam
