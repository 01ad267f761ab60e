// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/roundtrip/wall_placement.h"

#include <gtest/gtest.h>

#include "bim/formats/ifc/step/shape.h"
#include "bim/mesh/solid.h"
#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

TEST(WallPlacement, BodiesOnTheGridComeBackToTheBit) {
  const Stream random(11, "bim.generate");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto draw = [&](std::uint32_t lane) { return 200.0 * random.uniform(i, lane) - 100.0; };
    Wall wall;
    wall.a = {draw(0), draw(1)};
    wall.b = {draw(2), draw(3)};
    Solid raw;
    for (std::uint32_t k = 0; k < 8; ++k)
      raw.vertices.emplace_back(draw(10 + 3 * k), draw(11 + 3 * k), draw(12 + 3 * k));
    raw.triangles.emplace_back(0, 1, 2);
    const Solid body = canonical(raw, solid_grid_m);
    const std::optional<Solid> placed = into_placement(wall, body);
    ASSERT_TRUE(placed) << i;
    const Solid back = out_of_placement(wall, *placed);
    ASSERT_EQ(back.vertices, body.vertices) << i;
    ASSERT_EQ(back.triangles, body.triangles) << i;
  }
}

TEST(WallPlacement, BodiesOffTheGridStayInW) {
  Wall wall;
  wall.b = {3.0, 4.0};
  EXPECT_FALSE(into_placement(wall, Solid{{{0.123456789, 0.0, 0.0}}, {}}));
}

TEST(WallPlacement, XRunsAlongTheWallAndYToItsLeft) {
  Wall wall;
  wall.a = {1.0, 2.0};
  wall.b = {1.0, 7.0};
  EXPECT_TRUE(into_placement(wall, Eigen::Vector3d(0.0, 5.0, 9.0)).isApprox(Eigen::Vector3d(3.0, 1.0, 9.0)));
}

}  // namespace
}  // namespace plumbline::bim
