// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/floors.h"

namespace plumbline::bim {
namespace {

Building plain(std::string_view family) {
  return read_plan_text(write_plan(generate(family, read_yaml("{}", "options")).plan), "generated");
}

/// As a stranger's program would have written it: our own signature does not count.
Building through_ifc(const Building& building) {
  IfcWriteConfig config;
  config.signature = false;
  return read_ifc_text(write_ifc(building, config), "stranger.ifc");
}

int count(const Building& building, const std::string& kind) {
  return static_cast<int>(std::count_if(building.warnings.begin(), building.warnings.end(),
                                        [&](const Warning& w) { return w.kind == kind; }));
}

class Faults : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] Building faulty(BuildingFault fault, std::string_view family = "corridor") const {
    return with_fault(plain(family), fault, Stream(11, "bim.generate"), static_cast<std::uint64_t>(GetParam()))
        .building;
  }
};

TEST_P(Faults, ASplitLevelComesBackAtItsHeight) {
  const Building made = faulty(BuildingFault::split_level);
  const Building read = through_ifc(made);
  const Slab& slab = made.slabs.back();
  const Eigen::Vector2d p = interior_point(slab.polygon.outer);
  bool found = false;
  for (const FloorPiece& piece : floor_pieces(read))
    found = found || (contains(piece.polygon, p) && std::abs(piece.z_at(p) - slab.z1_m) < 1e-3);
  EXPECT_TRUE(found) << slab.z1_m;
  EXPECT_EQ(count(read, "no_floor"), 0);
}

TEST_P(Faults, AMezzanineIsAFloorOverAFloor) {
  const Building read = through_ifc(faulty(BuildingFault::mezzanine));
  double high = 0.0, low = 0.0;
  for (const FloorPiece& piece : floor_pieces(read))
    (piece.z0_m > 1.5 && piece.z0_m < 2.6 ? high : low) += area({piece.polygon});
  EXPECT_GT(high, 3.0);
  EXPECT_GT(low, high);
}

TEST_P(Faults, AMezzanineStaysInATurnedRoom) {
  Building turned;
  turned.storeys.push_back({"g", "g"});
  Room room;
  room.id = "r";
  room.storey = 0;
  room.polygon = {{0, -4}, {3, 0}, {0, 4}, {-3, 0}};
  turned.rooms = {room};
  const FaultyBuilding made =
      with_fault(turned, BuildingFault::mezzanine, Stream(11, "bim.generate"), static_cast<std::uint64_t>(GetParam()));
  ASSERT_EQ(made.building.slabs.size(), 1U);
  const Region2 slab = {made.building.slabs[0].polygon};
  EXPECT_NEAR(area(slab), 12.0, 1e-9);
  EXPECT_NEAR(area(intersect(slab, {{room.polygon, {}}})), 12.0, 1e-9);
}

TEST_P(Faults, OpeningsWithoutAWallAreLeftAlone) {
  Building building = plain("corridor");
  for (Opening& opening : building.openings)
    if (opening.kind == OpeningKind::door) opening.wall = -1;
  const Stream stream(11, "bim.generate");
  const auto tick = static_cast<std::uint64_t>(GetParam());
  for (const BuildingFault fault : {BuildingFault::overlapping_wall, BuildingFault::crossing_wall}) {
    const FaultyBuilding made = with_fault(building, fault, stream, tick);
    EXPECT_TRUE(made.element.empty());
    EXPECT_EQ(made.building.walls.size(), building.walls.size());
  }
  const FaultyBuilding raised = with_fault(building, BuildingFault::split_level, stream, tick);
  for (std::size_t i = 0; i < building.openings.size(); ++i) {
    const Opening &before = building.openings[i], &after = raised.building.openings[i];
    if (before.wall < 0) EXPECT_NEAR(after.z1_m - after.z0_m, before.z1_m - before.z0_m, 1e-12);
  }
}

TEST_P(Faults, DoorsThatOverlapOtherWallsAreOpenedThere) {
  for (const BuildingFault fault : {BuildingFault::overlapping_wall, BuildingFault::crossing_wall}) {
    const Building before = through_ifc(plain("corridor")), read = through_ifc(faulty(fault));
    EXPECT_EQ(read.walls.size(), before.walls.size() + 1);
    EXPECT_GE(count(read, "walls_overlap"), count(before, "walls_overlap") + 1);
    const auto doors = [](const Building& building) {
      return std::count_if(building.openings.begin(), building.openings.end(),
                           [](const Opening& o) { return o.kind == OpeningKind::door; });
    };
    EXPECT_EQ(doors(read), doors(before));
  }
}

TEST_P(Faults, MissingSlabsAreSaidAndRoomsCarry) {
  const Building read = through_ifc(faulty(BuildingFault::missing_slabs));
  EXPECT_EQ(count(read, "no_floor"), 1);
  for (const FloorPiece& piece : floor_pieces(read)) EXPECT_EQ(piece.source, FloorSource::room);
}

TEST_P(Faults, ACurtainFrontReplacesAWall) {
  const Building before = plain("corridor"), made = faulty(BuildingFault::curtain_front);
  const Building read = through_ifc(made);
  EXPECT_EQ(read.walls.size() + 1, before.walls.size());
  EXPECT_EQ(read.rooms.size(), before.rooms.size());
  EXPECT_GE(read.obstacles.size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Draws, Faults, testing::Range(0, 5));

}  // namespace
}  // namespace plumbline::bim
