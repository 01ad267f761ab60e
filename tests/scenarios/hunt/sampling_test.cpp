// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace plumbline::scenarios {
namespace {

HuntRange range(double min, double max) {
  HuntRange made;
  made.key = "k";
  made.min = min;
  made.max = max;
  return made;
}

TEST(LatinHypercube, EveryIntervalOfEveryDimensionHasOnePoint) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    for (const std::size_t count : {1U, 2U, 17U, 100U}) {
      const std::vector<Point> points = latin_hypercube(count, 5, Stream(seed, "scenario.hunt"));
      ASSERT_EQ(points.size(), count);
      for (std::size_t k = 0; k < 5; ++k) {
        std::set<std::size_t> intervals;
        for (const Point& point : points) {
          ASSERT_GE(point[k], 0.0);
          ASSERT_LT(point[k], 1.0);
          intervals.insert(static_cast<std::size_t>(point[k] * static_cast<double>(count)));
        }
        EXPECT_EQ(intervals.size(), count) << k;
      }
    }
}

TEST(LatinHypercube, SeedsAndDimensionsDiffer) {
  const auto points = latin_hypercube(30, 2, Stream(1, "scenario.hunt"));
  EXPECT_EQ(points, latin_hypercube(30, 2, Stream(1, "scenario.hunt")));
  EXPECT_NE(points, latin_hypercube(30, 2, Stream(2, "scenario.hunt")));
  EXPECT_FALSE(std::all_of(points.begin(), points.end(), [](const Point& p) { return std::abs(p[0] - p[1]) < 0.05; }));
}

TEST(NearPoint, StaysInTheCubeAndNearWhereItIsNarrow) {
  const Stream stream(7, "scenario.hunt");
  for (const double at : {0.0, 0.3, 0.999}) {
    double moved = 0.0;
    for (std::uint64_t tick = 0; tick < 300; ++tick) {
      for (const double sigma : {0.02, 5.0})
        for (const double u : near_point({at, at}, sigma, stream, tick)) {
          EXPECT_GE(u, 0.0);
          EXPECT_LT(u, 1.0);
        }
      const Point near = near_point({at, at}, 0.02, stream, tick);
      EXPECT_LT(std::abs(near[0] - at), 0.2);
      EXPECT_NE(near[0], near[1]);
      moved += std::abs(near[0] - at);
    }
    EXPECT_GT(moved, 0.5);
  }
}

TEST(HuntValue, RangesAreCoveredFromEndToEnd) {
  EXPECT_EQ(value_at(range(2, 4), 0.0), "2");
  EXPECT_EQ(value_at(range(2, 4), 0.5), "3");
  EXPECT_EQ(value_at(range(0.3, 0.3), 0.7), "0.3");
  HuntRange ratio = range(0.01, 1);
  ratio.log = true;
  EXPECT_EQ(value_at(ratio, 0.0), "0.01");
  EXPECT_EQ(value_at(ratio, 0.5), "0.1");
  HuntRange named;
  named.values = {"a", "b", "c"};
  EXPECT_EQ(value_at(named, 0.0), "a");
  EXPECT_EQ(value_at(named, 0.5), "b");
  EXPECT_EQ(value_at(named, 0.999999), "c");
}

TEST(HuntValue, WholeNumbersHaveAllTheirDigits) {
  HuntRange whole = range(100000, 100000);
  whole.whole = true;
  EXPECT_EQ(value_at(whole, 0.5), "100000");
}

TEST(HuntValue, NoValuePassesABound) {
  EXPECT_EQ(value_at(range(0.123456, 0.123456), 0.5), "0.123456");
  EXPECT_EQ(value_at(range(0.123444, 1), 0.0), "0.123444");
  EXPECT_EQ(value_at(range(0.1, 0.987656), 1.0 - 1e-12), "0.987656");
  HuntRange whole = range(1.2, 3.8);
  whole.whole = true;
  EXPECT_EQ(value_at(whole, 0.0), "2");
  EXPECT_EQ(value_at(whole, 0.49), "2");
  EXPECT_EQ(value_at(whole, 0.51), "3");
  EXPECT_EQ(value_at(whole, 1.0 - 1e-12), "3");
}

TEST(HuntValue, WholeNumbersAreEquallyLikely) {
  for (const bool log : {false, true}) {
    HuntRange whole = range(3, 6);
    whole.whole = true;
    whole.log = log;
    std::map<std::string, int> counts;
    for (int i = 0; i < 1000; ++i) ++counts[value_at(whole, (i + 0.5) / 1000.0)];
    ASSERT_EQ(counts.size(), 4U);
    EXPECT_EQ(counts.begin()->first, "3");
    for (const auto& [value, count] : counts) EXPECT_NEAR(count, 250, log ? 100 : 1) << value;
  }
}

}  // namespace
}  // namespace plumbline::scenarios
