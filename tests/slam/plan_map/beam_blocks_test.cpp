// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/beam_blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/random/stream.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

/// The corridor with a door or a window in every third face.
PlanIndex pierced_corridor() {
  bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  for (std::size_t i = 0; i < plan.faces.size(); i += 3) {
    bim::PlanFace& face = plan.faces[i];
    const double length = (face.p1 - face.p0).norm();
    face.holes.push_back({0.3 * length, 0.5 * length, i % 2 == 0 ? 0.0 : 0.9, 2.1});
  }
  return make_plan_index(plan, "ground", {});
}

/// Beams to all sides, up and down, three in four as long as the plan has them from a pose.
LocalizationScan scan_from(const StoreyIndex& storey, const Pose2& X_IH, const Stream& stream, int beams) {
  LocalizationScan scan;
  scan.sensor_height = 0.66;
  scan.sensor_H = {0.1, -0.05};
  for (int k = 0; k < beams; ++k) {
    const auto lane = static_cast<std::uint32_t>(k);
    const double angle = 2.0 * std::numbers::pi * stream.uniform(1, lane, 0);
    Beam beam{{std::cos(angle), std::sin(angle)}, 0.0, 0.4 * (stream.uniform(1, lane, 1) - 0.5)};
    const PlanRay ray{X_IH * scan.sensor_H, X_IH.rotation() * beam.direction_H, storey.floor_z + scan.sensor_height,
                      beam.slope};
    beam.range = storey.grid.cast(storey.segments, ray, 25.0).distance;
    if (k % 4 == 0) beam.range *= 0.3 + stream.uniform(1, lane, 2);
    scan.beams.push_back(beam);
  }
  return scan;
}

TEST(BeamBlocks, MatchTheScalarLikelihood) {
  const PlanIndex index = pierced_corridor();
  const StoreyIndex& storey = index.storeys.front();
  const Stream stream(5, "slam.localize.init");
  const LikelihoodConfig config;
  const Eigen::Vector2d center = centroid(storey.rooms.front().polygon);
  int poses = 0, alike = 0;
  double spread = 0.0;
  for (const int beams : {1, 3, 30, 181}) {
    const LocalizationScan scan = scan_from(storey, {center, 0.3}, stream, beams);
    const int stride = beams > 100 ? 6 : 1;
    const BeamBlocks blocks(storey, scan, stride, config);
    EXPECT_NEAR(blocks.log_likelihood(SensorPose2(storey, {center, 0.3}, scan)),
                beam_log_likelihood(storey, {center, 0.3}, scan, stride, config), 1e-3);
    for (std::uint32_t i = 0; i < 2000; ++i) {
      // Also outside of the building, and of the grid.
      const Pose2 X_IH{center + 30.0 * Eigen::Vector2d(stream.uniform(2, i, 0) - 0.5, stream.uniform(2, i, 1) - 0.5),
                       2.0 * std::numbers::pi * (stream.uniform(2, i, 2) - 0.5)};
      const double alone = beam_log_likelihood(storey, X_IH, scan, stride, config);
      ++poses;
      spread = std::max(spread, std::abs(alone));
      // 1e-5 m of 0.06 m, at 3 sigma, for 30 beams of weight 0.9; more only where a beam grazes an edge.
      if (std::abs(blocks.log_likelihood(SensorPose2(storey, X_IH, scan)) - alone) < 0.02) ++alike;
    }
  }
  EXPECT_GT(spread, 20.0);
  EXPECT_GE(alike, poses - poses / 200);
}

TEST(BeamBlocks, MatchTheScalarLikelihoodWithAnyCaps) {
  const PlanIndex index = pierced_corridor();
  const StoreyIndex& storey = index.storeys.front();
  const Stream stream(6, "slam.localize.init");
  const Eigen::Vector2d center = centroid(storey.rooms.front().polygon);
  const LocalizationScan scan = scan_from(storey, {center, 0.3}, stream, 30);
  LikelihoodConfig none, grazing, wide;
  none.beam_max_nll_short = none.beam_max_nll_long = 0.0;
  grazing.beam_min_incidence = 0.0;
  wide.beam_max_nll_long = 50.0;
  wide.beam_max_nll_short = 20.0;
  for (const LikelihoodConfig& config : {none, grazing, wide}) {
    const BeamBlocks blocks(storey, scan, 1, config);
    int alike = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const Pose2 X_IH{center + 10.0 * Eigen::Vector2d(stream.uniform(2, i, 0) - 0.5, stream.uniform(2, i, 1) - 0.5),
                       2.0 * std::numbers::pi * (stream.uniform(2, i, 2) - 0.5)};
      const double alone = beam_log_likelihood(storey, X_IH, scan, 1, config);
      if (std::abs(blocks.log_likelihood(SensorPose2(storey, X_IH, scan)) - alone) < 0.02) ++alike;
    }
    EXPECT_GE(alike, 990);
  }
}

TEST(BeamBlocks, WithoutBeamsTheLikelihoodIsOne) {
  const PlanIndex index = pierced_corridor();
  const StoreyIndex& storey = index.storeys.front();
  const LocalizationScan scan;
  const LikelihoodConfig config;
  const SensorPose2 pose(storey, {centroid(storey.rooms.front().polygon), 0.0}, scan);
  EXPECT_EQ(BeamBlocks(storey, scan, 6, config).log_likelihood(pose), 0.0);
}

}  // namespace
}  // namespace plumbline::slam
