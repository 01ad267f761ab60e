// SPDX-License-Identifier: Apache-2.0
#include "bim/model/through.h"

#include <gtest/gtest.h>

#include "bim/model/wall_frame.h"
#include "tests/bim/model/thick_wall.h"

namespace plumbline::bim {
namespace {

TEST(Through, ANicheIsNoneInABodyGivenTwice) {
  Wall wall = thick_wall();
  EXPECT_TRUE(goes_through(thick_opening(-0.2, 0.2), wall));
  EXPECT_FALSE(goes_through(thick_opening(-0.2, 0.02), wall));
  const Solid once = *wall.body;
  add_solid(once, *wall.body);
  EXPECT_TRUE(goes_through(thick_opening(-0.2, 0.2), wall));
  EXPECT_FALSE(goes_through(thick_opening(-0.2, 0.02), wall));
}

/// A leaf of 0.2 m and a panel before it, so far apart.
Wall layered_wall(double cavity_m) {
  Wall wall = thick_wall();
  add_solid(box_solid({0.0, 0.1 + cavity_m, 0.0}, {4.0, 0.15 + cavity_m, 3.0}), *wall.body);
  wall.thickness_m = 0.25 + cavity_m;
  return wall;
}

TEST(Through, ACavityOfALayeredWallIsNotOutside) {
  for (const double cavity_m : {0.01, 0.02, 0.1, 0.2}) {
    EXPECT_FALSE(goes_through(thick_opening(-0.2, 0.1), layered_wall(cavity_m))) << cavity_m;
    EXPECT_FALSE(goes_through(thick_opening(-0.2, 0.1 + 0.5 * cavity_m), layered_wall(cavity_m))) << cavity_m;
    EXPECT_TRUE(goes_through(thick_opening(-0.2, 0.5), layered_wall(cavity_m))) << cavity_m;
  }
  // A wall that stands round a room is no layer.
  EXPECT_TRUE(goes_through(thick_opening(-0.2, 0.2), layered_wall(2.0)));
}

TEST(Through, AnOpeningThatMissesItsWallDoesNotGoThrough) {
  EXPECT_FALSE(goes_through(thick_opening(0.5, 1.0), thick_wall()));
  Opening above = thick_opening(-0.1, 0.05);
  above.z0_m = 3.2;
  above.z1_m = 5.3;
  above.solid = box_solid({1.5, -0.1, 3.2}, {2.5, 0.05, 5.3});
  EXPECT_FALSE(goes_through(above, thick_wall()));
}

TEST(Through, AnOpeningThatTheBodyHasAlreadyGoesThrough) {
  Wall wall = thick_wall();
  wall.body = box_solid({0.0, -0.1, 0.0}, {1.5, 0.1, 3.0});
  add_solid(box_solid({2.5, -0.1, 0.0}, {4.0, 0.1, 3.0}), *wall.body);
  EXPECT_TRUE(goes_through(thick_opening(-0.1, 0.05), wall));
}

TEST(Through, ADoorThatEndsALittleShortIsExtended) {
  Opening opening = thick_opening(-0.1, 0.07);
  EXPECT_NEAR(extend_through(opening, thick_wall()), 0.03, 1e-9);
  EXPECT_TRUE(goes_through(opening, thick_wall()));
}

TEST(Through, ABulgeElsewhereMakesNoOpeningShort) {
  Wall wall = thick_wall();
  add_solid(box_solid({3.0, 0.1, 0.0}, {3.5, 0.14, 3.0}), *wall.body);
  Opening opening = thick_opening(-0.1, 0.1);
  EXPECT_EQ(extend_through(opening, wall), 0.0);
  EXPECT_EQ(extent_across(WallFrame(wall), solids_of(opening)).high, 0.1);
}

TEST(WallFrame, AnOpeningIsNoDeeperThanItselfAndItsWall) {
  Wall curved = thick_wall();
  curved.offset_m = 0.0;
  curved.thickness_m = 3.0;
  const Interval own = depth_in_wall(thick_opening(2.6, 3.2), curved);
  EXPECT_DOUBLE_EQ(own.low, 2.6);
  EXPECT_DOUBLE_EQ(own.high, 3.0);
  Opening plain = thick_opening(2.6, 3.2);
  plain.solid.reset();
  EXPECT_DOUBLE_EQ(depth_in_wall(plain, curved).length(), 3.0);
}

}  // namespace
}  // namespace plumbline::bim
