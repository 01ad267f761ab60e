// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_yaml.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bim/errors.h"
#include "bim/mesh/mesh.h"
#include "bim/random/stream.h"
#include "tests/bim/formats/plan_yaml/plan_error.h"

namespace plumbline::bim {
namespace {

/// A sound plan, one element a line, so that tests can name the line they spoil.
const std::string sound =
    "plan: 1\n"                                                                                 // 1
    "name: two rooms\n"                                                                         // 2
    "storeys:\n"                                                                                // 3
    "  - {id: ground, elevation_m: 0, height_m: 3}\n"                                           // 4
    "walls:\n"                                                                                  // 5
    "  - {id: south, storey: ground, a: [0, 0], b: [8, 0], thickness_m: 0.2}\n"                 // 6
    "  - {id: east, storey: ground, a: [8, 0], b: [8, 5], thickness_m: 0.2}\n"                  // 7
    "  - {id: north, storey: ground, a: [8, 5], b: [0, 5], thickness_m: 0.2}\n"                 // 8
    "  - {id: west, storey: ground, a: [0, 5], b: [0, 0], thickness_m: 0.2}\n"                  // 9
    "  - {id: middle, storey: ground, a: [4, 0], b: [4, 5], thickness_m: 0.1}\n"                // 10
    "openings:\n"                                                                               // 11
    "  - {id: door, wall: middle, kind: door, s_m: 2.5, width_m: 1, height_m: 2.1}\n"           // 12
    "  - {id: window, wall: east, kind: window, s_m: 2, width_m: 1, height_m: 1, sill_m: 1}\n"  // 13
    "rooms:\n"                                                                                  // 14
    "  - {id: kitchen, storey: ground, polygon: [[0, 0], [4, 0], [4, 5], [0, 5]]}\n"            // 15
    "  - {id: hall, storey: ground, polygon: [[4, 0], [8, 0], [8, 5], [4, 5]]}\n"               // 16
    "columns:\n"                                                                                // 17
    "  - {id: post, storey: ground, at: [6, 4], size: [0.3, 0.3]}\n"                            // 18
    "clutter:\n"                                                                                // 19
    "  - {id: crate, storey: ground, shape: box, at: [1, 1], size: [1, 0.5], height_m: 1}\n";   // 20

std::string with(const std::string& from, const std::string& to) {
  std::string text = sound;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(PlanYaml, ReadsWhatIsWritten) {
  const Building building = read_plan_text(sound, "p.yaml");
  EXPECT_EQ(building.name, "two rooms");
  EXPECT_EQ(building.schema, "plan");
  ASSERT_EQ(building.walls.size(), 5U);
  EXPECT_EQ(building.walls[4].id, "middle");
  EXPECT_EQ(building.walls[4].thickness_m, 0.1);
  EXPECT_EQ(building.walls[4].offset_m, -0.05);
  EXPECT_EQ(building.walls[4].z1_m, 3.0);
  ASSERT_EQ(building.openings.size(), 2U);
  EXPECT_EQ(building.openings[0].id, "window");  // openings follow the order of their walls
  EXPECT_EQ(building.openings[0].leaf, Leaf::none);
  EXPECT_EQ(building.openings[1].wall, 4);
  EXPECT_EQ(building.openings[1].leaf, Leaf::open);
  EXPECT_EQ(building.openings[1].rooms[0], 0);
  EXPECT_EQ(building.openings[1].rooms[1], 1);
  EXPECT_EQ(building.columns.size(), 1U);
  EXPECT_EQ(building.obstacles.size(), 1U);
  EXPECT_TRUE(building.warnings.empty());
}

TEST(PlanYaml, RoomsAreTheClearOutlineWithTheirWalls) {
  const Building building = read_plan_text(sound, "p.yaml");
  ASSERT_EQ(building.rooms.size(), 2U);
  EXPECT_EQ(building.rooms[0].polygon, (Polygon2{{0.1, 0.1}, {3.95, 0.1}, {3.95, 4.9}, {0.1, 4.9}}));
  EXPECT_EQ(building.rooms[0].walls, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(building.rooms[1].walls, (std::vector<int>{0, 1, 2, 4}));
}

TEST(PlanYaml, ClockwiseRoomsAndNamedWalls) {
  const Building building = read_plan_text(with("polygon: [[0, 0], [4, 0], [4, 5], [0, 5]]",
                                                "polygon: [[0, 0], [0, 5], [4, 5], [4, 0]], walls: [west, south]"),
                                           "p.yaml");
  EXPECT_GT(signed_area(building.rooms[0].polygon), 0.0);
  EXPECT_EQ(building.rooms[0].walls, (std::vector<int>{0, 3}));
}

TEST(PlanYaml, JustSaysWhereTheLineLiesInTheThickness) {
  const auto offset = [](const std::string& just) {
    const Building building =
        read_plan_text(with("b: [8, 0], thickness_m: 0.2", "b: [8, 0], thickness_m: 0.2, just: " + just), "p.yaml");
    return building.walls[0].offset_m;
  };
  EXPECT_EQ(offset("center"), -0.1);
  EXPECT_EQ(offset("left"), -0.2);  // the line is the wall's left face: the body lies to its right
  EXPECT_EQ(offset("right"), 0.0);
}

TEST(PlanYaml, EveryStoreyGetsFloorAndCeiling) {
  const Building building = read_plan_text(sound, "p.yaml");
  ASSERT_EQ(building.slabs.size(), 2U);
  EXPECT_EQ(building.slabs[0].id, "ground/floor");
  EXPECT_NEAR(building.slabs[0].z0_m, -0.2, 1e-12);
  EXPECT_EQ(building.slabs[0].z1_m, 0.0);
  EXPECT_EQ(building.slabs[1].z0_m, 3.0);
  EXPECT_TRUE(building.slabs[0].polygon.holes.empty());
  // 8.2 x 5.2 m less the four outer corners that no wall fills.
  EXPECT_NEAR(signed_area(building.slabs[0].polygon.outer), 8.2 * 5.2 - 4 * 0.01, 1e-9);
}

TEST(PlanYaml, CopiedStoreyRepeatsItsSource) {
  const Building building = read_plan_text(
      with("height_m: 3}\n", "height_m: 3}\n  - {id: first, elevation_m: 3.3, copy_of: ground}\n"), "p.yaml");
  ASSERT_EQ(building.storeys.size(), 2U);
  EXPECT_EQ(building.storeys[1].height_m, 3.0);
  ASSERT_EQ(building.walls.size(), 10U);
  EXPECT_EQ(building.walls[9].id, "first/middle");
  EXPECT_EQ(building.walls[9].z0_m, 3.3);
  EXPECT_EQ(building.rooms[3].id, "first/hall");
  EXPECT_EQ(building.rooms[3].walls, (std::vector<int>{5, 6, 7, 9}));
  EXPECT_EQ(building.openings[3].rooms[0], 2);
  EXPECT_EQ(building.obstacles[1].id, "first/crate");
  // The upper floor, 3.1 to 3.3 m, lies on the lower ceiling, 3.0 to 3.2 m.
  EXPECT_NEAR(building.slabs[2].z0_m, 3.1, 1e-12);
  EXPECT_NEAR(building.slabs[1].z1_m, 3.2, 1e-12);
}

TEST(PlanYaml, CeilingUnderAStoreyIsTheSlabItStandsOn) {
  const Building building = read_plan_text(
      with("height_m: 3}\n", "height_m: 3}\n  - {id: first, elevation_m: 3, copy_of: ground}\n"), "p.yaml");
  EXPECT_NEAR(building.slabs[1].z0_m, 2.8, 1e-12);
  EXPECT_NEAR(building.slabs[1].z1_m, 3.0, 1e-12);
  EXPECT_NEAR(building.rooms[0].z1_m, 2.8, 1e-12);
  EXPECT_NEAR(building.slabs[3].z0_m, 6.0, 1e-12);
}

TEST(PlanYaml, MaterialsAreKeptAndWhatIsSeenThroughIsSaid) {
  const Building building =
      read_plan_text(sound + "materials:\n  - {id: glass, reflectivity: 0.1, transmission: 0.8}\n", "p.yaml");
  ASSERT_EQ(building.materials.size(), 1U);
  EXPECT_EQ(building.materials[0].transmission, 0.8);
  ASSERT_EQ(building.warnings.size(), 1U);
  EXPECT_EQ(building.warnings[0].kind, "see_through");
}

TEST(PlanYaml, MeshOfAPlanIsClosed) {
  const BuildingMesh mesh = build_mesh(read_plan_text(sound, "p.yaml"));
  EXPECT_EQ(mesh.elements.size(), 5U + 2U + 1U + 1U);
  for (const MeshElement& element : mesh.elements) EXPECT_TRUE(element.closed) << element.id;
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST(PlanYamlErrors, KindAndVersion) {
  expect_plan_error("name: x\nplan: 1\n", "1:1", "first key must be 'plan: 1'");
  expect_plan_error("levels:\n  L1: {}\n", "1:1", "first key must be 'plan: 1'");
  expect_plan_error("[1, 2]\n", "1:1", "first key");
  expect_plan_error(with("plan: 1", "plan: 2"), "1:7", "out of range");
}

TEST(PlanYamlErrors, KeysTypesAndRanges) {
  expect_plan_error(with("b: [8, 0], thickness_m", "b: [8, 0], thicknes_m"), "6", "did you mean 'thickness_m'");
  expect_plan_error(with("name: two rooms\n", "name: two rooms\nname: again\n"), "3:1", "duplicate key 'name'");
  expect_plan_error(with("a: [0, 0], b: [8, 0]", "a: [0, 0], a: [8, 0]"), "6", "duplicate key 'a'");
  expect_plan_error(with("b: [8, 0]", "b: [8, zero]"), "6", "'b'");
  expect_plan_error(with("b: [8, 0]", "b: [8]"), "6", "two numbers");
  expect_plan_error(with("b: [8, 0], ", ""), "6:5", "'b' is missing");
  expect_plan_error(with("b: [8, 0], thickness_m: 0.2", "b: [8, 0], thickness_m: -0.2"), "6", "out of range");
  expect_plan_error(with("b: [8, 0]", "b: [8, .nan]"), "6", "'b'");
  expect_plan_error(with("kind: door", "kind: dor"), "12", "did you mean 'door'");
}

TEST(PlanYamlErrors, EmptyLists) {
  expect_plan_error("plan: 1\nstoreys: []\nwalls: []\n", "2", "no storeys");
  expect_plan_error("plan: 1\nstoreys: [{id: g}]\nwalls: []\n", "3", "no walls");
  expect_plan_error("plan: 1\nstoreys: [{id: g}]\n", "1:1", "'walls' is missing");
}

TEST(PlanYamlErrors, Ids) {
  expect_plan_error(with("id: east", "id: south"), "7", "'south' is taken");
  expect_plan_error(with("id: post", "id: south"), "18", "'south' is taken");
  expect_plan_error(with("id: hall", "id: kitchen"), "16", "'kitchen' is taken");
  expect_plan_error(with("id: window", "id: door"), "13", "'door' is taken");
  expect_plan_error(with("id: east", "id: a/b"), "7", "'/'");
  expect_plan_error(with("id: east", "id: ''"), "7", "must not be empty");
}

TEST(PlanYamlErrors, References) {
  expect_plan_error(with("id: east, storey: ground", "id: east, storey: grund"), "7", "did you mean 'ground'");
  expect_plan_error(with("wall: middle", "wall: midle"), "12", "did you mean 'middle'");
  expect_plan_error(with("id: hall, storey: ground", "id: hall, storey: roof"), "16", "no storey 'roof'");
  expect_plan_error(with("id: post, storey: ground", "id: post, storey: roof"), "18", "no storey 'roof'");
  expect_plan_error(with("b: [8, 0],", "b: [8, 0], material: gold,"), "6", "no material 'gold'");
  expect_plan_error(with("[8, 5], [4, 5]]}", "[8, 5], [4, 5]], walls: [east, nowhere]}"), "16", "no wall 'nowhere'");
}

TEST(PlanYamlErrors, Storeys) {
  const auto and_storey = [](const std::string& entry) {
    return with("height_m: 3}\n", "height_m: 3}\n  - " + entry + "\n");
  };
  expect_plan_error(and_storey("{id: first, elevation_m: 2}"), "5", "at least 3 m");
  expect_plan_error(and_storey("{id: first, elevation_m: 3, copy_of: roof}"), "5", "no storey 'roof'");
  expect_plan_error(and_storey("{id: first, elevation_m: 3, copy_of: first}"), "5", "copies itself");
  expect_plan_error(and_storey("{id: x, elevation_m: 3, copy_of: ground}\n  - {id: y, elevation_m: 6, copy_of: x}"),
                    "6", "copy itself");
}

TEST(PlanYamlErrors, WallsAndOpeningsFitTheLowestCopyOfTheirStorey) {
  const auto copied = [](const std::string& from, const std::string& to) {
    std::string text = with(from, to);
    const std::string storey = "height_m: 3}\n";
    return text.insert(text.find(storey) + storey.size(),
                       "  - {id: low, elevation_m: 3.3, height_m: 2.4, copy_of: ground}\n");
  };
  EXPECT_EQ(error_of(copied("b: [8, 0],", "b: [8, 0], height_m: 2.4,")), "no error");
  expect_plan_error(copied("b: [8, 0],", "b: [8, 0], height_m: 2.9,"), "7",
                    "wall 'south' is higher than 'low', the copy of its storey, 2.4 m");
  expect_plan_error(copied("width_m: 1, height_m: 2.1}", "width_m: 1, height_m: 2.8}"), "13",
                    "its wall 'middle' is only 2.4 m high on 'low', the copy of its storey");
}

TEST(PlanYamlErrors, TooManyCorners) {
  std::string corners = "polygon: [";
  for (int i = 0; i <= 2000; ++i) corners += "[" + std::to_string(i) + ", 0], ";
  expect_plan_error(with("polygon: [", corners), "15", "at most 2000 can be read");
}

TEST(PlanYamlErrors, WallsAndOpenings) {
  expect_plan_error(with("b: [8, 0]", "b: [0, 0]"), "6", "zero length");
  expect_plan_error(with("b: [8, 0], thickness_m: 0.2", "b: [8, 0], height_m: 4"), "6", "higher than its storey");
  expect_plan_error(with("s_m: 2.5, width_m: 1", "s_m: 2.5, width_m: 6"), "12",
                    "6 m wide, its wall 'middle' only 5 m long");
  expect_plan_error(with("s_m: 2.5", "s_m: 0.4"), "12", "between 0.5 m and 4.5 m");
  expect_plan_error(with("s_m: 2.5", "s_m: 4.6"), "12", "reaches beyond");
  expect_plan_error(with("height_m: 2.1}", "height_m: 2.1, sill_m: 1}"), "12", "only 3 m high");
  expect_plan_error(with("wall: east", "wall: middle"), "13", "overlaps 'door'");
  expect_plan_error(with("sill_m: 1}", "sill_m: 1, leaf: open}"), "13", "only a door has a leaf");
}

TEST(PlanYamlErrors, Rooms) {
  expect_plan_error(with("[[0, 0], [4, 0], [4, 5], [0, 5]]", "[[0, 0], [4, 0]]"), "15", "at least 3 corners");
  expect_plan_error(with("[[0, 0], [4, 0], [4, 5], [0, 5]]", "[[0, 0], [4, 5], [4, 0], [0, 5]]"), "15",
                    "crosses itself");
  expect_plan_error(with("[[0, 0], [4, 0], [4, 5], [0, 5]]", "[[0, 0], [5, 0], [5, 5], [0, 5]]"), "15",
                    "a wall divides room");
  expect_plan_error(with("[8, 5], [4, 5]]}",
                         "[8, 5], [4, 5]]}\n  - {id: bay, storey: ground, polygon: [[6, 0], [8, 0], [8, 2], [6, 2]]}"),
                    "17", "overlaps room 'hall'");
  expect_plan_error(with("[[0, 0], [4, 0], [4, 5], [0, 5]]", "[[1, 1], [2, 1], [2, 2], [1, 2]]"), "15",
                    "no wall runs along");
  expect_plan_error(with("[[0, 0], [4, 0], [4, 5], [0, 5]]", "[[1, 0], [2, 0], [2, 0.05], [1, 0.05]]"), "15",
                    "inside walls");
}

int plan_warnings(const Building& building, const std::string& kind) {
  return static_cast<int>(std::count_if(building.warnings.begin(), building.warnings.end(),
                                        [&](const Warning& warning) { return warning.kind == kind; }));
}

/// A round hall of 24 walls with an annex before the first, whose outline runs through the corners of the hall.
TEST(PlanYaml, RoundRoomsHaveSimpleOutlines) {
  std::string walls, hall;
  const auto corner = [](int i) {
    const double angle = 2.0 * 3.14159265358979 * (i % 24) / 24;
    char text[64];
    std::snprintf(text, sizeof text, "[%.6f, %.6f]", 9.0 * std::cos(angle), 9.0 * std::sin(angle));
    return std::string(text);
  };
  const auto wall = [&](const std::string& id, const std::string& a, const std::string& b, const std::string& thick) {
    walls += "  - {id: " + id + ", storey: g, a: " + a + ", b: " + b + ", thickness_m: " + thick + "}\n";
  };
  for (int i = 0; i < 24; ++i) {
    wall("w" + std::to_string(i), corner(i), corner(i + 1), "0.3");
    hall += (i > 0 ? ", " : "") + corner(i);
  }
  const std::string s = "[9.261052, -1.98289]", se = "[14.218277, -1.330259]", ne = "[13.389504, 4.964892]",
                    n = "[8.43228, 4.312261]";
  wall("south", s, se, "0.2");
  wall("east", se, ne, "0.2");
  wall("north", ne, n, "0.2");
  wall("left", corner(0), s, "0.2");
  wall("right", n, corner(1), "0.2");
  const Building building =
      read_plan_text("plan: 1\nstoreys: [{id: g, height_m: 5}]\nwalls:\n" + walls +
                         "openings:\n  - {id: d, wall: w0, s_m: 1.174736, width_m: 1.2}\nrooms:\n" +
                         "  - {id: hall, storey: g, polygon: [" + hall + "]}\n  - {id: annex, storey: g, polygon: [" +
                         s + ", " + se + ", " + ne + ", " + n + "]}\n",
                     "round.yaml");
  ASSERT_EQ(building.rooms.size(), 2U);
  for (const Room& room : building.rooms) EXPECT_TRUE(is_simple(room.polygon)) << room.id;
  EXPECT_EQ(std::max(building.openings[0].rooms[0], building.openings[0].rooms[1]), 1);
  EXPECT_EQ(std::min(building.openings[0].rooms[0], building.openings[0].rooms[1]), 0);
}

TEST(PlanYaml, LengthsInMillimetresAreDoubted) {
  EXPECT_EQ(plan_warnings(read_plan_text(sound, "p.yaml"), "odd_size"), 0);
  const std::string storeys = "storeys: [{id: g, height_m: 3}]\n";
  const std::string hall = "plan: 1\n" + storeys +
                           "walls:\n  - {id: s, storey: g, a: [0, 0], b: [9000, 0]}\n"
                           "  - {id: e, storey: g, a: [9000, 0], b: [9000, 5000]}\n";
  EXPECT_EQ(plan_warnings(read_plan_text(hall, "p.yaml"), "odd_size"), 1);
  const std::string desk =
      sound + "  - {id: desk, storey: ground, shape: box, at: [2, 2], size: [800, 600], height_m: 0.75}\n";
  EXPECT_EQ(plan_warnings(read_plan_text(desk, "p.yaml"), "odd_size"), 1);
}

TEST(PlanYaml, ADoorThatAWallOrAColumnFillsIsSaid) {
  const std::string wall = "thickness_m: 0.1}\n", door = "height_m: 2.1}\n";
  const std::string second = "  - {id: second, storey: ground, a: [4, 0], b: [4, 5], " + wall;
  EXPECT_EQ(plan_warnings(read_plan_text(sound, "p.yaml"), "blocked_door"), 0);
  EXPECT_EQ(plan_warnings(read_plan_text(with(wall, wall + second), "p.yaml"), "blocked_door"), 1);
  std::string both = with(wall, wall + second);
  both.insert(both.find(door) + door.size(),
              "  - {id: other, wall: second, kind: door, s_m: 2.5, width_m: 1, height_m: 2.1}\n");
  EXPECT_EQ(plan_warnings(read_plan_text(both, "p.yaml"), "blocked_door"), 0) << "both leaves have the doorway";
  const auto hatch_with_sill = [&](const std::string& sill_m) {
    std::string text = with(wall, wall + second);
    text.replace(text.find("kind: door"), 10, "kind: void, sill_m: " + sill_m);
    return plan_warnings(read_plan_text(text, "p.yaml"), "blocked_door");
  };
  EXPECT_EQ(hatch_with_sill("0.1"), 1);
  EXPECT_EQ(hatch_with_sill("0.6"), 0) << "nobody goes through it";
  const auto post_at = [&](const std::string& at) {
    return plan_warnings(read_plan_text(with("at: [6, 4]", "at: " + at), "p.yaml"), "blocked_door");
  };
  EXPECT_EQ(post_at("[4.3, 2.5]"), 1);
  EXPECT_EQ(post_at("[4.3, 3.0]"), 0) << "0.85 m of the doorway are free";
  EXPECT_EQ(post_at("[5.0, 2.5]"), 0) << "it stands in the room";
}

TEST(PlanYamlErrors, WhatIsNotSimulated) { EXPECT_EQ(error_of(sound + "stairs: []\ndeviations: []\n"), "no error"); }

/// Whatever is written, the answer is a building or an InputError: no other exception, no crash.
TEST(PlanYamlErrors, SpoiltTextIsReadOrRefused) {
  const Stream stream(11, "bim.generate");
  const std::string ink = "0123456789.-,:[]{}' \nabdrsw";
  int refused = 0;
  for (std::uint64_t tick = 0; tick < 400; ++tick) {
    std::string text = sound;
    for (std::uint32_t k = 0; k <= tick % 3; ++k) {
      const auto at = static_cast<std::size_t>(stream.uniform(tick, 0, k) * static_cast<double>(text.size()));
      const auto letter = static_cast<std::size_t>(stream.uniform(tick, 1, k) * static_cast<double>(ink.size()));
      text[at] = ink[letter];
    }
    refused += error_of(text) == "no error" ? 0 : 1;
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 400);
}

TEST(PlanYaml, ListsTooLongAreRefusedAtOnce) {
  std::string text = "plan: 1\nstoreys: [{id: g}]\nwalls:\n";
  for (int i = 0; i <= 20000; ++i) text += "- {id: w" + std::to_string(i) + ", storey: g, a: [0, 0], b: [1, 0]}\n";
  expect_plan_error(text, "4", "lists 20001 walls; at most 20000");
}

}  // namespace
}  // namespace plumbline::bim
