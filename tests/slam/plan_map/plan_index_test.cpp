// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/plan_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "bim/errors.h"
#include "bim/mesh/mesh.h"
#include "bim/model/building.h"
#include "bim/random/stream.h"
#include "slam/plan_map/pose2.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

void expect_equal_tables(const PlanIndex& a, const PlanIndex& b) {
  ASSERT_EQ(a.storeys.size(), b.storeys.size());
  for (std::size_t s = 0; s < a.storeys.size(); ++s) {
    const StoreyIndex& x = a.storeys[s];
    const StoreyIndex& y = b.storeys[s];
    ASSERT_EQ(x.segments.size(), y.segments.size());
    for (std::size_t i = 0; i < x.segments.size(); ++i) {
      EXPECT_EQ(x.segments[i].a, y.segments[i].a);
      EXPECT_EQ(x.segments[i].e, y.segments[i].e);
      EXPECT_EQ(x.segments[i].line, y.segments[i].line);
      EXPECT_EQ(x.segments[i].element, y.segments[i].element);
    }
    EXPECT_EQ(x.visible, y.visible);
    EXPECT_EQ(x.floor_z, y.floor_z);
  }
}

/// Where a plan is moved to, draw i.
Pose far_away(const Stream& stream, std::uint32_t i) {
  return Pose::from_xyz_yaw(
      {200.0 * stream.gauss(0, i, 0), 200.0 * stream.gauss(0, i, 1), 10.0 * stream.gauss(0, i, 2)},
      6.28 * stream.uniform(0, i, 3));
}

/// A lower floor, a slope up from it along x, an upper one.
bim::WalkedFloors split_levels() {
  const auto rectangle = [](double x0, double x1) { return Polygon2{{x0, 0}, {x1, 0}, {x1, 4}, {x0, 4}}; };
  bim::WalkedFloors floors{-0.5, {}};
  floors.raised.push_back({{rectangle(2.0, 6.0), {}}, 0.0, -0.75, {0.125, 0.0}});
  floors.raised.push_back({{rectangle(6.0, 9.0), {}}, 0.0, 0.0});
  return floors;
}

TEST(PlanIndex, KnowsTheFloorAtAPlaceHoweverThePlanIsMoved) {
  bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  EXPECT_EQ(make_plan_index(plan, "ground", {}).storeys.front().floor_at({1.0, 1.0}),
            make_plan_index(plan, "ground", {}).storeys.front().floor_z);
  plan.storeys.front().floors = split_levels();
  const PlanIndex index = make_plan_index(plan, "ground", {});
  const Stream stream(6, "slam.localize.init");
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Pose X_VW = far_away(stream, i);
    const PlanIndex moved = make_plan_index(bim::transformed(plan, X_VW), "ground", {});
    // Away from the edges, which are rounded to a micrometre.
    const double x = std::array{1.0, 3.0, 5.0, 7.5}.at(i % 4) + 0.4 * stream.uniform(0, i, 4);
    const Eigen::Vector3d p_W(x, 0.5 + 3.0 * stream.uniform(0, i, 5), 0.0);
    const double expected_W = x < 2.0 ? -0.5 : x < 6.0 ? -0.75 + 0.125 * x : 0.0;
    const Eigen::Vector3d p_I = index.X_WI.inverse() * p_W;
    EXPECT_NEAR(index.storeys.front().floor_at(p_I.head<2>()) + index.X_WI.t.z(), expected_W, 2e-5) << x;
    EXPECT_EQ(moved.storeys.front().floor_at(p_I.head<2>()), index.storeys.front().floor_at(p_I.head<2>()));
  }
}

TEST(PlanIndex, HasFloorInRoomsAndDoorwaysAndWhereThereAreSlabs) {
  bim::Building building;
  building.storeys.push_back({"ground", "ground", 0.0, 3.0, 0, {}});
  bim::Slab terrace;
  terrace.id = "terrace";
  terrace.storey = 0;
  terrace.polygon.outer = {{6.0, 0.0}, {8.0, 0.0}, {8.0, 4.0}, {6.0, 4.0}};
  building.slabs.push_back(terrace);
  bim::Plan plan = synthetic::plan_of(synthetic::one_room(5.0, 4.0));
  plan.structure = bim::build_mesh(building);
  const PlanIndex index = make_plan_index(plan, "ground", {});
  const auto has_floor_at = [&](double x, double y) {
    return index.storeys.front().has_floor_at((index.X_WI.inverse() * Eigen::Vector3d(x, y, 0.0)).head<2>());
  };
  EXPECT_TRUE(has_floor_at(2.5, 2.0));
  EXPECT_TRUE(has_floor_at(-0.2, 2.0));  // as in a doorway of a wall of 0.4 m
  EXPECT_FALSE(has_floor_at(-1.0, 2.0));
  EXPECT_TRUE(has_floor_at(7.0, 2.0));
  EXPECT_FALSE(has_floor_at(9.0, 2.0));
}

TEST(PlanIndex, IsTheSameToTheBitForAMovedPlan) {
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const PlanIndex index = make_plan_index(plan, "ground", {});
  const Stream stream(5, "slam.localize.init");
  for (std::uint32_t i = 0; i < 5; ++i) {
    const Pose X_VW = far_away(stream, i);
    const PlanIndex moved = make_plan_index(synthetic::moved(plan, X_VW), "ground", {});
    expect_equal_tables(index, moved);
    EXPECT_LT((moved.X_WI.t - (X_VW * index.X_WI).t).norm(), 1e-9);
  }
}

TEST(PlanIndex, DoesNotDependOnTheOrderOfFaces) {
  bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const PlanIndex index = make_plan_index(plan, "ground", {});
  std::reverse(plan.faces.begin(), plan.faces.end());
  expect_equal_tables(index, make_plan_index(plan, "ground", {}));
}

TEST(PlanIndex, FacesOfAWallAreOneElement) {
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const StoreyIndex storey = make_plan_index(plan, "ground", {}).storeys.front();
  const auto wall_of = [&](const PlanSegment& s) { return plan.faces[static_cast<std::size_t>(s.plan_face)].wall_id; };
  for (std::size_t i = 0; i < storey.segments.size(); ++i) {
    const PlanSegment &segment = storey.segments[i],
                      &first = storey.segments.at(static_cast<std::size_t>(segment.element));
    EXPECT_LE(segment.element, static_cast<int>(i));
    EXPECT_EQ(wall_of(segment), wall_of(first));
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_EQ(wall_of(storey.segments[k]) == wall_of(segment), storey.segments[k].element == segment.element);
  }
}

TEST(PlanIndex, JoinsAWallAcrossItsDoorIntoOneLine) {
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const StoreyIndex storey = make_plan_index(plan, "ground", {}).storeys.front();
  double longest = 0.0;
  for (const WallLine& line : storey.lines) longest = std::max(longest, line.length);
  // The corridor is 14 m long and its walls have doors in them.
  EXPECT_GE(longest, 13.9);
  for (const WallLine& line : storey.lines) EXPECT_NEAR(line.n.dot(line.a) + line.d, 0.0, 1e-12);
}

TEST(PlanIndex, SeesOnlyFrontsFromARoom) {
  const bim::Plan plan = synthetic::plan_of(synthetic::one_room(6.0, 4.0));
  const PlanIndex index = make_plan_index(plan, std::nullopt, {});
  const StoreyIndex& storey = index.storeys.front();
  const Eigen::Vector2d center = centroid(storey.rooms.front().polygon);
  const std::vector<int>& seen = storey.visible[static_cast<std::size_t>(storey.grid.cell_at(center))];
  ASSERT_EQ(seen.size(), 4U);
  for (const int i : seen) {
    const WallLine& line = storey.lines[static_cast<std::size_t>(i)];
    EXPECT_GT(line.n.dot(center) + line.d, 0.0);
  }
}

TEST(PlanIndex, RefusesAPlanWithoutTheStoreyOrRooms) {
  bim::Plan plan = synthetic::plan_of(synthetic::one_room());
  EXPECT_THROW(static_cast<void>(make_plan_index(plan, "attic", {})), InputError);
  plan.rooms.clear();
  EXPECT_THROW(static_cast<void>(make_plan_index(plan, std::nullopt, {})), InputError);
}

TEST(PlanIndex, AColumnStopsLightAndIsNoWall) {
  bim::Plan plan = synthetic::plan_of(synthetic::one_room(6.0, 4.0));
  const std::size_t lines = make_plan_index(plan, "ground", {}).storeys.front().lines.size();
  plan.solids.push_back({"c", 0, {{3.0, 2.0}, {3.4, 2.0}, {3.4, 2.4}, {3.0, 2.4}}, 0.0, 1.0});
  const PlanIndex index = make_plan_index(plan, "ground", {});
  const StoreyIndex& storey = index.storeys.front();
  EXPECT_EQ(storey.lines.size(), lines);
  const Pose2 X_IW = heading(index.X_WI).inverse();
  const auto range = [&](double z) {
    const PlanRay ray{X_IW * Eigen::Vector2d(1.0, 2.2), X_IW.rotation() * Eigen::Vector2d::UnitX(), z, 0.0};
    return storey.grid.cast(storey.segments, ray, 10.0);
  };
  EXPECT_NEAR(range(0.7).distance, 2.0, 1e-5);
  EXPECT_NEAR(range(1.2).distance, 5.0, 1e-5);
  // Free space lies on the left of each side.
  const PlanSegment& side = storey.segments[static_cast<std::size_t>(range(0.7).segment)];
  EXPECT_LT(side.n.dot(X_IW.rotation() * Eigen::Vector2d::UnitX()), -0.99);
}

TEST(PlanIndex, LeavesOutWhatNoRoomSees) {
  bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const PlanIndex index = make_plan_index(plan, "ground", {});
  bim::PlanFace stray = plan.faces.front();
  stray.wall_id = "stray";
  stray.p0 += Eigen::Vector2d(4000.0, 3000.0);
  stray.p1 += Eigen::Vector2d(4000.0, 3000.0);
  plan.faces.push_back(stray);
  expect_equal_tables(index, make_plan_index(plan, "ground", {}));
}

}  // namespace
}  // namespace plumbline::slam
