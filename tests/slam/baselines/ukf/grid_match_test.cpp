// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/grid_match.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/random/stream.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

constexpr double pi = std::numbers::pi;

/// What a planar scanner at X_IH sees, some beams cut short.
std::vector<Eigen::Vector2d> scan_at(const StoreyIndex& storey, const Pose2& X_IH, const Stream& stream,
                                     std::uint64_t tick) {
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < 36; ++k) {
    const double angle = 2.0 * pi * k / 36;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const PlanRay ray{X_IH.t, X_IH.rotation() * direction, storey.floor_z + 0.7, 0.0};
    const double range = storey.grid.cast(storey.segments, ray, 20.0).distance;
    const auto lane = static_cast<std::uint32_t>(k);
    points.push_back((stream.uniform(tick, lane) < 0.2 ? stream.uniform(tick, lane, 1) : 1.0) * range * direction);
  }
  return points;
}

TEST(GridMatch, FindsWhatAnExhaustiveSearchFinds) {
  const Stream stream(7, "bim.generate");
  GridMatchConfig config;
  config.cell_m = config.sigma_m = 0.4;
  config.levels = 4;
  for (const synthetic::House& house : {synthetic::one_room(), synthetic::twin_rooms()}) {
    const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(house));
    const GridMatcher matcher(storey, 0.7, config);
    for (std::uint64_t i = 0; i < 12; ++i) {
      const Pose2 truth{{0.5 + 4.0 * stream.uniform(i, 100), 0.5 + 3.0 * stream.uniform(i, 101)}, 0.0};
      const auto points = scan_at(storey, truth, stream, i);
      std::vector<double> yaws;
      for (int k = 0; k < 9; ++k) yaws.push_back(2.0 * pi * stream.uniform(i, 102, static_cast<std::uint32_t>(k)));
      GridMatch best;
      for (std::size_t t = 0; t < yaws.size(); ++t)
        for (int y = 0; y < matcher.ny(); ++y)
          for (int x = 0; x < matcher.nx(); ++x) {
            const GridMatch here{matcher.score(points, yaws[t], x, y), static_cast<int>(t), x, y, true};
            if (here.before(best)) best = here;
          }
      const GridMatch found = matcher.best(points, yaws);
      EXPECT_EQ(found.score, best.score);
      EXPECT_EQ(found.turn, best.turn) << "of equals the first";
      EXPECT_EQ(found.x, best.x);
      EXPECT_EQ(found.y, best.y);
      EXPECT_TRUE(found.complete);
    }
  }
}

TEST(GridMatch, FindsThePlaceOfAScan) {
  const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(synthetic::corridor_house()));
  const GridMatcher matcher(storey, 0.7, {});
  const std::vector<double> yaws = matcher.yaws(0.0, pi);
  const Stream stream(8, "bim.generate");
  const double step = 2.0 * pi / static_cast<double>(yaws.size());
  int found = 0;
  for (std::uint64_t i = 0; i < 8; ++i) {
    const Pose2 truth{{1.0 + 12.0 * stream.uniform(i, 100), 0.5 + 1.2 * stream.uniform(i, 101)},
                      2.0 * pi * stream.uniform(i, 102)};
    const Pose2 pose = matcher.pose(matcher.best(scan_at(storey, truth, stream, i), yaws), yaws);
    if ((pose.t - truth.t).norm() < 0.4 && std::abs(wrap_angle(pose.yaw - truth.yaw)) < 3.0 * step) ++found;
  }
  EXPECT_GE(found, 7);  // measured: 8
}

TEST(GridMatch, StaysWithinItsMemoryAndItsNodes) {
  const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(synthetic::corridor_house()));
  GridMatchConfig config;
  config.max_cells = 1000;
  config.max_nodes = 1000;
  const GridMatcher matcher(storey, 0.7, config);
  EXPECT_LE(matcher.nx() * matcher.ny(), 1000);
  const std::vector<double> yaws = matcher.yaws(0.3, 0.1);
  for (const double yaw : yaws) EXPECT_LT(std::abs(yaw - 0.3), 0.1);
  const GridMatch nothing = matcher.best({}, yaws);
  EXPECT_EQ(nothing.score, 0);
}

}  // namespace
}  // namespace plumbline::slam
