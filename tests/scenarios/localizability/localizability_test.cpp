// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/bim/rays/box_mesh.h"

namespace plumbline::scenarios {
namespace {

using bim::add_box;

/// Runs the analysis on a mesh that is built as planned.
RunIdentifiability identify(const bim::BuildingMesh& mesh, const Eigen::Vector2d& size, bool yaw_known,
                            const std::vector<Eigen::Vector2d>& path) {
  const bim::RayScene scene(mesh);
  LocalizabilityInput input;
  input.as_planned = &scene;
  input.as_built = &scene;
  input.storeys = {{Eigen::Vector2d::Zero(), size, {}}};
  input.yaw_known = yaw_known;
  std::vector<TruthSample> truth;
  double t = 0.0;
  for (const auto& p : path) truth.push_back({t += 1.0, Pose::from_xyz_yaw({p.x(), p.y(), 0.5}, 0.3)});
  return compute_localizability(input, truth);
}

std::vector<Eigen::Vector2d> walk(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i <= 10; ++i) path.push_back(a + 0.1 * i * (b - a));
  return path;
}

TEST(Localizability, RectangleHasOneAliasAndNoneWithACompass) {
  const auto mesh = bim::box_room({6.0, 4.0, 3.0});
  const auto path = walk({1.5, 1.2}, {4.0, 2.5});
  const auto unknown = identify(mesh, {6.0, 4.0}, false, path);
  for (const auto& step : unknown.steps) EXPECT_EQ(step.alive.size(), 1U);
  EXPECT_FALSE(unknown.identifiable);
  const auto known = identify(mesh, {6.0, 4.0}, true, path);
  EXPECT_TRUE(known.identifiable);
  EXPECT_EQ(known.identifiable_at_m, 0.0);
}

TEST(Localizability, AliasOfARectangleIsTheHalfTurn) {
  const auto run = identify(bim::box_room({6.0, 4.0, 3.0}), {6.0, 4.0}, false, walk({1.5, 1.2}, {4.0, 2.5}));
  const Pose X_WR = Pose::from_xyz_yaw({1.5, 1.2, 0.5}, 0.3);
  const auto set = run.ambiguity_set(1.0, X_WR);
  ASSERT_EQ(set.size(), 1U);
  // The refinement converges on noise-free views; a tenth of a millimetre is far below the model's 20 mm.
  EXPECT_NEAR(set[0].t.x(), 4.5, 1e-4);
  EXPECT_NEAR(set[0].t.y(), 2.8, 1e-4);
  EXPECT_NEAR(wrap_angle(set[0].yaw() - 0.3 - std::numbers::pi), 0.0, 1e-4);
}

TEST(Localizability, SquareHasThreeAliases) {
  const auto run = identify(bim::box_room({5.0, 5.0, 3.0}), {5.0, 5.0}, false, walk({1.5, 1.2}, {2.0, 3.5}));
  EXPECT_EQ(run.steps.front().alive.size(), 3U);
  EXPECT_EQ(run.steps.back().alive.size(), 3U);
}

TEST(Localizability, WhereNoPlaceWasLookedAtThePoseIsNotUnique) {
  const auto run = identify(bim::box_room({6.0, 4.0, 3.0}), {0.1, 0.1}, false, walk({1.5, 1.2}, {2.0, 2.5}));
  EXPECT_EQ(run.places, 0U);
  EXPECT_FALSE(run.identifiable);
  EXPECT_FALSE(run.identifiable_at_s.has_value());
}

TEST(Localizability, OnePillarBreaksTheSymmetry) {
  auto mesh = bim::box_room({6.0, 4.0, 3.0});
  add_box(mesh, {4.6, 0.4, 0.0}, {5.0, 0.8, 3.0});
  const auto run = identify(mesh, {6.0, 4.0}, false, walk({1.5, 1.2}, {2.0, 2.5}));
  EXPECT_TRUE(run.identifiable);
  EXPECT_EQ(run.identifiable_at_m, 0.0);
  EXPECT_FALSE(run.decided_by.has_value());  // the first scan sufficed
}

TEST(Localizability, TheDecidingElementIsNamedWhetherItIsVisibleOrMissing) {
  // A low box of which one scan shows too little to tell; a wall hides nothing, so both places see it or miss it.
  for (const bool beside : {true, false}) {
    auto mesh = bim::box_room({12.0, 4.0, 3.0});
    const int room_elements = mesh.element.back() + 1;
    add_box(mesh, {10.0, 1.9, 0.0}, {10.06, 1.96, 3.0});
    const auto path = beside ? walk({8.0, 2.6}, {9.5, 2.6}) : walk({4.0, 1.4}, {2.5, 1.4});
    const auto run = identify(mesh, {12.0, 4.0}, false, path);
    ASSERT_EQ(run.steps.front().alive.size(), 1U);
    ASSERT_TRUE(run.identifiable);
    ASSERT_TRUE(run.decided_by.has_value());
    EXPECT_EQ(run.decided_by->element, room_elements);
    EXPECT_EQ(run.decided_by->missing, !beside);
    EXPECT_GT(run.decided_by->share, 0.5);
  }
}

/// Two identical 4 x 4 m rooms with doors onto a corridor of 8 x 2 m, whose ends differ in distance.
bim::BuildingMesh equal_rooms() {
  auto mesh = bim::box_room({8.0, 6.2, 3.0});
  add_box(mesh, {3.9, 2.2, 0.0}, {4.1, 6.2, 3.0});
  for (const double x : {0.0, 4.0}) {
    add_box(mesh, {x, 2.0, 0.0}, {x + 1.5, 2.2, 3.0});
    add_box(mesh, {x + 2.5, 2.0, 0.0}, {x + 4.0, 2.2, 3.0});
    add_box(mesh, {x + 1.5, 2.0, 2.1}, {x + 2.5, 2.2, 3.0});
  }
  // Make both rooms 3.9 m wide: the outer walls are 0.1 m further out than the wall between them.
  add_box(mesh, {0.0, 2.2, 0.0}, {0.1, 6.2, 3.0});
  add_box(mesh, {7.9, 2.2, 0.0}, {8.0, 6.2, 3.0});
  return mesh;
}

TEST(Localizability, EqualRoomsAreResolvedInTheCorridor) {
  // With a compass, the view through the door shows only the corridor's far wall, which is the same from both rooms.
  std::vector<Eigen::Vector2d> path = walk({2.0, 5.5}, {2.0, 3.5});
  const auto inside = identify(equal_rooms(), {8.0, 6.2}, true, path);
  EXPECT_EQ(inside.steps.front().alive.size(), 1U);
  for (const auto& p : walk({2.0, 3.4}, {2.0, 1.0})) path.push_back(p);
  const auto out = identify(equal_rooms(), {8.0, 6.2}, true, path);
  EXPECT_TRUE(out.identifiable);
  ASSERT_TRUE(out.identifiable_at_m.has_value());
  EXPECT_GT(*out.identifiable_at_m, 0.4);
}

}  // namespace
}  // namespace plumbline::scenarios
