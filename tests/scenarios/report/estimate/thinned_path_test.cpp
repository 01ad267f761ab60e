// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/thinned_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::scenarios {
namespace {

/// 0.1 s and 0.2 m from sample to sample.
std::vector<ReportSample> long_path(int samples) {
  std::vector<ReportSample> path;
  for (int i = 0; i < samples; ++i) path.push_back({0.1 * i, 0.2 * i, 0.0, 0.0});
  return path;
}

TEST(ThinnedPath, StaysWholeUpToFiveThousandSamples) {
  EXPECT_EQ(drawn_one_in(1), 1U);
  EXPECT_EQ(drawn_one_in(5000), 1U);
  EXPECT_EQ(drawn_one_in(5001), 2U);
  EXPECT_EQ(drawn_one_in(100'000), 20U);
  EXPECT_EQ(thinned_path(long_path(50), 1).size(), 50U);
  EXPECT_TRUE(thinned_path({}, 1).empty());
}

TEST(ThinnedPath, KeepsTheFirstAndTheLast) {
  const std::vector<ReportSample> kept = thinned_path(long_path(96), 10);
  ASSERT_EQ(kept.size(), 11U);
  EXPECT_EQ(kept.front().t_s, 0.0);
  EXPECT_NEAR(kept.back().t_s, 9.5, 1e-9);
}

TEST(ThinnedPath, KeepsWhereItWasLostAndWhereAStoreyChanges) {
  std::vector<ReportSample> path = long_path(96);
  for (std::size_t i = 33; i < 37; ++i) path[i].lost = true;
  for (std::size_t i = 72; i < path.size(); ++i) path[i].storey = 1;
  std::vector<double> times;
  for (const ReportSample& sample : thinned_path(path, 10)) times.push_back(std::round(10.0 * sample.t_s));
  EXPECT_EQ(times, (std::vector<double>{0, 10, 20, 30, 32, 33, 36, 37, 40, 50, 60, 70, 71, 72, 80, 90, 95}));
}

TEST(ThinnedPath, IsBoundedHoweverOftenItWasLost) {
  std::vector<ReportSample> path = long_path(60'000);
  for (std::size_t i = 0; i < path.size(); i += 2) path[i].lost = true;
  const std::vector<ReportSample> kept = thinned_path(path, drawn_one_in(path.size()));
  EXPECT_LE(kept.size(), 10'001U);
  EXPECT_GT(kept.size(), 9'000U);
}

TEST(ThinnedPath, IsJoinedOverItsUsualSteps) {
  const PathBreaks whole = breaks_of(long_path(100), 1);
  EXPECT_NEAR(whole.gap_s, 1.0, 1e-9);
  EXPECT_NEAR(whole.jump_m, 1.0, 1e-9);
  const PathBreaks thinned = breaks_of(long_path(100), 10);
  EXPECT_NEAR(thinned.gap_s, 5.0, 1e-9);
  EXPECT_NEAR(thinned.jump_m, 10.0, 1e-9);
  EXPECT_EQ(breaks_of({}, 1).gap_s, PathBreaks().gap_s);
}

}  // namespace
}  // namespace plumbline::scenarios
