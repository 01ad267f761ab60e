// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "bim/formats/mesh/mesh_world.h"
#include "bim/geometry/polygon_boolean.h"
#include "tests/bim/formats/mesh/box_obj.h"

namespace plumbline::bim {
namespace {

/// Slab, walls and, if any, a roof.
std::string house(double x, double y, double height, double wall, bool roof, bool y_up, double per_m = 1.0) {
  BoxObj obj;
  obj.y_up = y_up;
  obj.per_m = per_m;
  obj.box({0, 0, -0.1}, {x, y, 0});
  obj.walls(x, y, 0, height, wall);
  if (roof) obj.box({0, 0, height}, {x, y, height + 0.1});
  return obj.text();
}

std::string warning_of(const Building& building, const std::string& kind) {
  const auto found = std::find_if(building.warnings.begin(), building.warnings.end(),
                                  [&](const Warning& warning) { return warning.kind == kind; });
  return found == building.warnings.end() ? "" : found->text;
}

/// With y up it would have no wall on one side, and storeys of 2 m.
TEST(SettledAxes, ANarrowCorridorStaysUpright) {
  for (const bool roof : {false, true}) {
    const Building corridor = read_mesh_world(house(30, 2.05, 3, 0.1, roof, false), "corridor.obj");
    EXPECT_NEAR(corridor.storeys.front().elevation_m, 0.0, 1e-6) << roof;
    EXPECT_NEAR(corridor.storeys.front().height_m, roof ? 3.1 : 3.0, 1e-6) << roof;
    EXPECT_EQ(warning_of(corridor, "assumed_up").find("z is taken") != std::string::npos, !roof);
  }
}

TEST(SettledAxes, HousesWithYUpAreTurnedWithAndWithoutRoof) {
  for (const bool roof : {false, true})
    for (const auto& [x, y] : {std::tuple(12.0, 8.0), {30.0, 9.0}, {6.0, 5.0}}) {
      const Building turned = read_mesh_world(house(x, y, 2.7, 0.2, roof, true), "house.obj");
      EXPECT_NE(warning_of(turned, "assumed_up").find("turned"), std::string::npos) << x << " " << roof;
      EXPECT_NEAR(turned.storeys.front().height_m, roof ? 2.8 : 2.7, 1e-6);
    }
}

/// It looks like a low house that lies on its side; neither extents nor faces tell.
TEST(SettledAxes, ATowerThatMayLieIsTold) {
  const Building lying = read_mesh_world(house(6, 5, 9, 0.2, true, true), "tower.obj");
  EXPECT_NE(warning_of(lying, "assumed_up").find("z is taken"), std::string::npos);
  const Building upright = read_mesh_world(house(6, 5, 9, 0.2, true, false), "tower.obj");
  EXPECT_EQ(warning_of(upright, "assumed_up"), "");
  EXPECT_NEAR(upright.storeys.front().height_m, 9.1, 1e-6);
}

/// As metres nothing of it would be too large, but all of it odd.
TEST(SettledAxes, AHouseInFeetIsScaled) {
  const Building scaled = read_mesh_world(house(20, 12, 3.2, 0.2, true, false, 1.0 / 0.3048), "house.obj");
  EXPECT_NE(warning_of(scaled, "assumed_unit").find("in the unit foot"), std::string::npos);
  EXPECT_NEAR(scaled.storeys.front().height_m, 3.3, 1e-4);
  // High or thick alone is a hall or a castle.
  for (const auto& [height, wall] : {std::pair(10.0, 0.2), {3.0, 0.8}}) {
    const Building kept = read_mesh_world(house(60, 40, height, wall, true, false), "house.obj");
    EXPECT_EQ(warning_of(kept, "assumed_unit"), "") << height;
  }
}

}  // namespace
}  // namespace plumbline::bim
