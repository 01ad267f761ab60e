// SPDX-License-Identifier: Apache-2.0
// Units that cannot be right, and what doors say of their size.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

/// A room of 8 by 6 m with an open doorway of 0.9 by 2.1 m, all so many times as large.
Sketch hall(double scale, bool door) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {8 * scale, 0}, {8 * scale, 6 * scale}, {0, 6 * scale}}, -0.2 * scale, 0);
  const std::string host = sketch.wall(0, 0, 8 * scale, 0.2 * scale, 3 * scale);
  if (door) sketch.door(sketch.opening(host, sketch.box(2 * scale, -scale, 0, 2.9 * scale, scale, 2.1 * scale)));
  return sketch;
}

TEST(Units, AreDoubtedWhereDoorsAreTooHighOrTooLow) {
  for (const double scale : {0.3048, 1.0, 2.0, 3.2808, 10.0, 304.8})
    EXPECT_EQ(count(read(hall(scale, true)), "odd_size"), scale == 1.0 || scale == 2.0 ? 0 : 1) << scale;
}

TEST(Units, AreDoubtedWhereAStoreyIsTooHigh) {
  for (const double scale : {1.0, 10.0, 25.4, 304.8})
    EXPECT_EQ(count(read(hall(scale, false)), "odd_size"), scale > 20.0 ? 1 : 0) << scale;
}

TEST(Units, AreAskedForWhereBodiesAreTooLarge) {
  Sketch sketch = hall(5000, true);
  sketch.element("IFCBEAM", sketch.shape(sketch.box(0, 0, 3, 5, 0.2, 3.3)), "$,$");
  const std::string said = input_error([&] { (void)read(sketch); });
  EXPECT_NE(said.find("larger than 10 km"), std::string::npos) << said;
  EXPECT_NE(said.find("is the unit right?"), std::string::npos) << said;
  EXPECT_EQ(said.find("it has no IfcSlab"), std::string::npos) << said;
}

/// A door with a trim of 8 cm about its leaf, in no opening; at its placement when it has one.
Opening unlinked_door(const std::string& sizes, bool placed) {
  Sketch sketch;
  two_rooms(sketch);
  const double y = placed ? 0.0 : 2.0;
  const std::string leaf = sketch.box(-0.08, -0.1, 0, 0.88, 0.1, 2.18);
  const std::string trim = sketch.shape(placed ? leaf : sketch.box(1.92, -0.1, 0, 2.88, 0.1, 2.18));
  sketch.element("IFCDOOR", trim, "$," + sizes + ",$,$,$", placed ? sketch.frame(2, y, 0) : sketch.frame(0, 0, 0));
  const Building building = read(sketch);
  return building.openings.empty() ? Opening{} : building.openings.front();
}

TEST(UnlinkedDoors, AreAsLargeAsTheySay) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.element("IFCDOOR", sketch.shape(sketch.box(-0.08, -0.1, 0, 0.88, 0.1, 2.18)), "$,2.1,0.8,$,$,$",
                 sketch.frame(2, 0, 0));
  const Building building = read(sketch);
  ASSERT_EQ(building.openings.size(), 1U);
  const Opening& opening = building.openings.front();
  EXPECT_NEAR(opening.width_m, 0.8, 1e-9);
  EXPECT_NEAR(opening.z1_m - opening.z0_m, 2.1, 1e-9);
  EXPECT_NEAR(opening.s_m, 2.4, 1e-9);
}

TEST(UnlinkedDoors, AreInTheMiddleOfTheirBodyWhereTheirPlacementIsNotAtTheirFoot) {
  const Opening opening = unlinked_door("2.1,0.8", false);
  EXPECT_NEAR(opening.width_m, 0.8, 1e-9);
  EXPECT_NEAR(opening.s_m, 2.4, 1e-9);
}

TEST(UnlinkedDoors, AreAsLargeAsTheirBodyWhereTheySayWhatCannotBe) {
  for (const char* sizes : {"$,$", "21.,8.", "0.,0.", "0.21,0.08"}) {
    const Opening opening = unlinked_door(sizes, true);
    EXPECT_NEAR(opening.width_m, 0.96, 1e-9) << sizes;
    EXPECT_NEAR(opening.z1_m - opening.z0_m, 2.18, 1e-9) << sizes;
  }
}

}  // namespace
}  // namespace plumbline::bim
