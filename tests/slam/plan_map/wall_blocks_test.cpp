// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/wall_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/random/stream.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"
#include "tests/slam/plan_map/wall_log_likelihood.h"

namespace plumbline::slam {
namespace {

TEST(WallBlocks, MatchTheScalarLikelihood) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const StoreyIndex& storey = index.storeys.front();
  const LikelihoodConfig config;
  const Stream stream(5, "slam.localize.init");
  LocalizationScan scan = synthetic::house_scan(house, Pose::from_xyz_yaw({7.0, 1.1, 0.46}, 0.3), Pose{}).scan;
  ASSERT_GE(scan.walls.size(), 2U);
  const Eigen::Vector2d center = centroid(storey.rooms.front().polygon);
  int poses = 0, alike = 0;
  double spread = 0.0;
  for (const std::size_t walls : {scan.walls.size(), std::size_t{5}, std::size_t{4}, std::size_t{1}, std::size_t{0}}) {
    while (scan.walls.size() < walls) scan.walls.push_back(scan.walls.front());
    scan.walls.resize(walls);
    const WallBlocks blocks(scan, config);
    for (std::uint32_t i = 0; i < 2000; ++i) {
      // Also outside of the building, and of the grid; a yaw next to every wall's now and then.
      const Pose2 X_IH{center + 30.0 * Eigen::Vector2d(stream.uniform(2, i, 0) - 0.5, stream.uniform(2, i, 1) - 0.5),
                       i % 2 == 0 ? 2.0 * std::numbers::pi * (stream.uniform(2, i, 2) - 0.5)
                                  : wrap_angle(0.3 + 0.02 * stream.gauss(2, i, 3) + 0.5 * std::numbers::pi * (i % 7))};
      const double alone = wall_log_likelihood(storey, X_IH, scan, config);
      ++poses;
      spread = std::max(spread, std::abs(alone));
      // Offsets are rounded by 1e-6 m of 0.05 m, up to 14 sigma, for 8 walls; more only at the edge of a gate.
      if (std::abs(blocks.log_likelihood(storey, SensorPose2(storey, X_IH, scan)) - alone) < 2e-3) ++alike;
    }
  }
  EXPECT_GT(spread, 5.0);
  EXPECT_GE(alike, poses - poses / 500);
}

TEST(WallBlocks, TakeTheExponentialOfFourNumbers) {
  double worst = 0.0;
  for (double x = -80.0; x <= 80.0; x += 0.0131) {
    const float rounded = static_cast<float>(x);
    const Float4 power = exp_of(Float4{rounded, 0.0F, rounded, -1.0F});
    EXPECT_EQ(power[0], power[2]);
    EXPECT_EQ(power[1], 1.0F);
    const double exact = std::exp(static_cast<double>(rounded));
    worst = std::max(worst, std::abs(static_cast<double>(power[0]) - exact) / exact);
  }
  EXPECT_LT(worst, 3e-7);
  const Float4 whole = whole_of(Float4{-0.4F, 1.6F, -7.7F, 0.0F});
  EXPECT_EQ(whole[0], 0.0F);
  EXPECT_EQ(whole[1], 2.0F);
  EXPECT_EQ(whole[2], -8.0F);
  EXPECT_EQ(whole[3], 0.0F);
}

}  // namespace
}  // namespace plumbline::slam
