// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_model.h"

#include <gtest/gtest.h>

#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

TEST(Walls, KeepTheirBodyWhereTheirAxisMakesNoSense) {
  Sketch sketch;
  sketch.storey(0);
  sketch.wall(0, 0, 4, 0.2, 3);
  std::string text = sketch.text();
  const std::string line = "=IFCPOLYLINE((";
  const std::size_t axis = text.rfind(line) + line.size();  // a unit vector among its points
  text.replace(axis, text.find(')', axis) - axis, "#1,#1");
  const StepBody body = body_in(text, "IfcWall");
  EXPECT_NEAR(body.volume_m3(), 2.4, 1e-6);
  EXPECT_TRUE(says(body, "IfcPolyline needs a Points of its proper kind"));
  const Building building = read_ifc_text(text, "s.ifc");
  EXPECT_EQ(building.walls.size(), 1u);
  EXPECT_EQ(count(building, "makes_no_sense"), 0);
  EXPECT_EQ(count(building, "geometry"), 1);
}

}  // namespace
}  // namespace plumbline::bim
