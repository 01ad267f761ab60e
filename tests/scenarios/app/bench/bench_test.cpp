// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/bench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/app/bench/lattice.h"

namespace plumbline::scenarios {
namespace {

TEST(Bench, RowIsTheMedianWithItsRange) {
  const BenchRow odd = make_row("a", "s", {3.0, 1.0, 2.0});
  EXPECT_EQ(odd.value, 2.0);
  EXPECT_EQ(odd.low, 1.0);
  EXPECT_EQ(odd.high, 3.0);
  EXPECT_EQ(make_row("b", "s", {4.0, 1.0, 2.0, 3.0}).value, 2.5);
  EXPECT_THROW((void)make_row("c", "s", {}), InternalError);
}

TEST(Bench, LimitsHoldOnBothSides) {
  EXPECT_TRUE(make_row("a", "s", {1.0}).passed());
  EXPECT_TRUE(make_row("a", "s", {1.0}, BenchLimit{1.0}).passed());
  EXPECT_FALSE(make_row("a", "s", {1.1}, BenchLimit{1.0}).passed());
  EXPECT_TRUE(make_row("a", "", {2.6}, BenchLimit{2.5, false, true}).passed());
  EXPECT_FALSE(make_row("a", "", {2.4}, BenchLimit{2.5, false, true}).passed());
}

TEST(Bench, GrowthExponentOfAPowerLaw) {
  for (const double power : {0.0, 1.0, 1.5, 2.0})
    EXPECT_NEAR(growth_exponent(1e3, 0.2 * std::pow(1e3, power), 1e4, 0.2 * std::pow(1e4, power)), power, 1e-12);
}

TEST(Bench, JsonHasALimitOnlyWhereThereIsOne) {
  const Tree tree = bench_json({make_row("free", "s", {1.0}), make_row("bound", "s", {2.0}, BenchLimit{1.0})});
  const Tree::List& rows = tree.find("bench")->as_list();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].find("limit"), nullptr);
  EXPECT_EQ(rows[0].find("passed"), nullptr);
  EXPECT_EQ(rows[1].find("op")->as_string(), "<=");
  EXPECT_FALSE(rows[1].find("gate")->as_bool());
  EXPECT_FALSE(rows[1].find("passed")->as_bool());
}

TEST(Bench, LatticeIsAPlanOfTheSizeAskedFor) {
  for (const int walls : {1, 4, 100, 1000}) {
    const bim::Building building = bim::read_plan_text(lattice_plan(walls), "lattice");
    EXPECT_EQ(building.walls.size(), static_cast<std::size_t>(walls));
    EXPECT_EQ(building.openings.size(), 2 * building.walls.size());
    EXPECT_EQ(building.rooms.empty(), walls < 4);
    for (const bim::Room& room : building.rooms) EXPECT_EQ(room.walls.size(), 4U) << room.id;
  }
}

}  // namespace
}  // namespace plumbline::scenarios
