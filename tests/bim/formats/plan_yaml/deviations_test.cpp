// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/deviations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/mesh.h"
#include "bim/random/stream.h"
#include "tests/bim/formats/plan_yaml/plan_error.h"

namespace plumbline::bim {
namespace {

/// Three rooms in a row; the deviations of a test follow as lines 22 and on.
const std::string base =
    "plan: 1\n"                                                                                 // 1
    "storeys: [{id: ground, elevation_m: 0, height_m: 3}]\n"                                    // 2
    "walls:\n"                                                                                  // 3
    "  - {id: south, storey: ground, a: [0, 0], b: [12, 0], thickness_m: 0.2}\n"                // 4
    "  - {id: east, storey: ground, a: [12, 0], b: [12, 5], thickness_m: 0.2}\n"                // 5
    "  - {id: north, storey: ground, a: [12, 5], b: [0, 5], thickness_m: 0.2}\n"                // 6
    "  - {id: west, storey: ground, a: [0, 5], b: [0, 0], thickness_m: 0.2}\n"                  // 7
    "  - {id: p, storey: ground, a: [4, 0], b: [4, 5], thickness_m: 0.1}\n"                     // 8
    "  - {id: q, storey: ground, a: [8, 0], b: [8, 5], thickness_m: 0.1}\n"                     // 9
    "openings:\n"                                                                               // 10
    "  - {id: door_p, wall: p, kind: door, s_m: 2.5, width_m: 1, height_m: 2.1}\n"              // 11
    "  - {id: door_q, wall: q, kind: door, s_m: 2.5, width_m: 1, height_m: 2.1}\n"              // 12
    "  - {id: window, wall: east, kind: window, s_m: 2, width_m: 1, height_m: 1, sill_m: 1}\n"  // 13
    "rooms:\n"                                                                                  // 14
    "  - {id: one, storey: ground, polygon: [[0, 0], [4, 0], [4, 5], [0, 5]]}\n"                // 15
    "  - {id: two, storey: ground, polygon: [[4, 0], [8, 0], [8, 5], [4, 5]]}\n"                // 16
    "  - {id: three, storey: ground, polygon: [[8, 0], [12, 0], [12, 5], [8, 5]]}\n"            // 17
    "clutter:\n"                                                                                // 18
    "  - {id: crate, storey: ground, shape: box, at: [1, 1], size: [1, 0.5], height_m: 1}\n"    // 19
    "materials: [{id: brick, reflectivity: 0.3}]\n"                                             // 20
    "deviations:\n";                                                                            // 21

PlanWithDeviations site_of(const std::string& deviations) {
  return read_plan_with_deviations(base + deviations, "p.yaml");
}

std::vector<std::string> changes_of(const PlanWithDeviations& site) {
  std::vector<std::string> changes;
  for (const Change& change : site.as_built.changes) changes.push_back(change.op + " " + change.element);
  return changes;
}

template <class Element>
const Element& named(const std::vector<Element>& elements, const std::string& id) {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const Element& element) { return element.id == id; });
  if (found == elements.end()) throw std::runtime_error("no element " + id);
  return *found;
}

void expect_refusal(const std::string& deviations, const std::string& place, const std::string& part) {
  expect_plan_error(base + deviations, place, part);
}

void expect_closed(const Building& building) {
  for (const MeshElement& element : build_mesh(building).elements) EXPECT_TRUE(element.closed) << element.id;
}

TEST(Deviations, NoneLeaveEverythingAsPlanned) {
  const PlanWithDeviations site = read_plan_with_deviations(base.substr(0, base.find("deviations")), "p.yaml");
  EXPECT_EQ(site.as_planned.hash(), site.as_built.building.hash());
  EXPECT_TRUE(site.as_built.changes.empty());
}

TEST(Deviations, ThePlanStaysAsItWas) {
  const std::uint64_t planned = read_plan_text(base.substr(0, base.find("deviations")), "p.yaml").hash();
  for (const char* text : {"  - {op: move_wall, wall: p, by: [0.3, 0]}\n", "  - {op: remove_wall, wall: p}\n",
                           "  - {op: tilt_wall, wall: p, deg: 2}\n", "  - {op: remove_opening, opening: window}\n"}) {
    const PlanWithDeviations site = site_of(text);
    EXPECT_EQ(site.as_planned.hash(), planned) << text;
    EXPECT_NE(site.as_built.building.hash(), planned) << text;
    expect_closed(site.as_built.building);
  }
}

TEST(Deviations, MovedWallTakesItsOpeningsAndRoomsFollow) {
  const PlanWithDeviations site = site_of("  - {op: move_wall, wall: p, by: [0.3, 0]}\n");
  const Building& built = site.as_built.building;
  EXPECT_EQ(named(built.walls, "p").a, Eigen::Vector2d(4.3, 0));
  EXPECT_EQ(named(built.openings, "door_p").s_m, 2.5);
  EXPECT_NEAR(signed_area(named(built.rooms, "one").polygon), (4.3 - 0.05 - 0.1) * 4.8, 1e-9);
  EXPECT_NEAR(signed_area(named(built.rooms, "two").polygon), (4.0 - 0.1 - 0.3) * 4.8, 1e-9);
  EXPECT_EQ(named(built.rooms, "three").polygon, named(site.as_planned.rooms, "three").polygon);
  EXPECT_EQ(changes_of(site), (std::vector<std::string>{"move_wall p", "reshape_room one", "reshape_room two"}));
}

TEST(Deviations, MovingThereAndBackIsNothing) {
  const Stream stream(17, "bim.generate");
  const Building planned = read_plan_text(base.substr(0, base.find("deviations")), "p.yaml");
  const Tree list = read_yaml("[{op: move_wall}, {op: move_wall}]", "d.yaml");
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    // On a grid of powers of two a sum is undone exactly.
    const auto draw = [&](std::uint32_t i) { return std::floor(64.0 * stream.uniform(tick, 0, i) - 32.0) / 64.0; };
    PlanDeviationEntry there, back;
    there.target = back.target = planned.walls[tick % planned.walls.size()].id;
    there.by = {draw(0), draw(1)};
    back.by = -there.by;
    EXPECT_EQ(apply_deviations(planned, {there, back}, list).building.hash(), planned.hash()) << tick;
  }
}

TEST(Deviations, MovingKeepsTheVolumeOfTheWallAtRandom) {
  const Stream stream(18, "bim.generate");
  const Building planned = read_plan_text(base.substr(0, base.find("deviations")), "p.yaml");
  const BuildingMesh before = build_mesh(planned);
  const Tree list = read_yaml("[{op: move_wall}, {op: tilt_wall}]", "d.yaml");
  for (std::uint64_t tick = 0; tick < 30; ++tick) {
    PlanDeviationEntry move, tilt;
    const std::size_t wall = tick % planned.walls.size();
    move.target = tilt.target = planned.walls[wall].id;
    move.by = {stream.uniform(tick, 0, 0) - 0.5, stream.uniform(tick, 0, 1) - 0.5};
    tilt.op = DeviationOp::tilt_wall;
    tilt.deg = 10.0 * stream.uniform(tick, 0, 2) - 5.0;
    const BuildingMesh after = build_mesh(apply_deviations(planned, {move, tilt}, list).building);
    // 1 um of vertex grid on at most 60 m2 of surface.
    EXPECT_NEAR(after.elements[wall].volume_m3, before.elements[wall].volume_m3, 6e-5) << tick;
    EXPECT_TRUE(after.elements[wall].closed);
  }
}

TEST(Deviations, RemovedWallTakesItsOpeningsAwayAndJoinsRooms) {
  const PlanWithDeviations site = site_of("  - {op: remove_wall, wall: p}\n");
  const Building& built = site.as_built.building;
  EXPECT_EQ(built.walls.size(), 5U);
  EXPECT_EQ(built.openings.size(), 2U);
  EXPECT_EQ(built.walls[static_cast<std::size_t>(named(built.openings, "door_q").wall)].id, "q");
  EXPECT_EQ(changes_of(site),
            (std::vector<std::string>{"remove_wall p", "remove_opening door_p", "drop_room one", "reshape_room two"}));
  EXPECT_NEAR(signed_area(named(built.rooms, "two").polygon), 7.85 * 4.8, 1e-9);
  const Opening& door = named(built.openings, "door_q");
  EXPECT_EQ(built.rooms[static_cast<std::size_t>(door.rooms[0])].id, "two");
  EXPECT_EQ(built.rooms[static_cast<std::size_t>(door.rooms[1])].id, "three");
  for (const Room& room : built.rooms)
    for (const int wall : room.walls) EXPECT_LT(wall, 5);
}

TEST(Deviations, ARoomOpenToTheOutsideIsDropped) {
  const PlanWithDeviations site = site_of("  - {op: remove_wall, wall: west}\n");
  EXPECT_EQ(changes_of(site), (std::vector<std::string>{"remove_wall west", "drop_room one"}));
}

TEST(Deviations, AnAddedWallCutsARoomOff) {
  const PlanWithDeviations site = site_of(
      "  - {op: add_wall, id: new, storey: ground, a: [0, 3], b: [4, 3], thickness_m: 0.1, material: concrete}\n"
      "  - {op: add_opening, id: hatch, wall: new, kind: void, s_m: 2, width_m: 1, height_m: 2}\n");
  const Building& built = site.as_built.building;
  EXPECT_EQ(changes_of(site),
            (std::vector<std::string>{"add_wall new", "add_opening hatch", "reshape_room one", "add_room one-2"}));
  EXPECT_NEAR(signed_area(named(built.rooms, "one").polygon), 3.85 * 2.85, 1e-9);
  EXPECT_NEAR(signed_area(named(built.rooms, "one-2").polygon), 3.85 * 1.85, 1e-9);
  EXPECT_EQ(named(built.materials, "concrete").reflectivity, 0.4);
  expect_closed(built);
}

TEST(Deviations, RemovingAndAddingTheSameWallGivesTheSameSolids) {
  const PlanWithDeviations site = site_of(
      "  - {op: remove_wall, wall: q}\n"
      "  - {op: add_wall, id: q2, storey: ground, a: [8, 0], b: [8, 5], thickness_m: 0.1}\n"
      "  - {op: add_opening, id: door_q2, wall: q2, kind: door, s_m: 2.5, width_m: 1, height_m: 2.1}\n");
  const BuildingMesh planned = build_mesh(site.as_planned), built = build_mesh(site.as_built.building);
  EXPECT_EQ(built.vertices, planned.vertices);
  EXPECT_EQ(built.triangles, planned.triangles);
  for (const Room& room : site.as_planned.rooms)
    EXPECT_EQ(named(site.as_built.building.rooms, room.id).polygon, room.polygon);
}

TEST(Deviations, TiltedWallKeepsItsFoot) {
  const PlanWithDeviations site = site_of("  - {op: tilt_wall, wall: p, deg: 3}\n");
  const Building& built = site.as_built.building;
  const BuildingMesh mesh = build_mesh(built);
  const MeshElement& element = mesh.elements[4];
  ASSERT_EQ(element.id, "p");
  double foot = 0.0, head = 0.0;
  for (int t = 0; t < element.triangle_count; ++t) {
    const Eigen::Vector3i& triangle = mesh.triangles[static_cast<std::size_t>(element.first_triangle + t)];
    for (const int corner : triangle) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(corner)];
      (p.z() == 0.0 ? foot : head) = std::min(p.z() == 0.0 ? foot : head, p.x() - 4.0);
    }
  }
  EXPECT_NEAR(foot, -0.05, 1e-6);
  // To the left of a to b, which runs along +y, is -x.
  EXPECT_NEAR(head, -0.05 - 3.0 * std::tan(3.0 * std::numbers::pi / 180.0), 1e-6);
  EXPECT_EQ(changes_of(site), std::vector<std::string>{"tilt_wall p"});
}

TEST(Deviations, ClutterAndColumnsAreUnplanned) {
  const PlanWithDeviations site = site_of(
      "  - {op: add_clutter, id: pallet, storey: ground, shape: box, at: [6, 2], size: [1, 1], height_m: 0.5}\n"
      "  - {op: add_column, id: prop, storey: ground, at: [10, 2], size: [0.2, 0.2], material: metal}\n");
  const Building& built = site.as_built.building;
  EXPECT_FALSE(named(built.obstacles, "pallet").planned);
  EXPECT_TRUE(named(built.obstacles, "crate").planned);
  EXPECT_EQ(named(built.columns, "prop").material, "metal");
  EXPECT_EQ(site.as_planned.columns.size(), 0U);
  EXPECT_EQ(site.as_planned.obstacles.size(), 1U);
}

TEST(Deviations, OpeningsMoveAddAndGo) {
  const PlanWithDeviations site = site_of(
      "  - {op: move_opening, opening: door_p, by_m: -0.5}\n"
      "  - {op: remove_opening, opening: window}\n"
      "  - {op: add_opening, id: second, wall: p, kind: door, s_m: 4, width_m: 1, height_m: 2.1, leaf: closed}\n");
  const Building& built = site.as_built.building;
  EXPECT_EQ(named(built.openings, "door_p").s_m, 2.0);
  EXPECT_EQ(named(built.openings, "second").leaf, Leaf::closed);
  EXPECT_EQ(named(built.openings, "second").rooms[0], 0);
  EXPECT_EQ(built.openings.size(), 3U);
}

TEST(Deviations, WhatCannotBeBuiltIsRefusedAtItsLine) {
  expect_refusal("  - {op: move_wall, wall: pp, by: [0.3, 0]}\n", "22", "no wall 'pp' at this point");
  expect_refusal("  - {op: move_wal, wall: p, by: [0.3, 0]}\n", "22", "did you mean 'move_wall'");
  expect_refusal("  - {op: move_wall, wall: p, by: [0.3, 0], byy: 1}\n", "22", "did you mean 'by'");
  expect_refusal("  - {op: move_wall, wall: p}\n", "22", "by");
  expect_refusal("  - {op: move_wall, wall: p, by: [1e30, 0]}\n", "22", "by");
  expect_refusal("  - {op: move_wall, wall: p, by: [.nan, 0]}\n", "22", "by");
  expect_refusal("  - {op: tilt_wall, wall: p, deg: 45}\n", "22", "deg");
  expect_refusal("  - {op: move_opening, opening: door_p, by_m: 2.5}\n", "22", "beyond its wall 'p'");
  expect_refusal("  - {op: remove_wall, wall: p}\n  - {op: move_opening, opening: door_p, by_m: 0.1}\n", "23",
                 "no opening 'door_p' at this point");
  expect_refusal("  - {op: add_opening, id: o, wall: p, kind: void, s_m: 2.2, width_m: 0.5, height_m: 1}\n", "22",
                 "overlap 'door_p'");
  expect_refusal("  - {op: add_opening, id: o, wall: p, kind: void, s_m: 4, width_m: 0.5, height_m: 3.5}\n", "22",
                 "only 3 m high");
  expect_refusal("  - {op: add_opening, id: o, wall: p, kind: window, s_m: 4, width_m: 0.5, height_m: 1, leaf: open}\n",
                 "22", "only a door has a leaf");
  expect_refusal("  - {op: add_wall, id: p, storey: ground, a: [0, 0], b: [1, 0]}\n", "22", "the id 'p' is taken");
  expect_refusal("  - {op: add_wall, id: n, storey: ground, a: [1, 0], b: [1, 0]}\n", "22", "zero length");
  expect_refusal("  - {op: add_wall, id: n, storey: attic, a: [0, 0], b: [1, 0]}\n", "22", "no storey 'attic'");
  expect_refusal("  - {op: add_wall, id: n, storey: ground, a: [0, 0], b: [1, 0], material: wod}\n", "22",
                 "did you mean 'wood'");
  expect_refusal("  - {op: add_wall, id: n, storey: ground, a: [0, 0], b: [1, 0], thickness_m: -1}\n", "22",
                 "thickness_m");
  expect_refusal("  - {op: add_clutter, id: crate, storey: ground, at: [6, 2], size: [1, 1]}\n", "22", "taken");
  expect_refusal("  - {wall: p}\n", "22", "op");
}

TEST(Deviations, OneWallMustStand) {
  std::string all;
  for (const char* wall : {"south", "east", "north", "west", "p", "q"})
    all += std::string("  - {op: remove_wall, wall: ") + wall + "}\n";
  expect_refusal(all, "22", "remove every wall");
}

TEST(Deviations, WallsOfACopiedStoreyHaveTheirOwn) {
  std::string text = base;
  text.replace(text.find("height_m: 3}]"), 13, "height_m: 3}, {id: first, elevation_m: 3.2, copy_of: ground}]");
  const PlanWithDeviations site =
      read_plan_with_deviations(text + "  - {op: move_wall, wall: first/p, by: [0.2, 0]}\n", "p.yaml");
  EXPECT_EQ(named(site.as_built.building.walls, "p").a.x(), 4.0);
  EXPECT_EQ(named(site.as_built.building.walls, "first/p").a.x(), 4.2);
  EXPECT_EQ(changes_of(site),
            (std::vector<std::string>{"move_wall first/p", "reshape_room first/one", "reshape_room first/two"}));
}

}  // namespace
}  // namespace plumbline::bim
