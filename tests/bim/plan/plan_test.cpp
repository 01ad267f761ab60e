// SPDX-License-Identifier: Apache-2.0
#include "bim/plan/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/model/extrude.h"
#include "bim/model/fillings.h"
#include "bim/model/rooms.h"
#include "bim/model/wall_face.h"
#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

Wall wall_of(const std::string& id, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double offset,
             double thickness) {
  Wall wall;
  wall.id = id;
  wall.storey = 0;
  wall.a = a;
  wall.b = b;
  wall.offset_m = offset;
  wall.thickness_m = thickness;
  return wall;
}

double gap(const Plane& a, const Plane& b) { return (a.n - b.n).norm() + std::abs(a.d - b.d); }

TEST(TwinPlane, ExampleOfThePaperWithTheSignCorrected) {
  const Plane plane{{1.0, 0.0, 0.0}, -5.0};  // x = 5, body at x > 5
  const Plane twin = opposite_face(plane, 0.2, 1);
  EXPECT_NEAR(twin.distance({5.2, 7.0, 1.0}), 0.0, 1e-15);
  EXPECT_NEAR(twin.distance({5.1, 0.0, 0.0}), plane.distance({5.1, 0.0, 0.0}), 1e-15);  // the middle of the wall
  // As printed (d + T) the twin would be x = 4.8.
  EXPECT_GT(std::abs(twin.distance({4.8, 0.0, 0.0})), 0.3);
}

TEST(TwinPlane, BothSignsOnBothSidesOfTheOriginAndThroughIt) {
  for (const double x : {-5.0, -0.1, 0.0, 0.1, 5.0}) {
    for (const int side : {-1, 1}) {
      const Plane plane{{1.0, 0.0, 0.0}, -x};
      const Plane twin = opposite_face(plane, 0.2, side);
      EXPECT_NEAR(twin.distance({x + side * 0.2, 3.0, 0.0}), 0.0, 1e-15) << x << " " << side;
      EXPECT_NEAR(gap(opposite_face(twin, 0.2, side), plane), 0.0, 1e-15);
    }
  }
  EXPECT_THROW((void)opposite_face({}, 0.2, 0), InternalError);
}

TEST(FacePlane, LawsAtRandomWalls) {
  const Stream stream(8, "bim.generate");
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    const auto draw = [&](std::uint32_t i, double low, double high) {
      return low + (high - low) * stream.uniform(tick, 0, i);
    };
    const Eigen::Vector2d a(draw(0, -20, 20), draw(1, -20, 20));
    const double angle = draw(2, -std::numbers::pi, std::numbers::pi), length = draw(3, 0.5, 9.0);
    const Wall wall = wall_of("w", a, a + length * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                              draw(4, -0.6, 0.6), draw(5, 0.05, 0.5));
    const Eigen::Vector2d in_body =
        a + draw(6, 0, length) * wall.direction() + (wall.offset_m + 0.5 * wall.thickness_m) * wall.left();
    for (const int side : {0, 1}) {
      const Plane plane = face_plane(wall, side);
      const FaceLine line = face_line(wall, side);
      EXPECT_NEAR(plane.n.norm(), 1.0, 1e-12);
      // Own corners on the plane; the body half a thickness behind it; free space left of p0 to p1.
      EXPECT_NEAR(plane.distance({line.p0.x(), line.p0.y(), 0.0}), 0.0, 1e-12);
      EXPECT_NEAR(plane.distance({line.p1.x(), line.p1.y(), 3.0}), 0.0, 1e-12);
      EXPECT_NEAR(plane.distance({in_body.x(), in_body.y(), 1.0}), -0.5 * wall.thickness_m, 1e-12);
      const Eigen::Vector2d along = (line.p1 - line.p0).normalized();
      EXPECT_NEAR(plane.n.x(), -along.y(), 1e-12);
      EXPECT_NEAR(plane.n.y(), along.x(), 1e-12);
    }
    EXPECT_NEAR(signed_area(footprint(wall)), length * wall.thickness_m, 1e-12);
  }
}

/// Two rooms, 4 x 3 m and 2 x 3 m clear, with a door between them; the outer walls reach around both.
Building two_rooms() {
  Building building;
  building.storeys.push_back({"ground", "ground"});
  building.walls = {wall_of("south", {0, 0}, {6.1, 0}, -0.2, 0.2), wall_of("east", {6.1, 0}, {6.1, 3}, -0.2, 0.2),
                    wall_of("north", {6.1, 3}, {0, 3}, -0.2, 0.2), wall_of("west", {0, 3}, {0, 0}, -0.2, 0.2),
                    wall_of("middle", {4.05, 0}, {4.05, 3}, -0.05, 0.1)};
  Room left, right;
  left.id = "left";
  left.storey = right.storey = 0;
  left.polygon = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
  right.id = "right";
  right.polygon = {{4.1, 0}, {6.1, 0}, {6.1, 3}, {4.1, 3}};
  building.rooms = {left, right};
  Opening door;
  door.id = "door";
  door.wall = 4;
  door.s_m = 1.0;
  door.width_m = 0.8;
  building.openings = {door};
  find_room_walls(building);
  find_opening_rooms(building);
  return building;
}

TEST(Rooms, WallsAreFoundAlongTheirFacesOnly) {
  const Building building = two_rooms();
  EXPECT_EQ(building.rooms[0].walls, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(building.rooms[1].walls, (std::vector<int>{0, 1, 2, 4}));
  EXPECT_NEAR(shared_length(building.rooms[1], building.walls[0], 0), 2.0, 1e-12);
  EXPECT_EQ(shared_length(building.rooms[1], building.walls[0], 1), 0.0);
}

TEST(Rooms, WallOfAnotherStoreyDoesNotBound) {
  Building building = two_rooms();
  building.walls[0].z0_m = 3.0;
  building.walls[0].z1_m = 6.0;
  EXPECT_TRUE(bounding_sides(building.rooms[0], building.walls[0]).empty());
}

TEST(Rooms, NamedWallApartFromTheOutlineShowsItsNearSide) {
  const Building building = two_rooms();
  Wall apart = wall_of("apart", {0, -1}, {4, -1}, -0.1, 0.2);
  EXPECT_EQ(bounding_sides(building.rooms[0], apart), std::vector<int>{0});
  std::swap(apart.a, apart.b);
  EXPECT_EQ(bounding_sides(building.rooms[0], apart), std::vector<int>{1});
}

TEST(Rooms, DoorJoinsTheRoomsOnItsSides) {
  const Building building = two_rooms();
  EXPECT_EQ(building.openings[0].rooms[0], 0);  // left of south to north is west
  EXPECT_EQ(building.openings[0].rooms[1], 1);
}

TEST(Rooms, ClearOutlineEndsAtTheWallFaces) {
  const Building building = two_rooms();
  const auto clear = clear_outlines({{-0.1, -0.1}, {4.05, -0.1}, {4.05, 3.1}, {-0.1, 3.1}}, building.walls);
  // The corners outside both outer walls (0.1 x 0.1 m, not built) touch the room in a point only.
  ASSERT_EQ(clear.size(), 3U);
  EXPECT_NEAR(signed_area(clear[0]), 12.0, 1e-9);
  EXPECT_EQ(clear[0].size(), 4U);
  EXPECT_NEAR(signed_area(clear[1]), 0.01, 1e-9);
  EXPECT_TRUE(clear_outlines({{0, -0.1}, {1, -0.1}, {1, -0.05}, {0, -0.05}}, building.walls).empty());
}

TEST(Rooms, EdgesWithoutAWallBetweenAreOpen) {
  const Building building = two_rooms();
  EXPECT_EQ(open_length(building.rooms[0], building.rooms[1]), 0.0);
  Room next = building.rooms[1];
  next.polygon = {{4, 1}, {6, 1}, {6, 4}, {4, 4}};
  EXPECT_NEAR(open_length(building.rooms[0], next), 2.0, 1e-12);
  EXPECT_NEAR(open_length(next, building.rooms[0]), 2.0, 1e-12);
}

TEST(Plan, TwoFacesAWallAndRoomsWithTheirFaces) {
  const Plan plan = make_plan(two_rooms());
  ASSERT_EQ(plan.faces.size(), 10U);
  for (std::size_t i = 0; i < plan.faces.size(); ++i) EXPECT_EQ(plan.faces[i].id, static_cast<int>(i));
  // Side 0 is left of a to b: inside for walls that run counter-clockwise around the house.
  EXPECT_EQ(plan.rooms[0].faces, (std::vector<int>{0, 4, 6, 8}));
  EXPECT_EQ(plan.rooms[1].faces, (std::vector<int>{0, 2, 4, 9}));
  EXPECT_EQ(plan.faces[0].rooms, (std::vector<int>{0, 1}));
  EXPECT_TRUE(plan.faces[1].rooms.empty());
  EXPECT_EQ(plan.rooms[0].neighbours, std::vector<int>{1});
  EXPECT_EQ(plan.rooms[1].neighbours, std::vector<int>{0});
  for (const PlanRoom& room : plan.rooms)
    for (const int face : room.faces) {
      const Eigen::Vector2d inner = centroid(room.polygon);
      EXPECT_GT(plan.faces[static_cast<std::size_t>(face)].plane_W.distance({inner.x(), inner.y(), 1.0}), 0.0);
    }
}

TEST(Plan, HolesCountFromP0OnBothSides) {
  const Plan plan = make_plan(two_rooms());
  const FaceHole left = plan.faces[8].holes.at(0), right = plan.faces[9].holes.at(0);
  EXPECT_NEAR(left.s0, 0.6, 1e-12);
  EXPECT_NEAR(left.s1, 1.4, 1e-12);
  EXPECT_NEAR(right.s0, 1.6, 1e-12);
  EXPECT_NEAR(right.s1, 2.4, 1e-12);
  EXPECT_EQ(right.z1, 2.1);
}

/// Box of four legs under a top.
Solid table() {
  Solid table = extrude({{{{1, 1}, {2, 1}, {2, 2}, {1, 2}}, {}}}, 0.7, 0.75);
  for (const double x : {1.0, 1.95}) {
    const Solid leg = extrude({{{{x, 1}, {x + 0.05, 1}, {x + 0.05, 1.05}, {x, 1.05}}, {}}}, 0.0, 0.7);
    const Eigen::Vector3i first = Eigen::Vector3i::Constant(static_cast<int>(table.vertices.size()));
    table.vertices.insert(table.vertices.end(), leg.vertices.begin(), leg.vertices.end());
    for (const Eigen::Vector3i& t : leg.triangles) table.triangles.emplace_back(t + first);
  }
  return table;
}

TEST(Plan, SolidsAreColumnsAndWhatIsPlannedAndFillsItsOutline) {
  Building building = two_rooms();
  Column column;
  column.id = "c";
  column.storey = 0;
  column.footprint = {{1, 1}, {1, 1.4}, {1.4, 1.4}, {1.4, 1}};  // clockwise
  building.columns.push_back(column);
  Obstacle box{"box", "box", 0, extrude({{{{2, 2}, {2.5, 2}, {2.5, 2.5}, {2, 2.5}}, {}}}, 0.0, 1.0)};
  building.obstacles.push_back(box);
  box.id = "pallet";
  box.planned = false;
  building.obstacles.push_back(box);
  building.obstacles.push_back({"table", "furniture", 0, table()});
  add_fillings(building);
  const Plan plan = make_plan(building);
  ASSERT_EQ(plan.solids.size(), 2U);
  EXPECT_EQ(plan.solids[0].id, "c");
  EXPECT_NEAR(signed_area(plan.solids[0].outline), 0.16, 1e-12);
  EXPECT_EQ(plan.solids[1].id, "box");
  EXPECT_NEAR(signed_area(plan.solids[1].outline), 0.25, 1e-12);
  EXPECT_EQ(plan.solids[1].z1, 1.0);
  EXPECT_EQ(plan.faces.size(), make_plan(two_rooms()).faces.size());
  const Plan moved = transformed(plan, Pose::from_xyz_yaw({3, -2, 1}, 0.5));
  EXPECT_EQ(moved.solids[1].z1, 2.0);
  const Eigen::Vector3d corner(plan.solids[0].outline[0].x(), plan.solids[0].outline[0].y(), 0.0);
  const Eigen::Vector3d there = Pose::from_xyz_yaw({3, -2, 1}, 0.5) * corner;
  EXPECT_NEAR((moved.solids[0].outline[0] - there.head<2>()).norm(), 0.0, 1e-12);
}

TEST(Plan, TheStructureHasNeitherFurnitureNorLeavesNorPanes) {
  Building building = two_rooms();
  const std::size_t walls_alone = make_plan(building).structure.triangles.size();
  EXPECT_GT(walls_alone, 0U);
  building.obstacles.push_back({"table", "furniture", 0, table()});
  for (Opening& opening : building.openings) opening.leaf = Leaf::closed;
  add_fillings(building);
  ASSERT_GT(building.obstacles.size(), 1U);
  EXPECT_EQ(make_plan(building).structure.triangles.size(), walls_alone);
  building.obstacles.push_back({"rail", "railing", 0, table()});
  const Plan plan = make_plan(building);
  EXPECT_EQ(plan.structure.triangles.size(), walls_alone + table().triangles.size());
  for (std::size_t i = 0; i < plan.structure.triangles.size(); ++i)
    EXPECT_NE(plan.structure.elements[static_cast<std::size_t>(plan.structure.element[i])].id, "table");
  const Plan moved = transformed(plan, Pose::from_xyz_yaw({1, 2, 3}, 0.0));
  const Eigen::Vector3d step = moved.structure.vertices.front() - plan.structure.vertices.front();
  EXPECT_NEAR((step - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-12);
}

TEST(Plan, MovesAsOneBody) {
  const Plan plan_W = make_plan(two_rooms());
  const Stream stream(9, "bim.generate");
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    const Eigen::Vector3d t(50 * stream.gauss(tick, 0), 50 * stream.gauss(tick, 1), stream.gauss(tick, 2));
    const Pose X_VW = Pose::from_xyz_yaw(t, 6.0 * stream.uniform(tick, 3) - 3.0);
    const Plan plan_V = transformed(plan_W, X_VW);
    for (std::size_t i = 0; i < plan_W.faces.size(); ++i) {
      const PlanFace &before = plan_W.faces[i], &after = plan_V.faces[i];
      const Eigen::Vector3d p_W(before.p0.x(), before.p0.y(), before.z0);
      const Eigen::Vector3d p_V(after.p0.x(), after.p0.y(), after.z0);
      EXPECT_NEAR((X_VW * p_W - p_V).norm(), 0.0, 1e-11);
      EXPECT_NEAR(after.plane_W.distance(p_V), 0.0, 1e-11);
      EXPECT_NEAR((after.p1 - after.p0).norm(), (before.p1 - before.p0).norm(), 1e-11);
    }
    EXPECT_NEAR(signed_area(plan_V.rooms[0].polygon), 12.0, 1e-9);
    const Plan back = transformed(plan_V, X_VW.inverse());
    EXPECT_NEAR(gap(back.faces[3].plane_W, plan_W.faces[3].plane_W), 0.0, 1e-11);
  }
  EXPECT_THROW((void)transformed(plan_W, Pose{exp_so3({0.1, 0.0, 0.0}), Eigen::Vector3d::Zero()}), InternalError);
}

TEST(Building, HashFollowsTheContentOnly) {
  Building building = two_rooms();
  const std::uint64_t hash = building.hash();
  building.name = "another name";
  building.warnings.push_back({"x", "empty", "text"});
  building.walls[0].step_id = 77;
  EXPECT_EQ(building.hash(), hash);
  building.walls[0].thickness_m += 1e-9;
  EXPECT_NE(building.hash(), hash);
}

TEST(Plan, AColumnThatIsNoUprightPrismIsNoSolid) {
  const std::vector<PolygonWithHoles2> square = {{{{2, 2}, {2.4, 2}, {2.4, 2.4}, {2, 2.4}}, {}}};
  const std::vector<PolygonWithHoles2> tube = {{square[0].outer, {{{2.1, 2.1}, {2.1, 2.3}, {2.3, 2.3}, {2.3, 2.1}}}}};
  Building building = two_rooms();
  Column column;
  column.storey = 0;
  column.footprint = square[0].outer;
  for (const auto& [id, outline] : {std::pair{"upright", square}, {"tube", tube}, {"leaning", square}}) {
    column.id = id;
    column.body = extrude(outline, 0.0, 3.0);
    building.columns.push_back(column);
  }
  for (Eigen::Vector3d& p : building.columns.back().body->vertices) p.x() += 0.3 * p.z();
  const Plan plan = make_plan(building);
  ASSERT_EQ(plan.solids.size(), 2U);
  EXPECT_EQ(plan.solids[0].id, "upright");
  EXPECT_EQ(plan.solids[1].id, "tube");
}

}  // namespace
}  // namespace plumbline::bim
