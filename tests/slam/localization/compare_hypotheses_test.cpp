// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/compare_hypotheses.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/random/stream.h"
#include "slam/localization/global_localizer.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

constexpr double shift_x = 9.0, shift_y = 1.0;  // of the second of the twin rooms

synthetic::Box column_at(double x, double y, double height = 2.8) { return {{x, y, 0.0}, {x + 0.4, y + 0.4, height}}; }

/// Furniture of a plan.
bim::BuildingMesh mesh_of(const synthetic::Box& box) {
  bim::BuildingMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
                               (i & 4) != 0 ? box.max.z() : box.min.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.element.assign(mesh.triangles.size(), 0);
  mesh.elements.emplace_back().kind = bim::ElementKind::obstacle;
  return mesh;
}

/// Standing where one stands, in the first room, compared with standing in the other.
PairwiseLikelihoodRatio compare_here_and_there(const synthetic::House& planned, const synthetic::House& built,
                                               const Pose& X_WR, std::uint64_t seed,
                                               const bim::BuildingMesh& furniture = {}) {
  bim::Plan plan = synthetic::plan_of(planned);
  plan.furniture = furniture;
  const PlanIndex index = make_plan_index(plan, "ground", {});
  const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}, seed).scan;
  Pose X_there = X_WR;
  X_there.t += Eigen::Vector3d(shift_x, shift_y, 0.0);
  const Pose X_IW = index.X_WI.inverse();
  const StoreyIndex& storey = index.storeys.front();
  const PredictedScan here = predict_scan(storey, heading(X_IW * X_WR), scan, {}),
                      there = predict_scan(storey, heading(X_IW * X_there), scan, {});
  const PairwiseLikelihoodRatio said = compare_hypotheses(scan, here, there, {});
  EXPECT_EQ(compare_hypotheses(scan, there, here, {}).ratio, -said.ratio);
  return said;
}

double here_against_there(const synthetic::House& planned, const synthetic::House& built, const Pose& X_WR,
                          std::uint64_t seed) {
  return compare_here_and_there(planned, built, X_WR, seed).ratio;
}

HypothesisComparisonConfig capped_at(double object_cap, double cause_cap) {
  HypothesisComparisonConfig config;
  config.object_cap = config.outlined_cap = object_cap;
  config.cause_cap = config.missing_wall_cap = cause_cap;
  return config;
}

/// What evidence counts for once it was seen ever so often.
double in_the_end(const EvidenceByCause& evidence) {
  EvidenceByCause often;
  often.add(evidence, 1000.0);
  return often.total({});
}

class CompareHypothesesAt : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] Pose somewhere() const {
    const Stream stream(5, "slam.localize.init");
    const auto tick = static_cast<std::uint64_t>(GetParam());
    return Pose::from_xyz_yaw({1.0 + 2.0 * stream.uniform(tick, 0), 1.0 + 2.0 * stream.uniform(tick, 1), 0.46},
                              6.0 * stream.uniform(tick, 2));
  }
  const synthetic::House twins_ = synthetic::twin_rooms();
};

TEST_P(CompareHypothesesAt, RoomsThatAreAlikeAreNoEvidence) {
  EXPECT_EQ(here_against_there(twins_, twins_, somewhere(), 1), 0.0);
}

TEST_P(CompareHypothesesAt, UnplannedClutterIsNoEvidence) {
  synthetic::House built = twins_;
  built.boxes.push_back(column_at(4.2, 0.3));
  EXPECT_EQ(here_against_there(twins_, built, somewhere(), 2), 0.0);
}

TEST_P(CompareHypothesesAt, AColumnTellsItsRoomFromTheOther) {
  synthetic::House here = twins_, there = twins_;
  here.boxes.push_back(column_at(4.2, 0.3));
  there.boxes.push_back(column_at(4.2 + shift_x, 0.3 + shift_y));
  const double seen = here_against_there(here, here, somewhere(), 3);
  const double missed = here_against_there(there, there, somewhere(), 4);
  EXPECT_GT(seen, 2.0);
  // Beams that penetrate the other room's column are more evidence than beams cut short, which clutter may cause.
  EXPECT_GT(missed, 1.2 * seen);
}

TEST_P(CompareHypothesesAt, AColumnDecidesAndWiderFurnitureDoesNot) {
  const HypothesisComparisonConfig config;
  synthetic::House planned = twins_, cupboard = twins_;
  planned.boxes.push_back(column_at(4.2, 1.5));
  const PairwiseLikelihoodRatio column = compare_here_and_there(planned, planned, somewhere(), 5);
  EXPECT_NEAR(in_the_end(column.against_b), config.outlined_cap, 1e-9);
  EXPECT_EQ(in_the_end(column.against_a), 0.0);
  // Its front is where the other room's column would have its own, and goes on beside it.
  cupboard.boxes.push_back({{4.2, 1.5, 0.0}, {4.6, 2.7, 2.8}});
  planned = twins_;
  planned.boxes.push_back(column_at(4.2 + shift_x, 1.5 + shift_y));
  const PairwiseLikelihoodRatio furniture = compare_here_and_there(planned, cupboard, somewhere(), 6);
  EXPECT_GT(in_the_end(furniture.against_a), 0.0);
  EXPECT_LE(in_the_end(furniture.against_a), config.object_cap);
}

TEST_P(CompareHypothesesAt, AColumnDecidesWhereFurnitureStandsBesideIt) {
  synthetic::House planned = twins_;
  planned.boxes.push_back(column_at(4.2, 1.5));
  synthetic::House near = planned, touching = planned;
  near.boxes.push_back({{4.2, 2.05, 0.0}, {4.6, 2.85, 2.0}});
  touching.boxes.push_back({{4.2, 1.9, 0.0}, {4.6, 2.7, 2.0}});
  const HypothesisComparisonConfig config;
  EXPECT_NEAR(in_the_end(compare_here_and_there(planned, near, somewhere(), 9).against_b), config.outlined_cap, 1e-9);
  const PairwiseLikelihoodRatio told =
      compare_here_and_there(planned, touching, somewhere(), 9, mesh_of(touching.boxes.back()));
  EXPECT_NEAR(in_the_end(told.against_b), config.outlined_cap, 1e-9) << "the plan has furniture there";
  const PairwiseLikelihoodRatio unknown = compare_here_and_there(planned, touching, somewhere(), 9);
  EXPECT_LE(in_the_end(unknown.against_b), config.object_cap);
}

// The other room is 0.6 m less deep; where its wall is, cupboards stand here.
TEST_P(CompareHypothesesAt, AWallOfCupboardsDoesNotDecide) {
  const synthetic::Box cupboards{{4.4, 0.0, 0.0}, {5.0, 4.0, 2.4}};
  synthetic::House planned = twins_, built = twins_;
  planned.boxes.push_back({{4.4 + shift_x, shift_y, 0.0}, {5.0 + shift_x, 4.0 + shift_y, 2.8}});
  built.boxes.push_back(cupboards);
  const PairwiseLikelihoodRatio unknown = compare_here_and_there(planned, built, somewhere(), 7);
  EXPECT_GT(in_the_end(unknown.against_a), 0.0);
  EXPECT_LT(in_the_end(unknown.against_a), ConvergenceConfig{}.log_ratio);
  const PairwiseLikelihoodRatio told = compare_here_and_there(planned, built, somewhere(), 7, mesh_of(cupboards));
  EXPECT_EQ(in_the_end(told.against_a), 0.0);
  // Nor are they evidence for this room where they do not stand.
  const PairwiseLikelihoodRatio gone = compare_here_and_there(planned, twins_, somewhere(), 8, mesh_of(cupboards));
  const PairwiseLikelihoodRatio never = compare_here_and_there(planned, twins_, somewhere(), 8);
  EXPECT_EQ(in_the_end(gone.against_b), in_the_end(never.against_b));
  EXPECT_GT(in_the_end(gone.against_b), 0.0) << "beams pass the other room's wall";
}

// A beam that passes a post and ends far behind it passes the post's edge near by.
TEST_P(CompareHypothesesAt, APostNearByIsNoEvidenceForAPoseTwoCentimetresAside) {
  const Pose X_WR = somewhere();
  synthetic::House house = twins_;
  const Eigen::Vector2d post = X_WR.t.head<2>() + Eigen::Vector2d(0.0, -0.6);
  house.boxes.push_back({{post.x() - 0.02, post.y() - 0.02, 0.0}, {post.x() + 0.02, post.y() + 0.02, 2.8}});
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const LocalizationScan scan = synthetic::house_scan(house, X_WR, Pose{}, 8).scan;
  const auto predicted_at = [&](double aside_m) {
    Pose X = X_WR;
    X.t.x() += aside_m;
    return predict_scan(index.storeys.front(), heading(index.X_WI.inverse() * X), scan, {});
  };
  for (const double aside_m : {-0.02, 0.02})
    EXPECT_LT(compare_hypotheses(scan, predicted_at(0.0), predicted_at(aside_m), {}).ratio, 0.5) << aside_m;
}

// Beside the edge of a jamb near by, ranges to a wall seen at a grazing angle differ by half a metre from beam to beam.
TEST(CompareHypotheses, AJambBeforeAGrazingWallIsNoEvidenceForAPoseTwoCentimetresAside) {
  synthetic::House house = synthetic::one_room(12.0, 4.0);
  house.boxes.push_back({{1.6, 0.2, 0.0}, {1.8, 0.86, 2.8}});
  const Pose X_WR = Pose::from_xyz_yaw({1.0, 1.0, 0.46}, 0.3);
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const LocalizationScan scan = synthetic::house_scan(house, X_WR, Pose{}, 9).scan;
  const auto predicted_at = [&](double aside_m) {
    const Pose X = Pose::from_xyz_yaw(X_WR.t + Eigen::Vector3d(0.0, aside_m, 0.0), X_WR.yaw());
    return predict_scan(index.storeys.front(), heading(index.X_WI.inverse() * X), scan, {});
  };
  for (const double aside_m : {-0.02, 0.02})
    EXPECT_LT(compare_hypotheses(scan, predicted_at(0.0), predicted_at(aside_m), {}).ratio, 1.0) << aside_m;
}

TEST_P(CompareHypothesesAt, AWallThatStandsOutByTenCentimetresIsEvidence) {
  synthetic::House house = twins_;
  house.boxes.push_back({{4.9, 1.2, 0.0}, {5.0, 2.8, 2.8}});
  EXPECT_GT(here_against_there(house, house, somewhere(), 7), 2.0);
}

// A degree lifts a beam by half a step at 5 m, and the step behind the one that it should hit is a tread farther.
TEST_P(CompareHypothesesAt, StepsSpeakForTheirStairFromASensorThatIsTilted) {
  const synthetic::House without = synthetic::one_room(12.0, 4.0);
  synthetic::House with = without;
  for (int i = 0; i < 15; ++i)
    with.boxes.push_back({{5.0 + 0.28 * i, 0.3, 0.0}, {5.0 + 0.28 * (i + 1), 1.5, 0.18 * (i + 1)}});
  const PlanIndex stair = make_plan_index(synthetic::plan_of(with), "ground", {}),
                  none = make_plan_index(synthetic::plan_of(without), "ground", {});
  const double degree = std::numbers::pi / 180.0;
  Pose X_WR = somewhere();
  X_WR.q = exp_so3({0.0, -degree, 0.0}) * X_WR.q;
  LocalizationScan scan = synthetic::house_scan(with, X_WR, Pose{}, 9).scan;
  const auto compared = [&](double tilt_sigma) {
    scan.tilt_sigma = tilt_sigma;
    const auto seen = [&](const PlanIndex& index) {
      return predict_scan(index.storeys.front(), heading(index.X_WI.inverse() * X_WR), scan, {});
    };
    return compare_hypotheses(scan, seen(stair), seen(none), {});
  };
  const PairwiseLikelihoodRatio level = compared(0.0), tilted = compared(0.5 * degree);
  const HypothesisComparisonConfig uncapped = capped_at(1e9, 1e9);
  EXPECT_GT(level.against_a.total(uncapped), 0.0);
  EXPECT_LT(tilted.against_a.total(uncapped), 0.5 * level.against_a.total(uncapped));
  EXPECT_GT(tilted.against_b.total(uncapped), 0.9 * level.against_b.total(uncapped));
}

TEST_P(CompareHypothesesAt, APredictedScanIsWhatTheGridGivesBeamByBeam) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const StoreyIndex& storey = index.storeys.front();
  Pose X_WR = somewhere();
  X_WR.t.y() *= 0.6;  // in the corridor
  const LocalizationScan scan = synthetic::house_scan(house, X_WR, Pose{}).scan;
  const Pose2 X_IH = heading(index.X_WI.inverse() * X_WR);
  const HypothesisComparisonConfig config;
  const PredictedScan seen = predict_scan(storey, X_IH, scan, config);
  const double z = storey.floor_z + scan.sensor_height;
  int beams = 0, others = 0;
  for (std::size_t i = 0; i < scan.beam_grid.blocks.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const BeamGridBlock& block = scan.beam_grid.blocks[i];
      if (block.range[k] <= 0.0F) continue;
      const PlanRay ray{X_IH * scan.sensor_H, X_IH.rotation() * Eigen::Vector2d(block.x[k], block.y[k]), z,
                        block.slope[k]};
      double reach = block.range[k] + 2.0;
      if (ray.slope < 0.0) reach = std::min(reach, -scan.sensor_height / ray.slope);
      if (ray.slope > 0.0) reach = std::min(reach, (storey.ceiling_z - z) / ray.slope);
      const PlanHit hit = storey.grid.cast(storey.segments, ray, reach);
      ++beams;
      // Single precision within 20 m of the origin, and a beam that grazes an edge may go to either side of it.
      const int element = hit.segment < 0 ? -1 : storey.segments[static_cast<std::size_t>(hit.segment)].element;
      const bool same = seen.blocks[i].element[k] == element &&
                        std::abs(static_cast<double>(seen.blocks[i].expected[k]) - hit.distance) < 1e-4;
      others += same ? 0 : 1;
    }
  EXPECT_GT(beams, 4000);
  EXPECT_LE(others, beams / 1000);
}

// Two rooms with built-in cupboards, which stand where the rooms of another flat have their walls.
// A cupboard in a corner stands before two walls, and on the line between two cells.
// Nothing of the plan is in the way out there, so everything seen is something else that it does not show.
TEST(PairwiseLikelihoodRatio, OutsideOfThePlanEachThingSeenNeedsACauseOfItsOwn) {
  const synthetic::House house = synthetic::one_room();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const StoreyIndex& storey = index.storeys.front();
  const Pose X_WR = Pose::from_xyz_yaw({2.0, 1.5, 0.46}, 0.4);
  const LocalizationScan scan = synthetic::house_scan(house, X_WR, Pose{}).scan;
  const Pose2 X_IH = heading(index.X_WI.inverse() * X_WR);
  Pose2 outside = X_IH;
  outside.t += Eigen::Vector2d(60.0, 40.0);
  const HypothesisComparisonConfig config;
  const PairwiseLikelihoodRatio said = compare_hypotheses(scan, predict_scan(storey, X_IH, scan, config),
                                                          predict_scan(storey, outside, scan, config), config);
  EXPECT_EQ(said.against_a.total(config), 0.0);
  // The four walls, 20 m long, pass through 20 cells of 1 m or more; a cell that few beams end in counts less.
  EXPECT_GT(said.against_b.total(config), 10.0 * config.object_cap);
}

// A gap in a wall explains that beams pass it, and not what they meet where the plan has nothing.
TEST(PairwiseLikelihoodRatio, WhatStandsBehindAWallThatWasNotBuiltNeedsACauseOfItsOwn) {
  synthetic::House built = synthetic::one_room(12.0, 4.0), planned = built;
  built.boxes.push_back({{9.0, 0.0, 0.0}, {9.2, 4.0, 2.8}});
  planned.boxes.push_back({{5.0, 0.0, 0.0}, {5.2, 4.0, 2.8}});
  const HypothesisComparisonConfig config;
  const Pose X_WR = Pose::from_xyz_yaw({2.0, 1.7, 0.46}, 0.1);
  const auto against_plan = [&](const synthetic::House& world) {
    const PlanIndex with = make_plan_index(synthetic::plan_of(planned), "ground", {}),
                    right = make_plan_index(synthetic::plan_of(world), "ground", {});
    const LocalizationScan scan = synthetic::house_scan(world, X_WR, Pose{}).scan;
    const auto seen = [&](const PlanIndex& index) {
      return predict_scan(index.storeys.front(), heading(index.X_WI.inverse() * X_WR), scan, config);
    };
    return in_the_end(compare_hypotheses(scan, seen(right), seen(with), config).against_b);
  };
  EXPECT_NEAR(against_plan(synthetic::one_room(12.0, 4.0)), config.missing_wall_cap, 1e-9)
      << "beams end at the next wall";
  // Four metres of something straight, which counts beside the wall.
  EXPECT_GT(against_plan(built), config.cause_cap + config.front_cap);
}

// A niche is seen within the wall, which is there.
TEST(PairwiseLikelihoodRatio, ANicheInAWallIsNoMissingWall) {
  const auto wall_with = [](double niche_m) {
    synthetic::House house = synthetic::one_room(8.0, 4.0);
    house.boxes.push_back({{5.0, 0.0, 0.0}, {5.4, 1.2, 2.8}});
    house.boxes.push_back({{5.0 + niche_m, 1.2, 0.0}, {5.4, 2.8, 2.8}});
    house.boxes.push_back({{5.0, 2.8, 0.0}, {5.4, 4.0, 2.8}});
    return house;
  };
  const synthetic::House built = wall_with(0.2);
  const PlanIndex with = make_plan_index(synthetic::plan_of(built), "ground", {}),
                  without = make_plan_index(synthetic::plan_of(wall_with(0.0)), "ground", {});
  const HypothesisComparisonConfig config;
  const Pose X_WR = Pose::from_xyz_yaw({2.0, 1.7, 0.46}, 0.1);
  const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}).scan;
  const auto seen = [&](const PlanIndex& index) {
    return predict_scan(index.storeys.front(), heading(index.X_WI.inverse() * X_WR), scan, config);
  };
  EXPECT_GE(in_the_end(compare_hypotheses(scan, seen(with), seen(without), config).against_b), config.cause_cap);
}

// Beams pass the wall at a door that the plan has not, and meet the rest of it.
TEST(PairwiseLikelihoodRatio, AWallWithADoorElsewhereIsNoMissingWall) {
  synthetic::House built = synthetic::one_room(12.0, 4.0), planned = built;
  planned.boxes.push_back({{5.0, 0.0, 0.0}, {5.2, 4.0, 2.8}});
  built.boxes.push_back({{5.0, 0.0, 0.0}, {5.2, 1.5, 2.8}});
  built.boxes.push_back({{5.0, 1.8, 0.0}, {5.2, 4.0, 2.8}});
  const PlanIndex with = make_plan_index(synthetic::plan_of(built), "ground", {}),
                  without = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const HypothesisComparisonConfig config;
  const Pose X_WR = Pose::from_xyz_yaw({2.0, 1.7, 0.46}, 0.1);
  const auto against_plan = [&](const synthetic::House& world) {
    const LocalizationScan scan = synthetic::house_scan(world, X_WR, Pose{}).scan;
    const auto seen = [&](const PlanIndex& index) {
      return predict_scan(index.storeys.front(), heading(index.X_WI.inverse() * X_WR), scan, config);
    };
    return in_the_end(compare_hypotheses(scan, seen(with), seen(without), config).against_b);
  };
  EXPECT_NEAR(against_plan(built), config.cause_cap, 1e-9);
}

// Beams penetrate both of its faces, from either side.
TEST(PairwiseLikelihoodRatio, AWallThatWasNotBuiltIsOneCauseFromBothSides) {
  const synthetic::House built = synthetic::one_room(8.0, 4.0);
  synthetic::House planned = built;
  planned.boxes.push_back({{3.9, 0.0, 0.0}, {4.1, 4.0, 2.8}});
  const PlanIndex with = make_plan_index(synthetic::plan_of(planned), "ground", {}),
                  without = make_plan_index(synthetic::plan_of(built), "ground", {});
  const HypothesisComparisonConfig config;
  EvidenceByCause against;
  for (const double x : {2.0, 6.0}) {
    const Pose X_WR = Pose::from_xyz_yaw({x, 1.7, 0.46}, 0.1);
    const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}).scan;
    const PredictedScan sees_it = predict_scan(with.storeys.front(), heading(with.X_WI.inverse() * X_WR), scan, config),
                        sees_none =
                            predict_scan(without.storeys.front(), heading(without.X_WI.inverse() * X_WR), scan, config);
    const PairwiseLikelihoodRatio said = compare_hypotheses(scan, sees_it, sees_none, config);
    EXPECT_EQ(said.against_b.total(config), 0.0);
    EXPECT_GT(said.against_a.total(capped_at(1e9, 1e9)), config.cause_cap);
    against.add(said.against_a, 1.0);
  }
  EXPECT_NEAR(against.total(config), config.missing_wall_cap, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Places, CompareHypothesesAt, testing::Range(0, 6));

}  // namespace
}  // namespace plumbline::slam
