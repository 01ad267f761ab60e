// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/snap_rounding.h"

#include <gtest/gtest.h>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline {
namespace {

TEST(SnapRounding, RoundsEachVertexWhereThatKeepsTheRings) {
  const std::vector<PolygonWithHoles2> pieces = snap_rounded({{{0.2, 0.4}, {9.7, 0.1}, {10.3, 9.9}, {-0.1, 10.2}}});
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].outer, (Polygon2{{0, 0}, {10, 0}, {10, 10}, {0, 10}}));
}

TEST(SnapRounding, AHoleThatRoundsOutOfItsOutlineIsStillCutOut) {
  // The hole's corner lies a hair under the slanted side, and rounds beyond it.
  const Polygon2 outline = {{0, 0}, {1000, 0}, {1000, 370}}, hole = {{504.1, 186.51}, {900, 100}, {500, 100}};
  ASSERT_LT(signed_area(hole), -17000.0);
  EXPECT_NEAR(area(snap_rounded({outline, hole})), signed_area(outline) + signed_area(hole), 500.0);
}

TEST(SnapRounding, EdgesThatSwapPlacesInAVertexAreTakenForNoRing) {
  const Polygon2 ring = {{78.696, 27.652}, {90.155, 17.671}, {109, 25}, {116, 29}, {98, 21}, {90, 18}, {80, 27}};
  for (const PolygonWithHoles2& piece : snap_rounded({ring})) EXPECT_TRUE(is_simple(piece.outer));
}

TEST(SnapRounding, LeadsRingsThroughCornersThatTouchThem) {
  std::vector<PolygonWithHoles2> pieces = {{{{0, 0}, {30, 0}, {30, 30}}, {{{10, 10}, {20, 10}, {20, 5}}}}};
  lead_through_corners(pieces);
  EXPECT_EQ(pieces[0].outer, (Polygon2{{0, 0}, {30, 0}, {30, 30}, {10, 10}}));
  EXPECT_EQ(pieces[0].holes[0].size(), 3U);
}

}  // namespace
}  // namespace plumbline
