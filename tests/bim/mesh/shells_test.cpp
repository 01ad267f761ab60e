// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/shells.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "bim/mesh/corefine.h"
#include "bim/mesh/mesh.h"
#include "bim/mesh/solid.h"
#include "tests/bim/model/thick_wall.h"

namespace plumbline::bim {
namespace {

Solid turned_over(Solid solid) {
  for (Eigen::Vector3i& t : solid.triangles) std::swap(t[1], t[2]);
  return solid;
}

Solid all_of(const std::vector<Solid>& parts) {
  Solid all;
  for (const Solid& part : parts) add_solid(part, all);
  return all;
}

/// Volume of a wall 0.4 m thick with a door through it, from items of its body.
double cut_volume(const std::vector<Solid>& items) {
  Wall wall = thick_wall();
  wall.b = {6.4, 0.0};
  wall.offset_m = -0.2;
  wall.thickness_m = 0.4;
  wall.body = all_of(items);
  Opening door;
  door.wall = 0;
  door.solid = box_solid({2.5, -0.3, 0.0}, {3.4, 0.3, 2.1});
  const CutWall cut = cut_wall(wall, {door}, {});
  EXPECT_TRUE(cut.closed);
  EXPECT_TRUE(is_closed(cut.solid));
  return volume(cut.solid);
}

TEST(Shells, LayersWithFacesInCommonAreOneWall) {
  const double expected = 7.68 - 0.9 * 2.1 * 0.4;
  EXPECT_NEAR(cut_volume({box_solid({0, -0.2, 0}, {6.4, 0, 3}), box_solid({0, 0, 0}, {6.4, 0.2, 3})}), expected, 1e-4);
  EXPECT_NEAR(cut_volume({box_solid({0, -0.2, 0}, {6.4, -0.05, 3}), box_solid({0, -0.05, 0}, {6.4, 0.05, 3}),
                          box_solid({0, 0.05, 0}, {6.4, 0.2, 3})}),
              expected, 1e-4);
}

TEST(Shells, ABoxWithinAnotherIsNoHollow) {
  const double expected = 7.68 + 6.4 * 0.05 * 0.5 - 0.9 * 2.1 * 0.4 - 0.05 * 0.9 * 0.5;
  const Solid plinth = box_solid({0, -0.25, 0}, {6.4, -0.2, 0.5});
  const Solid outer = box_solid({0, -0.2, 0}, {6.4, 0.2, 3}), inner = box_solid({0.1, -0.1, 0.1}, {6.3, 0.1, 2.9});
  EXPECT_NEAR(cut_volume({outer, inner, plinth}), expected, 1e-4);
  EXPECT_NEAR(cut_volume({outer, plinth}), expected, 1e-4);
}

TEST(Shells, WhatLiesInAHollowStays) {
  const Solid outer = box_solid({0, 0, 0}, {10, 10, 10}), hollow = turned_over(box_solid({1, 1, 1}, {9, 9, 9}));
  const Solid core = box_solid({3, 3, 3}, {4, 4, 4}), beside = box_solid({10, 0, 0}, {11, 10, 10});
  const std::optional<Solid> whole = repaired(all_of({outer, hollow, core, beside}));
  ASSERT_TRUE(whole.has_value());
  EXPECT_NEAR(volume(*whole), 1000.0 - 512.0 + 1.0 + 100.0, 1e-6);
}

TEST(Shells, AreTurnedOneByOne) {
  const Solid big = box_solid({0, 0, 0}, {10, 10, 1}), small = box_solid({20, 0, 0}, {21, 1, 1});
  EXPECT_DOUBLE_EQ(volume(shells_turned_outward(all_of({big, turned_over(small)}))), 101.0);
  EXPECT_DOUBLE_EQ(volume(shells_turned_outward(all_of({turned_over(big), small}))), 101.0);
  EXPECT_DOUBLE_EQ(volume(shells_turned_outward(all_of({turned_over(big), turned_over(small)}))), 101.0);
  const Solid within = box_solid({4, 4, 0.25}, {6, 6, 0.75});
  EXPECT_DOUBLE_EQ(volume(shells_turned_outward(all_of({big, turned_over(within)}))), 98.0);
  EXPECT_DOUBLE_EQ(volume(shells_turned_outward(all_of({turned_over(big), within}))), 98.0);
}

TEST(TurnedAlike, ClosesASurfaceWithSomeFacesTurnedOver) {
  const Solid hollow =
      all_of({box_solid({0, 0, 0}, {3, 2, 1}), turned_over(box_solid({1, 0.5, 0.25}, {2, 1.5, 0.75}))});
  for (const std::size_t step : {2u, 3u, 5u, 7u}) {
    Solid mixed = hollow;
    for (std::size_t t = 0; t < mixed.triangles.size(); t += step)
      std::swap(mixed.triangles[t][1], mixed.triangles[t][2]);
    ASSERT_FALSE(is_closed(mixed));
    const Solid alike = turned_alike(mixed);
    EXPECT_TRUE(is_closed(alike));
    EXPECT_DOUBLE_EQ(std::abs(volume(shells(alike)[0])), 6.0);
    EXPECT_GT(volume(alike), 0.0);
  }
  Solid open = box_solid({0, 0, 0}, {3, 2, 1});
  open.triangles.pop_back();
  EXPECT_EQ(turned_alike(open).triangles, open.triangles);
}

MeshElement element_of(const Solid& body) {
  Building building;
  building.obstacles = {{"o", "box", 0, body}};
  return build_mesh(building).elements.front();
}

TEST(Shells, PartsOfAMeshThatShareAnEdgeClose) {
  const Solid touching = all_of({box_solid({0, 0, 0}, {1, 1, 1}), box_solid({1, 1, 0}, {2, 2, 1})});
  const MeshElement joined = element_of(welded(touching, 1e-6));
  EXPECT_TRUE(joined.closed);
  EXPECT_NEAR(joined.volume_m3, 2.0, 1e-9);
  const MeshElement face_to_face =
      element_of(welded(all_of({box_solid({0, 0, 0}, {2, 1, 1}), box_solid({0, 1, 0}, {1, 3, 1})}), 1e-6));
  EXPECT_TRUE(face_to_face.closed);
  EXPECT_NEAR(face_to_face.volume_m3, 4.0, 1e-9);
  const MeshElement mixed =
      element_of(all_of({box_solid({0, 0, 0}, {10, 10, 1}), turned_over(box_solid({20, 0, 0}, {21, 1, 1}))}));
  EXPECT_NEAR(mixed.volume_m3, 101.0, 1e-9);
}

}  // namespace
}  // namespace plumbline::bim
