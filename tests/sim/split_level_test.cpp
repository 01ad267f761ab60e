// SPDX-License-Identifier: Apache-2.0
// The robot walks over a step between two floors of a storey, up and down.
#include <gtest/gtest.h>

#include "sim/route/multi_storey_planner.h"
#include "sim/world.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

TEST(SplitLevel, TheRobotWalksUpAndDownAStepOfTheHeightItClimbs) {
  for (const double rise : {0.15, 0.20}) {
    const bim::Building building = split_level(rise);
    const bim::BuildingMesh mesh = bim::build_mesh(building);
    const MultiStoreyPlanner space(building);
    const Eigen::Vector2d west(2.0, 2.5), east(6.0, 2.5);
    WorldConfig config;
    config.lidar = lidar_config(LidarPreset::ideal);
    config.start_W = west;
    config.waypoints = space.path({0, west}, {0, east});
    const std::vector<Waypoint> back = space.path({0, east}, {0, west});
    config.waypoints.insert(config.waypoints.end(), back.begin() + 1, back.end());
    config.duration_s = 90.0;
    World world(config, building, mesh);
    WorldFrame frame;
    double highest = 0.0, last = 0.0, start = 0.0;
    Eigen::Vector2d end = Eigen::Vector2d::Zero();
    while (world.next(frame)) {  // throws where it falls or stalls
      last = frame.truth.poses.back().X_WR.t.z();
      if (start == 0.0) start = last;
      highest = std::max(highest, last);
      end = frame.truth.poses.back().X_WR.t.head<2>();
    }
    EXPECT_NEAR(highest - start, rise, 0.08) << rise;  // the trunk moves by some centimetres while it steps
    EXPECT_NEAR(last, start, 0.03) << rise;
    EXPECT_LT((end - west).norm(), 0.5) << rise;
  }
}

}  // namespace
}  // namespace plumbline::sim
