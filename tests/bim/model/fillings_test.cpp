// SPDX-License-Identifier: Apache-2.0
#include "bim/model/fillings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/mesh.h"
#include "bim/mesh/visible.h"
#include "bim/model/extrude.h"
#include "bim/rays/ray_scene.h"

namespace plumbline::bim {
namespace {

const std::string room =
    "plan: 1\n"
    "storeys: [{id: g, height_m: 3}]\n"
    "walls:\n"
    "  - {id: s, storey: g, a: [0, 0], b: [8, 0], thickness_m: 0.2}\n"
    "  - {id: e, storey: g, a: [8, 0], b: [8, 5], thickness_m: 0.2}\n"
    "  - {id: n, storey: g, a: [8, 5], b: [0, 5], thickness_m: 0.2}\n"
    "  - {id: w, storey: g, a: [0, 5], b: [0, 0], thickness_m: 0.2}\n"
    "openings:\n"
    "  - {id: shut, wall: s, kind: door, s_m: 2, width_m: 1, height_m: 2.1, leaf: closed}\n"
    "  - {id: open, wall: s, kind: door, s_m: 4, width_m: 1, height_m: 2.1}\n"
    "  - {id: bare, wall: s, kind: door, s_m: 6, width_m: 1, height_m: 2.1, leaf: none}\n"
    "  - {id: pane, wall: e, kind: window, s_m: 2, width_m: 1, height_m: 1, sill_m: 1}\n"
    "  - {id: board, wall: n, kind: window, s_m: 2, width_m: 1, height_m: 1, sill_m: 1, material: wood}\n"
    "clutter: [{id: crate, storey: g, shape: box, at: [1, 1], size: [1, 0.5]}]\n";

Building building() { return read_plan_text(room, "p.yaml"); }

std::vector<std::string> obstacle_ids(const Building& b) {
  std::vector<std::string> ids;
  for (const Obstacle& obstacle : b.obstacles) ids.push_back(obstacle.id);
  return ids;
}

TEST(Fillings, ClosedLeavesAndPanesFillTheirOpenings) {
  Building b = building();
  add_fillings(b);
  EXPECT_EQ(obstacle_ids(b), (std::vector<std::string>{"crate", "shut/leaf", "pane/pane", "board/pane"}));
  const Solid& leaf = b.obstacles[1].body;
  EXPECT_TRUE(is_closed(leaf));
  EXPECT_NEAR(volume(leaf), 1.0 * 0.04 * 2.1, 1e-12);
  for (const Eigen::Vector3d& p : leaf.vertices) EXPECT_NEAR(std::abs(p.y()), 0.02, 1e-12);
  EXPECT_NEAR(volume(b.obstacles[2].body), 1.0 * 0.024 * 1.0, 1e-12);
  EXPECT_EQ(b.obstacles[2].material, "glass");
  EXPECT_EQ(b.obstacles[3].material, "wood");
}

TEST(Fillings, AreNoPartOfTheContent) {
  Building b = building();
  const std::uint64_t before = b.hash();
  add_fillings(b);
  EXPECT_EQ(b.hash(), before);
}

TEST(Fillings, LeanWithTheirWall) {
  Building b = building();
  b.walls[0].slope = 0.05;
  add_fillings(b);
  for (const Eigen::Vector3d& p : b.obstacles[1].body.vertices)
    EXPECT_NEAR(std::abs(p.y() - 0.05 * p.z()), 0.02, 1e-12);
}

TEST(Fillings, FollowACurvedWall) {
  // An arc of 5 m radius about (4, 3), 0.3 m thick, over a chord of 8 m.
  constexpr double radius = 5.0, half_angle = 0.9272952180016122;
  const Eigen::Vector2d centre(4.0, 3.0);
  const auto at = [&](double r, double angle) -> Eigen::Vector2d {
    return centre + r * Eigen::Vector2d(std::sin(angle), -std::cos(angle));
  };
  Polygon2 outline;
  for (int i = -12; i <= 12; ++i) outline.push_back(at(radius + 0.15, half_angle * i / 12));
  for (int i = 12; i >= -12; --i) outline.push_back(at(radius - 0.15, half_angle * i / 12));
  Building b = building();
  Wall& wall = b.walls[0];
  wall.offset_m = -2.15;
  wall.thickness_m = 2.25;
  wall.body = extrude(unite(std::vector<Polygon2>{outline}), 0.0, 3.0);
  for (const auto& [angle, width] : {std::pair(0.0, 1.0), std::pair(0.6, 1.0), std::pair(0.6, 0.2)}) {
    Opening window = b.openings[3];
    window.wall = 0;
    const Eigen::Vector2d out = at(1.0, angle) - centre, middle = at(radius, angle);
    const Eigen::Vector2d along(-out.y(), out.x()), u = 0.3 * out, v = 0.5 * width * along;
    window.s_m = middle.x();
    window.width_m = width;
    window.solid = extrude(
        unite(std::vector<Polygon2>{{middle - u - v, middle + u - v, middle + u + v, middle - u + v}}), 1.0, 2.0);
    Building one = b;
    one.openings = {window};
    one.obstacles.clear();
    add_fillings(one);
    ASSERT_EQ(one.obstacles.size(), 1U);
    EXPECT_NEAR(volume(one.obstacles[0].body), width * 0.024, 1e-3);
    for (const Eigen::Vector3d& p : one.obstacles[0].body.vertices) {
      EXPECT_NEAR((p.head<2>() - middle).dot(out), 0.0, 0.05) << angle;
      EXPECT_NEAR(std::abs((p.head<2>() - middle).dot(along)), 0.5 * width, 0.02) << angle;
    }
  }
}

TEST(Fillings, DoorsAndFurnitureAreTheScenariosChoice) {
  Building closed = building();
  apply_options(closed, {Doors::closed, false});
  add_fillings(closed);
  EXPECT_EQ(obstacle_ids(closed), (std::vector<std::string>{"shut/leaf", "open/leaf", "pane/pane", "board/pane"}));
  Building open = building();
  apply_options(open, {Doors::open, true});
  EXPECT_EQ(open.openings[0].leaf, Leaf::open);
  EXPECT_EQ(open.openings[2].leaf, Leaf::none);
  Building same = building();
  apply_options(same, {});
  EXPECT_EQ(same.hash(), building().hash());
  Building unplanned = building();
  unplanned.obstacles[0].planned = false;
  apply_options(unplanned, {Doors::as_designed, false});
  EXPECT_EQ(unplanned.obstacles.size(), 1U);
}

TEST(Fillings, WithoutFurnitureCoveringsAndAppliancesGoAndInstallationsStay) {
  Building b = building();
  for (const std::string kind :
       {"furniture", "covering", "proxy", "electric_appliance", "railing", "sanitary_terminal"}) {
    b.obstacles.push_back(b.obstacles.front());
    b.obstacles.back().id = kind;
    b.obstacles.back().kind = kind;
  }
  apply_options(b, {Doors::as_designed, false});
  EXPECT_EQ(obstacle_ids(b), (std::vector<std::string>{"railing", "sanitary_terminal"}));
}

TEST(VisibleMesh, LetsTheLidarLookThroughGlassAndNothingElse) {
  Building b = building();
  add_fillings(b);
  const BuildingMesh mesh = build_mesh(b), visible = visible_mesh(b, mesh);
  ASSERT_EQ(visible.elements.size(), mesh.elements.size());
  int hidden = 0;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    if (visible.elements[i].triangle_count == mesh.elements[i].triangle_count) continue;
    EXPECT_EQ(mesh.elements[i].id, "pane/pane");
    EXPECT_EQ(visible.elements[i].triangle_count, 0);
    ++hidden;
  }
  EXPECT_EQ(hidden, 1);
  for (std::size_t t = 0; t < visible.triangles.size(); ++t) {
    const MeshElement& element = visible.elements[static_cast<std::size_t>(visible.element[t])];
    EXPECT_GE(static_cast<int>(t), element.first_triangle);
    EXPECT_LT(static_cast<int>(t), element.first_triangle + element.triangle_count);
  }
  const RayScene scene(visible), everything(mesh);
  const Ray at_pane{{4, 2, 1.5}, Eigen::Vector3d::UnitX()}, at_board{{6, 2, 1.5}, Eigen::Vector3d::UnitY()};
  EXPECT_EQ(scene.cast(at_pane, 50.0).element, -1);
  EXPECT_EQ(mesh.elements[static_cast<std::size_t>(everything.cast(at_pane, 50.0).element)].id, "pane/pane");
  EXPECT_EQ(mesh.elements[static_cast<std::size_t>(scene.cast(at_board, 50.0).element)].id, "board/pane");
}

}  // namespace
}  // namespace plumbline::bim
