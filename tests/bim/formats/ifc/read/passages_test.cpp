// SPDX-License-Identifier: Apache-2.0
// Ways from room to room that are no doors in walls: gaps in a wall's body, doors of curtain walls, holes through
// several walls or parts of one.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/model/adjacency.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

void space(Sketch& sketch, const std::string& storey, const std::string& name, double x0, double x1) {
  const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
  const std::string id =
      sketch.rooted("IFCSPACE", "'" + name + "',$,$," + at + "," + sketch.shape(sketch.box(x0, 0.1, 0, x1, 5.9, 2.8)) +
                                    ",$,.ELEMENT.,.INTERNAL.,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + id + ")");
}

/// A hall of 8 by 6 m with a space on either side of x = 4, `gap_m` from each other.
void two_spaces(Sketch& sketch, double gap_m) {
  const std::string storey = sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 3);
  for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
  space(sketch, storey, "left", 0.1, 4.0 - 0.5 * gap_m);
  space(sketch, storey, "right", 4.0 + 0.5 * gap_m, 7.9);
}

std::string across(Sketch& sketch) { return sketch.frame(4, 0, 0, "0.,0.,1.", "0.,1.,0."); }

/// A wall of 0.3 m between the two; `body` draws it along x.
Building divided_by(const std::function<std::string(Sketch&)>& body) {
  Sketch sketch;
  two_spaces(sketch, 0.3);
  sketch.element("IFCWALL", sketch.wall_shape(body(sketch), 6), "$,$", across(sketch));
  return read(sketch);
}

void expect_open(const Building& building) {
  const std::vector<Adjacent> pairs = adjacency(building);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs.front().by, Passage::open_edge);
  EXPECT_EQ(std::pair(pairs.front().a, pairs.front().b), std::pair(0, 1));
  EXPECT_NEAR(pairs.front().width_m, 0.9, 0.11);
}

TEST(Passages, LeadThroughAGapInTheBodyOfAThickWall) {
  expect_open(divided_by(
      [](Sketch& sketch) { return sketch.box(0, -0.15, 0, 2, 0.15, 3) + "," + sketch.box(3, -0.15, 0, 6, 0.15, 3); }));
  expect_open(divided_by([](Sketch& sketch) {
    return sketch.box(0, -0.15, 0, 2, 0.15, 3) + "," + sketch.box(3, -0.15, 0, 6, 0.15, 3) + "," +
           sketch.box(2, -0.15, 2.1, 3, 0.15, 3);
  }));
}

TEST(Passages, LeadThroughANotchInTheProfileOfAWall) {
  expect_open(divided_by([](Sketch& sketch) {
    const std::string profile =
        sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," +
                   sketch.polyline({{0, 0}, {2, 0}, {2, 2.1}, {3, 2.1}, {3, 0}, {6, 0}, {6, 3}, {0, 3}}) + ")");
    return sketch.add("IFCEXTRUDEDAREASOLID(" + profile + "," + sketch.frame(0, 0.15, 0, "0.,-1.,0.", "1.,0.,0.") +
                      "," + sketch.add("IFCDIRECTION((0.,0.,1.))") + ",0.3)");
  }));
}

TEST(Passages, DoNotLeadThroughANicheOrAWindow) {
  for (const bool niche : {true, false}) {
    const Building building = divided_by([&](Sketch& sketch) {
      const double sill = niche ? 0.0 : 0.9;
      return sketch.box(0, -0.15, 0, 2, 0.15, 3) + "," + sketch.box(3, -0.15, 0, 6, 0.15, 3) + "," +
             (niche ? sketch.box(2, -0.15, 0, 3, -0.05, 3)
                    : sketch.box(2, -0.15, 0, 3, 0.15, sill) + "," + sketch.box(2, -0.15, 2.1, 3, 0.15, 3));
    });
    EXPECT_TRUE(adjacency(building).empty()) << niche;
  }
}

enum class CurtainDoor { aggregated, filling, loose };

/// Two panels with a door and a panel over it between them.
Sketch curtain(CurtainDoor how, double gap_m) {
  Sketch sketch;
  two_spaces(sketch, gap_m);
  const auto part = [&](const std::string& type, double y0, double y1, double z0, double z1, const std::string& rest) {
    const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
    return sketch.rooted(
        type, "'" + type + "',$,$," + at + "," + sketch.shape(sketch.box(3.97, y0, z0, 4.03, y1, z1)) + "," + rest);
  };
  std::string parts = part("IFCPLATE", 0.1, 2, 0, 3, "$,$") + "," + part("IFCPLATE", 3, 5.9, 0, 3, "$,$") + "," +
                      part("IFCPLATE", 2, 3, 2.1, 3, "$,$");
  const std::string front = sketch.element("IFCCURTAINWALL", "$", "$,$");
  if (how == CurtainDoor::loose) {
    sketch.element("IFCDOOR", sketch.shape(sketch.box(3.97, 2, 0, 4.03, 3, 2.1)), "$,2.1,1.,$,$,$");
  } else if (how == CurtainDoor::aggregated) {
    parts += "," + part("IFCDOOR", 2, 3, 0, 2.1, "$,2.1,1.,$,$,$");
  } else {
    sketch.door(sketch.opening(front, sketch.box(3.9, 2, 0, 4.1, 3, 2.1)));
  }
  sketch.rooted("IFCRELAGGREGATES", "$,$," + front + ",(" + parts + ")");
  return sketch;
}

TEST(Passages, DoorsOfACurtainWallAreDoors) {
  for (const CurtainDoor how : {CurtainDoor::aggregated, CurtainDoor::filling, CurtainDoor::loose})
    for (const double gap_m : {0.06, 0.3}) {
      const Building building = read(curtain(how, gap_m));
      const std::vector<Adjacent> pairs = adjacency(building);
      ASSERT_EQ(pairs.size(), 1u) << static_cast<int>(how) << " " << gap_m;
      EXPECT_EQ(pairs.front().by, Passage::door);
      EXPECT_EQ(std::pair(pairs.front().a, pairs.front().b), std::pair(0, 1));
      EXPECT_NEAR(pairs.front().width_m, 1.0, 1e-6);
      EXPECT_FALSE(pairs.front().element.empty());
    }
}

TEST(Passages, DoorsOfACurtainWallAreWrittenAndReadAgain) {
  const Building building = read(curtain(CurtainDoor::aggregated, 0.06));
  const Building again = read_ifc_text(write_ifc(building), "again.ifc");
  EXPECT_EQ(again.hash(), building.hash());
  ASSERT_EQ(adjacency(again).size(), 1u);
  EXPECT_EQ(adjacency(again).front().by, Passage::door);
}

/// A wall of two leaves, with or without a body of its own; which of the three are cut for the door.
Building leaves(bool own_body, bool cut_wall, bool cut_parts) {
  Sketch sketch;
  two_spaces(sketch, 0.3);
  const std::string wall = sketch.element(
      "IFCWALL", own_body ? sketch.wall_shape(sketch.box(0, -0.15, 0, 6, 0.15, 3), 6) : "$", "$,$", across(sketch));
  std::string parts;
  std::vector<std::string> all;
  for (const double y : {-0.15, 0.0}) {
    const std::string at = sketch.add("IFCLOCALPLACEMENT($," + across(sketch) + ")");
    all.push_back(sketch.rooted("IFCBUILDINGELEMENTPART",
                                "'leaf',$,$," + at + "," + sketch.shape(sketch.box(0, y, 0, 6, y + 0.15, 3)) + ",$,$"));
    parts += (parts.empty() ? "" : ",") + all.back();
  }
  sketch.rooted("IFCRELAGGREGATES", "$,$," + wall + ",(" + parts + ")");
  if (cut_parts)
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double x0 = i == 0 ? 4.0 : 3.7;  // no deeper than the leaf itself
      const std::string hole = sketch.opening(all[i], sketch.box(x0, 2, 0, x0 + 0.3, 3, 2.1));
      if (!cut_wall && i == 0) sketch.door(hole);
    }
  if (cut_wall) sketch.door(sketch.opening(wall, sketch.box(3.7, 2, 0, 4.3, 3, 2.1)));
  return read(sketch);
}

TEST(Passages, AHoleThroughTheLeavesOfAWallCountsOnce) {
  for (const bool own_body : {true, false})
    for (const bool cut_wall : {true, false}) {
      const Building building = leaves(own_body, cut_wall, true);
      ASSERT_EQ(building.openings.size(), 1u) << own_body << cut_wall;
      EXPECT_EQ(building.openings.front().kind, OpeningKind::door);
      EXPECT_EQ(count(building, "niche"), 0) << own_body << cut_wall;
      const std::vector<Adjacent> pairs = adjacency(building);
      ASSERT_EQ(pairs.size(), 1u);
      EXPECT_EQ(pairs.front().by, Passage::door);
    }
}

TEST(Passages, AHoleThroughWallsUponEachOtherCountsOnce) {
  for (const bool own_hole : {true, false}) {
    Sketch sketch;
    two_spaces(sketch, 0.3);
    const std::string low = sketch.wall(4, 0, 6, 0.3, 1.5, true);
    const std::string high =
        sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.15, 1.5, 6, 0.15, 3), 6), "$,$", across(sketch));
    sketch.door(sketch.opening(low, sketch.box(3.7, 2, 0, 4.3, 3, 2.1)));
    if (own_hole) sketch.opening(high, sketch.box(3.7, 2, 0, 4.3, 3, 2.1));
    const Building building = read(sketch);
    ASSERT_EQ(building.openings.size(), 2u);
    const std::vector<bool> continued = continued_openings(building);
    EXPECT_EQ(std::count(continued.begin(), continued.end(), true), 1) << own_hole;
    const std::vector<Adjacent> pairs = adjacency(building);
    ASSERT_EQ(pairs.size(), 1u) << own_hole;
    EXPECT_EQ(pairs.front().by, Passage::door);
  }
}

}  // namespace
}  // namespace plumbline::bim
