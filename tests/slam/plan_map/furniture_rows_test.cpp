// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/furniture_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bim/random/stream.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/plan_map/planned_furniture.h"

namespace plumbline::slam {
namespace {

std::vector<WallLine> rows_of(const bim::Plan& plan) { return make_plan_index(plan, "ground", {}).storeys[0].rows; }

bim::Plan hall() { return synthetic::plan_of(synthetic::one_room(12.0, 8.0)); }

PlanIndexConfig without_furniture() {
  PlanIndexConfig config;
  config.furniture = false;
  return config;
}

std::vector<double> lengths(const bim::Plan& plan) {
  std::vector<double> lengths;
  for (const WallLine& row : make_plan_index(plan, "ground", without_furniture()).storeys[0].rows)
    lengths.push_back(row.length);
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

TEST(FurnitureRows, ShelvesSideBySideAreOneRowSeenFromBothSides) {
  bim::Plan plan = hall();
  for (int i = 0; i < 4; ++i) synthetic::add_furniture(plan, {2.0 + 1.2 * i, 3.0, 0.0}, {3.2 + 1.2 * i, 3.6, 2.0});
  const std::vector<double> rows = lengths(plan);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0], 4.8, 1e-6);
  EXPECT_NEAR(rows[1], 4.8, 1e-6);
  EXPECT_TRUE(rows_of(plan).empty()) << "furniture is part of the walls where the configuration says so";
}

TEST(FurnitureRows, AreNeitherLowNorShortNorApart) {
  bim::Plan plan = hall();
  synthetic::add_furniture(plan, {2.0, 3.0, 0.0}, {7.0, 3.6, 0.9});  // a counter
  synthetic::add_furniture(plan, {8.0, 3.0, 0.0}, {9.0, 3.6, 2.0});  // a wardrobe
  for (int i = 0; i < 5; ++i) synthetic::add_furniture(plan, {2.0 + 2.0 * i, 5.0, 0.0}, {3.0 + 2.0 * i, 5.6, 2.0});
  EXPECT_TRUE(lengths(plan).empty());
}

// As the walls: the plan-fixed frame moves along.
TEST(FurnitureRows, AreTheSameInAPlanThatIsMoved) {
  bim::Plan plan = hall();
  synthetic::add_furniture(plan, {2.0, 3.0, 0.0}, {7.0, 3.6, 2.0});
  const Stream stream(5, "slam.localize.init");
  for (std::uint32_t i = 0; i < 10; ++i) {
    const Pose X_VW =
        Pose::from_xyz_yaw({50.0 * stream.gauss(0, i, 0), 50.0 * stream.gauss(0, i, 1), 2.0}, stream.gauss(0, i, 2));
    bim::Plan moved = bim::transformed(plan, X_VW);
    const auto here = make_plan_index(plan, "ground", without_furniture()).storeys[0].rows;
    const auto there = make_plan_index(moved, "ground", without_furniture()).storeys[0].rows;
    ASSERT_EQ(here.size(), 2U);
    ASSERT_EQ(there.size(), 2U) << i;
    for (std::size_t k = 0; k < here.size(); ++k) EXPECT_LT((here[k].a - there[k].a).norm(), 1e-5) << i;
  }
}

}  // namespace
}  // namespace plumbline::slam
