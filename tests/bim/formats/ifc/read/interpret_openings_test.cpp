// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/mesh.h"
#include "tests/bim/formats/ifc/read/reading.h"

namespace plumbline::bim {
namespace {

TEST(Openings, AreAsWideAsWithinTheWall) {
  Sketch sketch;
  const std::string host = two_rooms(sketch);  // 0.3 m thick, along y
  sketch.door(sketch.opening(host, sketch.prism({{3, 1}, {5, 3}, {5, 4}, {3, 2}}, 0, 2.1)));
  const Building building = read(sketch);
  ASSERT_EQ(building.openings.size(), 1U);
  EXPECT_NEAR(building.openings[0].width_m, 1.3, 1e-9);
  EXPECT_NEAR(building.openings[0].s_m, 2.5, 1e-9);
}

TEST(Openings, ADoorBesideItsWallLeadsNowhere) {
  Sketch sketch;
  const std::string host = two_rooms(sketch);
  sketch.door(sketch.opening(host, sketch.box(3.0, 2, 0, 3.5, 3, 2.1)));
  const Building building = read(sketch);
  ASSERT_EQ(building.openings.size(), 1U);
  EXPECT_EQ(building.openings[0].rooms[0], -1);
  EXPECT_EQ(building.openings[0].rooms[1], -1);
  EXPECT_EQ(count(building, "opening_unused"), 1);
}

}  // namespace
}  // namespace plumbline::bim
