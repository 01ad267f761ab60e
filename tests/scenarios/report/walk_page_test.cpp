// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/walk_page.h"

#include <gtest/gtest.h>

#include "scenarios/report/walk_list.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::scenarios {
namespace {

bim::PlannedAndBuilt site_with_door(double width_m) {
  bim::Building building = sim::two_rooms();
  sim::add_door(building, 0, 2.5, width_m);
  return {building, building, {}, true};
}

TEST(WalkPage, ShowsTheFloorTheWalkAndNoReasonsWhereNothingStopsTheRobot) {
  const std::string page = walk_page(site_with_door(0.9), "two <rooms>").html;
  EXPECT_NE(page.find("Where the robot can walk: two &lt;rooms&gt;"), std::string::npos);
  EXPECT_NE(page.find("through 2 of the 2 rooms on "), std::string::npos);
  EXPECT_NE(page.find("<polyline"), std::string::npos);
  EXPECT_EQ(page.find("Out of reach:"), std::string::npos);
  EXPECT_EQ(page, walk_page(site_with_door(0.9), "two <rooms>").html);
}

TEST(WalkPage, NamesWhatStopsTheRobotAtItsPlace) {
  const std::string page = walk_page(site_with_door(0.5), "two rooms").html;
  EXPECT_NE(page.find("<b>west</b>: door 'd0' is 0.5 m wide"), std::string::npos) << page.substr(page.size() / 2);
  EXPECT_NE(page.find("<circle"), std::string::npos);
}

TEST(WalkPage, ABuildingWithoutRoomsPromisesNoWalkThatRunRefuses) {
  bim::PlannedAndBuilt site = site_with_door(0.9);
  for (bim::Building* building : {&site.as_planned, &site.as_built}) {
    building->rooms.clear();
    sim::add_obstacle(*building, sim::rectangle({-50, -50}, {50, 50}), 0.0, 1.0);
  }
  const WalkPage page = walk_page(site, "full");
  ASSERT_EQ(page.lines.size(), 1U);
  EXPECT_NE(page.lines.front().find("`run` refuses: "), std::string::npos) << page.lines.front();
}

TEST(WalkPage, ABuildingWithoutRoomsSaysSo) {
  bim::PlannedAndBuilt site = site_with_door(0.9);
  site.as_planned.rooms.clear();
  site.as_built.rooms.clear();
  const WalkPage page = walk_page(site, "no rooms");
  ASSERT_EQ(page.lines.size(), 1U);
  EXPECT_EQ(page.lines.front().rfind("No rooms are known", 0), 0U);
  EXPECT_NE(page.html.find("No rooms are known"), std::string::npos);
}

TEST(WalkList, IsEmptyWithoutTheBlock) { EXPECT_EQ(list_walk(nullptr), ""); }

TEST(WalkList, CountsRoomsOfOtherStoreys) {
  const Tree walk = read_json(
      R"({"storey": "ground", "planned_m": 29.4, "rooms": {"on_storey": 4, "in_reach": 4, "on_route": 2, "elsewhere": 2},
          "out_of_reach": [], "left_out": [], "warnings": []})",
      "test");
  const std::string html = list_walk(&walk);
  EXPECT_NE(
      html.find("29.4 m through 2 of the 4 rooms on ground and 2 rooms of other storeys; 4 on ground are in reach."),
      std::string::npos)
      << html;
}

TEST(WalkList, RoomsWithOneReasonStandTogether) {
  const Tree walk = read_json(
      R"({"storey": "ground", "planned_m": 12.5, "rooms": {"on_storey": 5, "in_reach": 2, "on_route": 1},
          "out_of_reach": [{"room": "a", "name": "A", "why": "door 'd' is closed"},
                           {"room": "b", "name": "B", "why": "wall 'w' has no door near [1, 2]"},
                           {"room": "c", "name": "C", "why": "door 'd' is closed"}],
          "left_out": ["E"], "warnings": ["the start reaches only 2 of the 5 rooms"]})",
      "test");
  const std::string html = list_walk(&walk);
  EXPECT_NE(html.find("<b>A, C</b>: door"), std::string::npos) << html;
  EXPECT_NE(html.find("<b>B</b>: wall"), std::string::npos) << html;
  EXPECT_NE(html.find("not on the route: E."), std::string::npos) << html;
  EXPECT_NE(html.find("reaches only 2 of the 5 rooms"), std::string::npos) << html;
}

TEST(WalkPage, AMapOfRoomsWithoutWallsShowsThem) {
  bim::PlannedAndBuilt site = site_with_door(0.9);
  for (bim::Building* building : {&site.as_planned, &site.as_built}) {
    building->walls.clear();
    building->openings.clear();
  }
  const std::string page = walk_page(site, "rooms").html;
  const std::size_t at = page.find("viewBox=\"-0.");
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(page.find("9999999"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
