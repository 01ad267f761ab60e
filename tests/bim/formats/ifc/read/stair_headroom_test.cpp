// SPDX-License-Identifier: Apache-2.0
// Stairs under a slab.
#include <gtest/gtest.h>

#include "bim/model/adjacency.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

/// Two storeys with a straight flight along x between them; the upper slab has a hole over it or not.
Sketch stairs_under(bool hole) {
  constexpr int steps = 17;
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 3);
  for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
  std::string items;
  for (int k = 0; k < steps; ++k)
    items += (k > 0 ? "," : "") +
             sketch.box(1 + 0.28 * k, 2, 3.0 / steps * k, 1 + 0.28 * (k + 1), 3.1, 3.0 / steps * (k + 1));
  sketch.element("IFCSTAIR", sketch.shape(items), "$,$");
  sketch.storey(3);
  const std::string slab = sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 2.8, 3);
  if (hole) sketch.opening(slab, sketch.box(0.9, 1.9, 2.5, 1 + 0.28 * steps, 3.2, 3.2));
  sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.1, 3, 8, 0.1, 6), 8), "$,$");
  return sketch;
}

TEST(Stairs, UnderASlabWithoutAnOpeningAreNoWay) {
  const Building open = read(stairs_under(true)), shut = read(stairs_under(false));
  ASSERT_EQ(open.stairs.size(), 1u);
  ASSERT_EQ(shut.stairs.size(), 1u);
  EXPECT_EQ(open.stairs.front().to, 1);
  EXPECT_EQ(adjacency(open).size(), 1u);
  EXPECT_EQ(count(open, "no_headroom"), 0);
  EXPECT_EQ(shut.stairs.front().to, -1);
  EXPECT_EQ(shut.stairs.front().rooms[1], -1);
  EXPECT_TRUE(adjacency(shut).empty());
  EXPECT_EQ(count(shut, "no_headroom"), 1);
}

}  // namespace
}  // namespace plumbline::bim
