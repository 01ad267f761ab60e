// SPDX-License-Identifier: Apache-2.0
#include "bim/model/walked_floors.h"

#include <gtest/gtest.h>

#include "bim/model/extrude.h"
#include "bim/model/fillings.h"
#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

Polygon2 rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

/// Lower floor, a slope up to an upper one with a well in it, and a step on that.
WalkedFloors floors() {
  WalkedFloors floors{-0.5, {}};
  floors.raised.push_back({{rectangle(4, 0, 8, 5), {}}, 0.0, -1.0, {0.125, 0.0}});
  floors.raised.push_back({{rectangle(8, 0, 12, 5), {rectangle(9, 1, 10, 2)}}, 0.0, 0.0});
  floors.raised.push_back({{rectangle(11, 0, 12, 5), {}}, 0.15, 0.15});
  return floors;
}

TEST(WalkedFloors, HaveTheHeightOfTheHighestThatCoversAPoint) {
  const WalkedFloors lower_and_upper = floors();
  EXPECT_EQ(height_at(lower_and_upper, {2.0, 2.0}), -0.5);
  EXPECT_DOUBLE_EQ(height_at(lower_and_upper, {6.0, 2.0}), -0.25);
  EXPECT_EQ(height_at(lower_and_upper, {8.5, 2.0}), 0.0);
  EXPECT_EQ(height_at(lower_and_upper, {9.5, 1.5}), -0.5) << "the well";
  EXPECT_EQ(height_at(lower_and_upper, {11.5, 2.0}), 0.15);
}

TEST(WalkedFloors, MovedHaveTheirHeightsWhereTheyWereMoved) {
  const Stream stream(7, "bim.generate");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto draw = [&](double low, double high, std::uint32_t lane, std::uint32_t k) {
      return low + (high - low) * stream.uniform(i, lane, k);
    };
    const Pose X_VW =
        Pose::from_xyz_yaw({draw(-50, 50, 0, 0), draw(-50, 50, 0, 1), draw(-50, 50, 0, 2)}, draw(-3.1, 3.1, 0, 3));
    const WalkedFloors there = moved(X_VW, floors());
    for (std::uint32_t k = 1; k < 20; ++k) {
      const Eigen::Vector3d p(draw(-1, 13, k, 0), draw(-1, 6, k, 1), 0.0);
      EXPECT_NEAR(height_at(there, (X_VW * p).head<2>()), height_at(floors(), p.head<2>()) + X_VW.t.z(), 1e-9)
          << p.transpose();
    }
  }
}

/// Two rooms on one slab whose screed, this thick, is drawn as coverings; a door begins on it.
Building on_screed(double screed_m) {
  Building building;
  building.storeys.push_back({"s0", "s0", 0.0, 3.0, 0});
  Slab slab;
  slab.storey = 0;
  slab.polygon = {rectangle(0, 0, 10, 4), {}};
  slab.z0_m = -0.2;
  slab.z1_m = 0.0;
  building.slabs = {slab};
  Wall wall;
  wall.storey = 0;
  wall.a = {5, 0};
  wall.b = {5, 4};
  wall.thickness_m = 0.2;
  wall.z1_m = 2.8;
  building.walls = {wall};
  Opening door;
  door.kind = OpeningKind::door;
  door.wall = 0;
  door.s_m = 2.0;
  door.width_m = 1.0;
  door.z0_m = screed_m;
  door.z1_m = screed_m + 2.0;
  building.openings = {door};
  for (const double x : {0.0, 5.1}) {
    Room room;
    room.storey = 0;
    room.polygon = rectangle(x, 0, x + 4.9, 4);
    room.z0_m = screed_m;
    building.rooms.push_back(room);
    Obstacle covering;
    covering.kind = "covering";
    covering.storey = 0;
    covering.planned = true;
    covering.body = extrude({{room.polygon, {}}}, 0.0, screed_m);
    building.obstacles.push_back(covering);
  }
  return building;
}

TEST(WalkedFloors, AreTheTopOfAScreedHoweverThin) {
  for (const double screed_m : {0.02, 0.05, 0.1, 0.15}) {
    Building building = on_screed(screed_m);
    const WalkedFloors walked = walked_floors(building, 0);
    EXPECT_EQ(walked.ground_m, 0.0);
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(2, 2), Eigen::Vector2d(8, 2), Eigen::Vector2d(5, 2)})
      EXPECT_NEAR(height_at(walked, p), screed_m, 1e-9) << p.transpose();
    BuildingOptions bare;
    bare.furniture = false;
    apply_options(building, bare);
    EXPECT_EQ(building.obstacles.size(), 2u) << "a screed is no furniture";
  }
}

}  // namespace
}  // namespace plumbline::bim
