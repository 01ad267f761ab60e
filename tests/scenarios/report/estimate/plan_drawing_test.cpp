// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/plan_drawing.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::scenarios {
namespace {

PlanDrawing small_drawing() {
  PlanDrawing drawing;
  drawing.plan.storeys = {{"ground <0>", 0.0, 3.0}, {"upper", 2.75, 3.0}};
  bim::PlanFace face;
  face.id = 7;
  face.storey = 1;
  face.p1 = {4.12345678, -1.0};
  face.z0 = 2.75;
  face.z1 = 5.5;
  face.holes = {{1.0, 2.0, 2.75, 4.85}};
  drawing.plan.faces = {face};
  bim::PlanRoom room;
  room.name = "hall \"A\"";
  room.storey = 0;
  room.polygon = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}};
  drawing.plan.rooms = {room};
  drawing.obstacles = {{"desk", 0, {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}}, true}};
  drawing.flights = {{0, 1, {{{0.0, 0.0}, {1.0, 0.0}}, {{0.0, 0.3}, {1.0, 0.3}}}}};
  return drawing;
}

TEST(PlanDrawing, IsReadAsItWasWritten) {
  const std::string text = write_plan_drawing(small_drawing());
  const PlanDrawing read = read_plan_drawing(text, "plan.json");
  EXPECT_EQ(write_plan_drawing(read), text);
  ASSERT_EQ(read.plan.faces.size(), 1U);
  EXPECT_EQ(read.plan.faces[0].id, 7);
  EXPECT_EQ(read.plan.faces[0].p1.x(), 4.123);
  ASSERT_EQ(read.plan.faces[0].holes.size(), 1U);
  EXPECT_EQ(read.plan.faces[0].holes[0].z1, 4.85);
  EXPECT_EQ(read.plan.storeys[1].elevation_m, 2.75);
  EXPECT_EQ(read.plan.rooms[0].name, "hall \"A\"");
  EXPECT_EQ(read.plan.rooms[0].polygon.size(), 3U);
  EXPECT_TRUE(read.obstacles[0].filled);
  EXPECT_EQ(read.flights[0].risers_W.size(), 2U);
}

TEST(PlanDrawing, RefusesWhatItCannotDraw) {
  const std::string text = write_plan_drawing(small_drawing());
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    EXPECT_THROW((void)read_plan_drawing(changed, "plan.json"), InputError) << to;
  };
  const auto key = [&](const std::string& name) { return "\"" + name + "\""; };
  refused(key("storeys"), key("stories"));
  refused(key("outline"), key("outlines"));
  refused("4.123", "1e300");
  refused("4.123", "\"x\"");
  std::string storey = text;  // of the face
  const std::size_t faces = storey.find(key("faces")), at = storey.find(key("storey"), faces);
  const std::size_t one = storey.find('1', at);
  storey[one] = '9';
  EXPECT_THROW((void)read_plan_drawing(storey, "plan.json"), InputError);
  EXPECT_THROW((void)read_plan_drawing("{", "plan.json"), InputError);
  EXPECT_THROW(
      (void)read_plan_drawing(R"({"storeys":[],"faces":[],"rooms":[],"obstacles":[],"flights":[]})", "plan.json"),
      InputError);
}

TEST(PlanDrawing, LeavesOutFurnitureThatTheMethodWasNotToldOf) {
  bim::Building building;
  building.storeys.push_back({});
  building.storeys[0].name = "Level 1";
  bim::Obstacle table;
  table.id = "table";
  table.storey = 0;
  table.body.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  building.obstacles.push_back(table);
  bim::Plan plan;
  plan.storeys = {{"id of it", 0.0, 3.0}};
  EXPECT_TRUE(plan_drawing(building, plan).obstacles.empty());
  EXPECT_EQ(plan_drawing(building, plan).plan.storeys[0].name, "Level 1");
  plan.furniture.triangles.push_back({});
  EXPECT_EQ(plan_drawing(building, plan).obstacles.size(), 1U);
}

}  // namespace
}  // namespace plumbline::scenarios
