// SPDX-License-Identifier: Apache-2.0
#include "sim/route/clearance_map.h"

#include <gtest/gtest.h>

#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

const GridFrame grid{{-1.0, -1.0}, 0.05, 160, 160};

/// A slab of 4 by 5 m on the ground, one of whose corners lies so much higher.
bim::Building slab_with_a_high_corner(double rise_m) {
  bim::Building building = empty_storey();
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = rectangle({0, 0}, {4, 5});
  slab.z0_m = -0.2;
  slab.z1_m = rise_m;
  slab.body = prism(slab.polygon.outer, -0.2, 0.0);
  for (Eigen::Vector3d& p : slab.body->vertices)
    if (p.z() == 0.0 && p.head<2>() == Eigen::Vector2d(4, 0)) p.z() = rise_m;
  building.slabs.push_back(slab);
  return building;
}

TEST(ClearanceMap, AnUnevenSlabIsFloorWhereItIsLow) {
  const RouteConfig config;
  for (const double rise : {0.0, 0.04, 0.08, 0.4}) {
    const bim::Building building = slab_with_a_high_corner(rise);
    EXPECT_TRUE(has_known_floor(building, 0, 0.0, config)) << rise;
    const std::vector<char> floor = floor_cells(building, 0, 0.0, grid, config);
    const auto at = [&](double x, double y) { return floor[*grid.find({x, y})] != 0; };
    EXPECT_TRUE(at(1.0, 4.0)) << rise;
    EXPECT_EQ(at(3.9, 0.1), rise < config.band_low_m) << rise;
    EXPECT_FALSE(at(4.6, 2.5)) << rise << " beside the slab";
  }
}

TEST(ClearanceMap, ARaisedSlabSaysNothingOfTheGround) {
  bim::Building building = slab_with_a_high_corner(0.0);
  bim::Slab& slab = building.slabs.front();
  slab.z1_m = 0.3;
  slab.body = prism(slab.polygon.outer, -0.2, 0.3);
  EXPECT_FALSE(has_known_floor(building, 0, 0.0, RouteConfig()));
}

}  // namespace
}  // namespace plumbline::sim
