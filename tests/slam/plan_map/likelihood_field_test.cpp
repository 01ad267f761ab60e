// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/likelihood_field.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bim/random/stream.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

/// Of points 1 cm apart on every piece.
double sampled_distance(const std::vector<SlicePiece>& pieces, const Eigen::Vector2d& p) {
  double least = 1e9;
  for (const SlicePiece& piece : pieces) {
    const int steps = 1 + static_cast<int>((piece.b - piece.a).norm() / 0.01);
    for (int k = 0; k <= steps; ++k) least = std::min(least, (piece.a + (piece.b - piece.a) * k / steps - p).norm());
  }
  return least;
}

TEST(LikelihoodField, IsTheDistanceToTheNearestWall) {
  const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(synthetic::corridor_house()));
  const LikelihoodFieldConfig config;
  const LikelihoodField field(storey, config);
  const std::vector<SlicePiece> pieces = cut_plan(storey, config.slice_height_m);
  const Stream stream(3, "bim.generate");
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Eigen::Vector2d p(20.0 * stream.uniform(i, 0) - 3.0, 20.0 * stream.uniform(i, 1) - 8.0);
    const double wanted = std::min(sampled_distance(pieces, p), config.max_distance_m);
    // The middle of p's cell is at most half a diagonal away, and samples miss at most half a step.
    EXPECT_NEAR(field.at(p), wanted, 0.5 * std::sqrt(2.0) * config.cell_m + 0.005) << p.transpose();
  }
  EXPECT_EQ(field.at({1e9, 0.0}), config.max_distance_m);
  EXPECT_EQ(field.at({std::nan(""), 0.0}), config.max_distance_m);
}

TEST(LikelihoodField, LeavesHolesOpenAtTheHeightOfTheSlice) {
  bim::Plan plan = synthetic::plan_of(synthetic::one_room());
  for (bim::PlanFace& face : plan.faces) face.holes.push_back({1.0, 2.0, 0.9, 2.1});
  const StoreyIndex storey = synthetic::storey_of(plan);
  const auto length = [&](double height) {
    double sum = 0.0;
    for (const SlicePiece& piece : cut_plan(storey, height)) sum += (piece.b - piece.a).norm();
    return sum;
  };
  double longer_than_holes = 0.0;
  for (const PlanSegment& segment : storey.segments) longer_than_holes += std::clamp(segment.length - 1.0, 0.0, 1.0);
  EXPECT_NEAR(length(0.7) - length(1.0), longer_than_holes, 1e-9);
  EXPECT_GT(longer_than_holes, 3.0);
}

TEST(LikelihoodField, StaysWithinItsMemoryAndInItsRooms) {
  const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(synthetic::corridor_house()));
  LikelihoodFieldConfig config;
  config.max_cells = 5000;
  const LikelihoodField coarse(storey, config), fine(storey, {});
  EXPECT_GT(coarse.frame().cell, config.cell_m);
  EXPECT_EQ(fine.frame().cell, config.cell_m);
  double area = 0.0;
  for (const LocalRoom& room : storey.rooms) area += std::abs(signed_area(room.polygon));
  const double free = static_cast<double>(fine.free_cells().size()) * fine.frame().cell * fine.frame().cell;
  EXPECT_NEAR(free, area, 0.05 * area);
  for (const Eigen::Vector2f& p : fine.free_cells()) ASSERT_GE(storey.room_at(p.cast<double>()), 0);
}

}  // namespace
}  // namespace plumbline::slam
