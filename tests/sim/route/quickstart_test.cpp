// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "sim/route/route.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

Eigen::Vector2d point(const Tree& pair) { return {pair.as_list().at(0).as_double(), pair.as_list().at(1).as_double()}; }

/// The shipped floor plan as this test needs it: centred walls, doors, rooms, boxes around columns and clutter.
class QuickstartRoutes : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* source = std::getenv("PLUMBLINE_SOURCE");
    const auto path =
        std::filesystem::path(source != nullptr ? source : ".") / "scenarios/library/quickstart.plan.yaml";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no plan at " << path;
    const Tree plan = read_yaml(read_text_file(path.string()), path.string());
    read_walls(plan);
    for (const Tree& room : plan.find("rooms")->as_list()) {
      Polygon2 polygon;
      for (const Tree& p : room.find("polygon")->as_list()) polygon.push_back(point(p));
      add_room(building_, room.find("id")->as_string(), polygon);
    }
    for (const char* key : {"columns", "clutter"})
      for (const Tree& item : plan.find(key)->as_list()) read_box(item);
  }

  bim::Building building_ = empty_storey();
  std::vector<Polygon2> solids_;  ///< everything but the walls

 private:
  void read_walls(const Tree& plan) {
    std::vector<std::string> ids;
    for (const Tree& wall : plan.find("walls")->as_list()) {
      ids.push_back(wall.find("id")->as_string());
      add_wall(building_, point(*wall.find("a")), point(*wall.find("b")), wall.find("thickness_m")->as_double());
    }
    for (const Tree& opening : plan.find("openings")->as_list()) {
      if (opening.find("kind")->as_string() != "door") continue;
      const auto wall = std::find(ids.begin(), ids.end(), opening.find("wall")->as_string()) - ids.begin();
      bim::Opening& door = add_door(building_, static_cast<int>(wall), opening.find("s_m")->as_double(),
                                    opening.find("width_m")->as_double());
      if (opening.find("leaf")->as_string() == "closed") door.leaf = bim::Leaf::closed;
    }
  }

  void read_box(const Tree& item) {
    const Eigen::Vector2d half = 0.5 * point(*item.find("size"));
    const Eigen::Vector2d at = point(*item.find("at"));
    solids_.push_back(rectangle(at - half, at + half));
    add_obstacle(building_, solids_.back(), 0.0, item.find("height_m")->as_double());
  }
};

TEST_F(QuickstartRoutes, EveryRoomIsReachedFromEveryOther) {
  const FreeSpace space(building_, 0);
  ASSERT_GE(building_.rooms.size(), 7U);
  std::vector<Eigen::Vector2d> targets;
  for (const bim::Room& room : building_.rooms) {
    const auto target = space.room_target(room.polygon);
    ASSERT_EQ(target.size(), 1U) << room.id;
    targets.push_back(target[0]);
  }
  for (const Eigen::Vector2d& a : targets) {
    for (const Eigen::Vector2d& b : targets) {
      const std::vector<Eigen::Vector2d> path = space.path(a, b);
      ASSERT_GE(path.size(), 2U);
      EXPECT_LE(path.size(), 12U);
      for (std::size_t i = 1; i < path.size(); ++i) {
        for (int k = 0; k <= 100; ++k) {
          const Eigen::Vector2d p = path[i - 1] + (path[i] - path[i - 1]) * (k / 100.0);
          EXPECT_TRUE(space.free(p)) << p.transpose();
          // Half a cell of planning and half a cell of bilinear clearance.
          for (const Polygon2& solid : solids_) EXPECT_GE(boundary_distance(solid, p), 0.40 - 0.05);
        }
      }
    }
  }
}

TEST_F(QuickstartRoutes, AreTheSameTwice) {
  const FreeSpace first(building_, 0);
  const FreeSpace second(building_, 0);
  const Eigen::Vector2d a = first.room_target(building_.rooms.front().polygon).at(0);
  const Eigen::Vector2d b = first.room_target(building_.rooms.back().polygon).at(0);
  EXPECT_EQ(first.path(a, b), second.path(a, b));
  EXPECT_EQ(first.path(a, b), first.path(a, b));
}

}  // namespace
}  // namespace plumbline::sim
