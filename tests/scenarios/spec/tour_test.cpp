// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/tour.h"

#include <gtest/gtest.h>

#include <set>

namespace plumbline::scenarios {
namespace {

/// Places on a line, a metre apart.
std::vector<sim::NeighbourWay> line_of(std::size_t count) {
  std::vector<sim::NeighbourWay> ways;
  for (std::size_t i = 1; i < count; ++i) ways.push_back({i - 1, i, 1.0});
  return ways;
}

/// A place on the ring as far from 0 as its number, either way round.
std::vector<sim::NeighbourWay> ring_of(std::size_t count) {
  std::vector<sim::NeighbourWay> ways = line_of(count);
  ways.push_back({0, count - 1, 1.0});
  return ways;
}

TEST(Tour, TakesAllWhereThereIsTime) {
  EXPECT_EQ(tour(5, line_of(5), 8.0).size(), 4U);
  const std::vector<std::size_t> round = tour(8, ring_of(8), 8.0);
  EXPECT_EQ(round.size(), 7U);
  // Once round, not to and fro.
  for (std::size_t i = 1; i < round.size(); ++i)
    EXPECT_EQ(round[1] > round[0], round[i] > round[i - 1]) << "place " << i;
}

TEST(Tour, IsNoLongerThanAllowedAndGoesFarFirst) {
  for (double longest = 2.0; longest < 40.0; longest += 2.0) {
    const std::vector<std::size_t> chosen = tour(30, line_of(30), longest);
    const std::set<std::size_t> places(chosen.begin(), chosen.end());
    ASSERT_FALSE(places.empty()) << longest;
    EXPECT_EQ(static_cast<double>(*places.rbegin()), longest / 2.0);    // there and back
    EXPECT_EQ(places.size(), static_cast<std::size_t>(longest / 2.0));  // what lies between costs nothing
  }
}

TEST(Tour, LeavesOutWhatHasNoWay) {
  std::vector<sim::NeighbourWay> ways = line_of(3);
  ways.push_back({3, 4, 1.0});
  EXPECT_EQ(tour(5, ways, 100.0).size(), 2U);
  EXPECT_TRUE(tour(1, {}, 100.0).empty());
  EXPECT_TRUE(tour(0, {}, 100.0).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
