// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/ray_candidates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

/// Rooms of 3 x 4 m with a door in every wall, and free-standing faces at any angle, low ones among them.
std::vector<PlanSegment> some_plan(const Stream& stream) {
  std::vector<PlanSegment> segments;
  const auto add = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& e, double length) {
    PlanSegment segment;
    segment.a = a;
    segment.e = e;
    segment.n = {-e.y(), e.x()};
    segment.length = length;
    segments.push_back(segment);
  };
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y < 3; ++y) {
      add({3.0 * x, 4.0 * y}, Eigen::Vector2d::UnitY(), 4.0);
      segments.back().holes.push_back({1.0, 2.0, 0.0, 2.1});
    }
  for (int y = 0; y <= 3; ++y)
    for (int x = 0; x < 4; ++x) {
      add({3.0 * x, 4.0 * y}, Eigen::Vector2d::UnitX(), 3.0);
      add({3.0 * x + 3.0, 4.0 * y}, -Eigen::Vector2d::UnitX(), 3.0);  // the same face, from behind
    }
  for (std::uint32_t lane = 0; lane < 12; ++lane) {
    const double angle = 2.0 * std::numbers::pi * stream.uniform(0, lane, 0);
    add({12.0 * stream.uniform(0, lane, 1), 12.0 * stream.uniform(0, lane, 2)}, {std::cos(angle), std::sin(angle)},
        0.1 + 2.0 * stream.uniform(0, lane, 3));
    if (lane % 2 == 0) segments.back().z1 = 0.9;
  }
  return segments;
}

TEST(RayCandidateTable, FindsWhatTestingEveryFaceFinds) {
  const Stream stream(5, "slam.localize.init");
  const std::vector<PlanSegment> segments = some_plan(stream);
  const GridFrame frame{{-0.7, -0.6}, 0.5, 27, 27};
  const RayCandidateTable faces(segments, frame);
  constexpr std::uint32_t rays = 40000;
  int settled = 0, hits = 0;
  for (std::uint32_t i = 0; i < rays; ++i) {
    // One in four along an axis or a diagonal, where ranges of directions meet.
    const double turn = stream.uniform(1, i, 2),
                 angle = 2.0 * std::numbers::pi * (i % 4 ? turn : std::round(8 * turn) / 8);
    const PlanRay ray{{13.0 * stream.uniform(1, i, 0) - 0.5, 13.0 * stream.uniform(1, i, 1) - 0.5},
                      {std::cos(angle), std::sin(angle)},
                      0.3 + 2.0 * stream.uniform(1, i, 3),
                      0.4 * (stream.uniform(1, i, 4) - 0.5)};
    const double most = 20.0 * stream.uniform(1, i, 5);
    PlanHit all{most, -1}, found{most, -1};
    for (std::size_t k = 0; k < segments.size(); ++k) keep_nearest(segments[k], static_cast<int>(k), ray, all);
    if (!faces.cast(segments, static_cast<int>(frame.find(ray.origin).value()), ray, found)) continue;
    ++settled;
    hits += found.segment >= 0 ? 1 : 0;
    ASSERT_EQ(found.segment, all.segment) << "ray " << i;
    ASSERT_EQ(found.distance, all.distance) << "ray " << i;
  }
  EXPECT_GT(settled, 0.9 * rays);
  EXPECT_GT(hits, 0.5 * rays);
}

}  // namespace
}  // namespace plumbline::slam
