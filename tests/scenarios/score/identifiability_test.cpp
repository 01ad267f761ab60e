// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/identifiability.h"

#include <gtest/gtest.h>

#include <utility>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "bim/model/extrude.h"
#include "bim/symmetry/symmetry.h"
#include "scenarios/metrics/storey.h"
#include "tests/scenarios/raised_rooms.h"

namespace plumbline::scenarios::score {
namespace {

/// A point-symmetric floor with one cupboard.
bim::Building furnished() {
  bim::Building building = bim::read_plan_text(bim::write_plan(bim::generate("rot180", Tree::map()).plan), "generated");
  const PolygonWithHoles2 outline{{{0.3, 3.0}, {0.9, 3.0}, {0.9, 4.2}, {0.3, 4.2}}, {}};
  bim::Obstacle cupboard;
  cupboard.id = "cupboard";
  cupboard.kind = "box";
  cupboard.storey = 0;
  cupboard.body = bim::extrude({outline}, 0.0, 1.9);
  building.obstacles.push_back(std::move(cupboard));
  return building;
}

/// The half turn that takes the floor onto itself.
Pose half_turn_of(const bim::Building& plan) {
  bim::Building bare = plan;
  bare.obstacles.clear();
  const bim::SymmetryReport report = bim::analyse_symmetry(bare);
  const bim::Isometry2& g = report.building.at(0).isometry;
  return Pose::from_xyz_yaw({g.t.x(), g.t.y(), 0.0}, g.angle);
}

/// A walk of 2 m in the room of the cupboard.
FinishedRun walk_in(const RunBuilding& building) {
  FinishedRun run;
  run.building = std::make_shared<const RunBuilding>(building.variants(), building.told_furniture());
  for (int i = 0; i <= 40; ++i) {
    const slam::Nanoseconds stamp = slam::Nanoseconds{100'000'000} * i;
    run.scans.push_back(stamp);
    run.record.truth_W.push_back({stamp, Pose::from_xyz_yaw({2.0 + 0.05 * i, 2.0, base_height_m()}, 0.4)});
  }
  return run;
}

std::optional<Identifiability> answers_of(const RunBuilding& building) {
  const FinishedRun run = walk_in(building);
  return identifiability_of(run, {run.record.truth_W, run.scans, std::nullopt});
}

TEST(IdentifiabilityOfARun, FurnitureCountsInTheSecondAnswerOnly) {
  const bim::Building plan = furnished();
  for (const ToldFurniture told : {ToldFurniture::as_planned, ToldFurniture::none}) {
    const auto known = answers_of(RunBuilding({plan, plan, {}, true}, told));
    ASSERT_TRUE(known.has_value());
    EXPECT_FALSE(known->identifiable);
    ASSERT_EQ(known->others_W.size(), 1U);
    EXPECT_FALSE(known->marginal_from_s.has_value());
    ASSERT_EQ(known->with_furniture.has_value(), told == ToldFurniture::as_planned);
    if (known->with_furniture) EXPECT_TRUE(known->with_furniture->identifiable);
  }
}

/// Nobody knows the pose by a piece that only the plan has.
TEST(IdentifiabilityOfARun, FurnitureThatIsGoneTellsNothing) {
  const bim::Building plan = furnished();
  bim::Building built = plan;
  built.obstacles.front().id = "another";
  built.obstacles.front().planned = false;
  const bim::PlannedAndBuilt all_gone{
      plan, built, {{"remove_furniture", "cupboard"}, {"add_furniture", "another"}}, true};
  auto known = answers_of(RunBuilding(all_gone));
  ASSERT_TRUE(known.has_value());
  EXPECT_FALSE(known->identifiable);
  EXPECT_FALSE(known->with_furniture.has_value());

  // Its image under the half turn would have to be seen from the other pose, where the plan has the gone piece.
  bim::PlannedAndBuilt one_gone{plan, plan, {{"remove_furniture", "cupboard"}}, true};
  const bim::Obstacle& cupboard = plan.obstacles.front();
  const Pose half_turn = half_turn_of(plan);
  bim::Obstacle gone = cupboard, twin = cupboard;
  gone.id = "gone";
  twin.id = "twin";
  for (Eigen::Vector3d& p : twin.body.vertices) p = half_turn * p;
  for (Eigen::Vector3d& p : gone.body.vertices) p = half_turn * (p + Eigen::Vector3d(0.0, -2.0, 0.0));
  one_gone.as_planned.obstacles = {cupboard, twin, gone};
  one_gone.as_built.obstacles = {cupboard, twin};
  one_gone.changes = {{"remove_furniture", "gone"}};
  known = answers_of(RunBuilding(one_gone));
  ASSERT_TRUE(known.has_value());
  ASSERT_TRUE(known->with_furniture.has_value());
  EXPECT_FALSE(known->with_furniture->identifiable);
}

/// Between walls so near to each other no robot stands: that no other place is found does not make one unique.
TEST(IdentifiabilityOfARun, IsAbsentForAPlanWithoutPlaces) {
  const bim::Building plan = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls:\n  - {id: s, storey: g, a: [0, 0], b: [4, 0]}\n"
      "  - {id: n, storey: g, a: [4, 0.6], b: [0, 0.6]}\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [4, 0], [4, 0.6], [0, 0.6]]}]\n",
      "narrow.plan.yaml");
  EXPECT_FALSE(answers_of(RunBuilding({plan, plan, {}, true})).has_value());
}

TEST(IdentifiabilityOfARun, IsOneAnswerWhereNothingMayHaveMoved) {
  bim::Building plan = furnished();
  plan.obstacles.clear();
  const auto known = answers_of(RunBuilding({plan, plan, {}, true}));
  ASSERT_TRUE(known.has_value());
  EXPECT_FALSE(known->identifiable);
  EXPECT_FALSE(known->with_furniture.has_value());
}

// Among the places along a corridor, whose scans are much alike, the search must come to the half turn.
TEST(IdentifiabilityOfARun, ALongCorridorHasItsHalfTurnWhereverTheWalkBegins) {
  const bim::GeneratedPlan generated = bim::generate("long", Tree::map().set("seed", 1));
  const bim::Building plan = bim::read_plan_text(bim::write_plan(generated.plan), "generated");
  const RunBuilding building({plan, plan, {}, true});
  for (const double x : {8.0, 11.0, 13.35, 16.0}) {
    FinishedRun run;
    run.building = std::make_shared<const RunBuilding>(building.variants(), building.told_furniture());
    for (int i = 0; i <= 30; ++i) {
      const slam::Nanoseconds stamp = slam::Nanoseconds{100'000'000} * i;
      run.scans.push_back(stamp);
      run.record.truth_W.push_back(
          {stamp, Pose::from_xyz_yaw({x + 0.05 * i, 0.951, base_height_m()}, i == 0 ? -0.0781 : 0.0)});
    }
    const auto known = identifiability_of(run, {run.record.truth_W, run.scans, std::nullopt});
    ASSERT_TRUE(known.has_value());
    EXPECT_FALSE(known->identifiable) << x;
  }
}

/// Rooms that all lie above their storey are as much alike as they were on it, though the robot's base bobs.
TEST(IdentifiabilityOfARun, RaisedFloorsAreAsAlikeAsLevelOnes) {
  constexpr double rise_m = 0.3;
  bim::Building plan = furnished();
  plan.obstacles.clear();
  raise_rooms(plan, rise_m);
  FinishedRun run = walk_in(RunBuilding({plan, plan, {}, true}));
  for (std::size_t i = 0; i < run.record.truth_W.size(); ++i)
    run.record.truth_W[i].X_FR.t.z() += rise_m + (i % 2 == 0 ? 0.02 : -0.02);
  const auto known = identifiability_of(run, {run.record.truth_W, run.scans, std::nullopt});
  ASSERT_TRUE(known.has_value());
  EXPECT_FALSE(known->identifiable);
  EXPECT_EQ(known->others_W.size(), 1U);
}

TEST(IdentifiabilityOfARun, InstallationsCountAsBuilding) {
  bim::Building plan = furnished();
  plan.obstacles.front().kind = "sanitary_terminal";
  const auto known = answers_of(RunBuilding({plan, plan, {}, true}));
  ASSERT_TRUE(known.has_value());
  EXPECT_TRUE(known->identifiable);
  EXPECT_FALSE(known->with_furniture.has_value());
}

}  // namespace
}  // namespace plumbline::scenarios::score
