// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/formats/plan_yaml/stair_builder.h"
#include "bim/formats/plan_yaml/stairwell.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/mesh.h"
#include "bim/model/stair_flight.h"
#include "bim/random/stream.h"
#include "bim/rays/ray_scene.h"
#include "tests/bim/formats/plan_yaml/plan_error.h"

namespace plumbline::bim {
namespace {

/// A hall of 10 x 6 m under another; the stairs of a test follow as line 10 and on.
const std::string base =
    "plan: 1\n"                                                                             // 1
    "storeys: [{id: lower, height_m: 2.8}, {id: upper, elevation_m: 3, copy_of: lower}]\n"  // 2
    "walls:\n"                                                                              // 3
    "  - {id: s, storey: lower, a: [0, 0], b: [10, 0], thickness_m: 0.2}\n"                 // 4
    "  - {id: e, storey: lower, a: [10, 0], b: [10, 6], thickness_m: 0.2}\n"                // 5
    "  - {id: n, storey: lower, a: [10, 6], b: [0, 6], thickness_m: 0.2}\n"                 // 6
    "  - {id: w, storey: lower, a: [0, 6], b: [0, 0], thickness_m: 0.2}\n"                  // 7
    "rooms: [{id: hall, storey: lower, polygon: [[0, 0], [10, 0], [10, 6], [0, 6]]}]\n"     // 8
    "stairs:\n";                                                                            // 9

Building with(const std::string& stairs) { return read_plan_text(base + stairs, "p.yaml"); }

double slab_volume(const Building& building, std::size_t slab) {
  return build_mesh(building).elements[building.walls.size() + slab].volume_m3;
}

TEST(Stairs, StepsAreEqualAndNoneIsTooHigh) {
  EXPECT_EQ(step_count(3.0, 0.2), 15.0);
  EXPECT_EQ(step_count(3.0, 0.18), 17.0);
  const Stream stream(31, "bim.generate");
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    const double height = 0.5 + 5.0 * stream.uniform(tick, 0, 0), rise = 0.05 + 0.2 * stream.uniform(tick, 0, 1);
    const double steps = step_count(height, rise);
    EXPECT_LE(height / steps, rise * (1 + 1e-9));
    EXPECT_GT(height / (steps - 1.0), rise * (1 - 1e-9));
  }
}

TEST(Stairs, BodiesCloseAndTheLastStepIsFlushAtRandom) {
  const Stream stream(32, "bim.generate");
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const auto draw = [&](std::uint32_t i, double low, double high) {
      return low + (high - low) * stream.uniform(tick, 0, i);
    };
    PlanStairEntry entry;
    entry.start = {draw(0, -20, 20), draw(1, -20, 20)};
    entry.yaw_deg = draw(2, -180, 180);
    entry.width_m = draw(3, 0.5, 2);
    entry.rise_m = draw(4, 0.05, 0.25);
    entry.run_m = draw(5, 0.2, 0.5);
    entry.turn = static_cast<Turn>(tick % 5);
    entry.landing_after = 2 + static_cast<int>(tick % 3);
    const double z0 = draw(6, -3, 3), height = draw(7, 2.5, 4);
    const Stair stair = build_stair(entry, z0, height);
    ASSERT_EQ(stair.flights.size(), 2U);
    ASSERT_EQ(stair.landings.size(), 1U);
    EXPECT_EQ(stair.bodies.size(), 3U);
    for (const Solid& body : stair.bodies) {
      EXPECT_TRUE(is_closed(body)) << tick;
      EXPECT_GT(volume(body), 0.0) << tick;
    }
    const StairFlight &first = stair.flights[0], &second = stair.flights[1];
    EXPECT_NEAR(second.z0_m + second.steps * second.rise_m, z0 + height, 1e-9);
    EXPECT_NEAR(stair.landings[0].z_m, first.z0_m + first.steps * first.rise_m, 1e-12);
    EXPECT_GT(signed_area(stair.landings[0].polygon), 0.0);
    // Both flights end at the landing and share no ground.
    EXPECT_LT(boundary_distance(stair.landings[0].polygon, head_of(first, 0.0)), 1e-9);
    EXPECT_LT(boundary_distance(stair.landings[0].polygon, second.start), 1e-9);
    EXPECT_LT(intersection_area(steps_outline(first, 0, first.steps - 1), steps_outline(second, 0, second.steps - 1)),
              1e-3);
  }
}

TEST(Stairs, RaysMeetTheStepsWhereTheFlightSays) {
  const Building building = with("  - {id: st, from: lower, to: upper, start: [1, 3], width_m: 1.2, rise_m: 0.17}\n");
  ASSERT_EQ(building.stairs.size(), 1U);  // nothing stands above the upper storey
  const Stair& stair = building.stairs[0];
  const StairFlight& flight = stair.flights[0];
  EXPECT_EQ(flight.steps, 18);
  EXPECT_EQ(stair.rooms[0], 0);
  EXPECT_EQ(stair.rooms[1], 1);
  const BuildingMesh mesh = build_mesh(building);
  for (const MeshElement& element : mesh.elements) EXPECT_TRUE(element.closed) << element.id;
  EXPECT_TRUE(mesh.warnings.empty());
  const RayScene scene(mesh);
  for (int k = 0; k < flight.steps; ++k) {
    const Eigen::Vector2d p = centroid(steps_outline(flight, k, k));
    const double z = (k + 1) * 3.0 / 18.0;
    const Hit down = scene.cast({{p.x(), p.y(), z + 1.0}, -Eigen::Vector3d::UnitZ()}, 10.0);
    EXPECT_NEAR(down.range_m, 1.0, 2e-6) << k;
    const Hit up = scene.cast({{p.x(), p.y(), z + 0.01}, Eigen::Vector3d::UnitZ()}, 10.0);
    EXPECT_GE(up.range_m, StairBuilderConfig().head_room_m - 0.01) << k;
  }
}

TEST(Stairs, TheWellIsAsLargeAsTheHeadRoomAsks) {
  const Building plain = read_plan_text(base.substr(0, base.find("stairs")), "p.yaml");
  const Building building = with("  - {id: st, from: lower, to: upper, start: [1, 3], width_m: 1.2, rise_m: 0.17}\n");
  ASSERT_EQ(building.slabs.size(), plain.slabs.size());
  // The upper floor's underside is at 2.8 m: steps above 0.7 m and below 3 m, numbers 4 to 16, lack head room.
  EXPECT_NEAR(slab_volume(plain, 2) - slab_volume(building, 2), 13 * 0.28 * 1.2 * 0.2, 1e-6);
  EXPECT_NEAR(slab_volume(building, 0), slab_volume(plain, 0), 1e-9);
}

TEST(Stairs, TurnsFitIntoAStairwell) {
  const Building building = with(
      "  - {id: st, from: lower, to: upper, start: [2, 1], width_m: 1, rise_m: 0.17, landing_after: 9, turn: "
      "back_left}\n");
  const Stair& stair = building.stairs[0];
  EXPECT_EQ(stair.flights[1].steps, 9);
  EXPECT_NEAR((head_of(stair.flights[1], 0.0) - Eigen::Vector2d(2, 2.1)).norm(), 0.0, 1e-9);
  for (const MeshElement& element : build_mesh(building).elements) EXPECT_TRUE(element.closed) << element.id;
}

TEST(Stairs, CopiedStoreysRepeatThemWhereThereIsAStoreyAbove) {
  std::string text = base + "  - {id: st, from: lower, to: upper, start: [1, 3]}\n";
  text.replace(text.find("copy_of: lower}]"), 16, "copy_of: lower}, {id: top, elevation_m: 6.5, copy_of: lower}]");
  const Building building = read_plan_text(text, "p.yaml");
  ASSERT_EQ(building.stairs.size(), 2U);
  EXPECT_EQ(building.stairs[1].id, "upper/st");
  EXPECT_EQ(building.stairs[1].to, 2);
  EXPECT_EQ(building.stairs[1].flights[0].steps, 20);  // 3.5 m
  EXPECT_NEAR(building.stairs[1].flights[0].rise_m, 0.175, 1e-12);
}

TEST(Stairs, ACopyTooLowForTheLandingIsRefused) {
  std::string text = base + "  - {id: st, from: lower, to: upper, start: [1, 3], landing_after: 12}\n";
  text.replace(text.find("copy_of: lower}]"), 16,
               "height_m: 1.2, copy_of: lower}, {id: top, elevation_m: 4.4, height_m: 2.8, copy_of: lower}]");
  expect_plan_error(text, "10",
                    "stair 'upper/st' from 'upper' to 'top' has only 8 steps; its landing must come before");
}

TEST(Stairs, WhatCannotBeWalkedIsRefusedAtItsLine) {
  const auto refuse = [&](const std::string& stair, const std::string& part) {
    expect_plan_error(base + "  - {id: st, " + stair + "}\n", "10", part);
  };
  refuse("from: lower, to: attic, start: [1, 3]", "no storey 'attic'");
  refuse("from: upper, to: lower, start: [1, 3]", "must lead up");
  refuse("from: lower, to: lower, start: [1, 3]", "must lead up");
  refuse("from: lower, to: upper, start: [1, 3], width_m: 6", "stands on or less than 2.1 m above it");
  refuse("from: lower, to: upper, start: [9.6, 3]", "ends in the void");
  refuse("from: lower, to: upper, start: [30, 3]", "no floor of storey 'lower' before its first step");
  refuse("from: lower, to: upper, start: [1, 3], rise_m: 0.5", "rise_m");
  refuse("from: lower, to: upper, start: [1, 3], run_m: 0.1", "run_m");
  refuse("from: lower, to: upper, start: [1, 3], width_m: -1", "width_m");
  refuse("from: lower, to: upper, start: [1e30, 3]", "start");
  refuse("from: lower, to: upper, start: [.nan, 3]", "start");
  refuse("from: lower, to: upper, start: [1, 3], landing_after: 17", "only 17 steps");
  refuse("from: lower, to: upper, start: [1, 3], turn: left", "give landing_after");
  refuse("from: lower, to: upper, start: [1, 3], turn: left, landing_after: 5, landing_m: 0.6", "less deep");
  refuse("from: lower, to: upper, start: [1, 3], turn: lft, landing_after: 5", "did you mean 'left'");
  expect_plan_error(base + "  - {id: s, from: lower, to: upper, start: [1, 3]}\n", "10", "the id 's' is taken");
}

TEST(Stairs, AStoreyTooFarAboveIsRefused) {
  std::string text = base + "  - {id: st, from: lower, to: upper, start: [1, 3], rise_m: 0.05}\n";
  text.replace(text.find("elevation_m: 3,"), 15, "elevation_m: 9e3,");
  expect_plan_error(text, "10", "at most 1000 can be built");
}

}  // namespace
}  // namespace plumbline::bim
