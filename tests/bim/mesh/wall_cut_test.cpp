// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/wall_cut.h"

#include <gtest/gtest.h>

#include "tests/bim/model/thick_wall.h"

namespace plumbline::bim {
namespace {

TEST(WallCut, ANicheIsSaidOfAWallThatIsNoPrism) {
  Wall wall = thick_wall();
  add_solid(box_solid({0.0, 0.12, 0.0}, {4.0, 0.22, 3.0}), *wall.body);  // a panel behind a cavity
  wall.thickness_m = 0.32;
  const CutWall result = cut_wall(wall, {thick_opening(-0.2, 0.1)}, {});
  ASSERT_EQ(result.warnings.size(), 2u);
  EXPECT_EQ(result.warnings[0].kind, "not_prismatic");
  EXPECT_EQ(result.warnings[1].kind, "niche");
  const CutWall through = cut_wall(wall, {thick_opening(-0.2, 0.4)}, {});
  ASSERT_EQ(through.warnings.size(), 1u);
  EXPECT_EQ(through.warnings[0].kind, "not_prismatic");
}

}  // namespace
}  // namespace plumbline::bim
