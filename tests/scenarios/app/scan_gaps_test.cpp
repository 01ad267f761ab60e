// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/scan_gaps.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds tenth = 100'000'000;

/// A scan each `step` tenths of a second for 10 s, but between the ends of the gaps.
std::optional<std::string> warning_of(const std::vector<std::pair<int, int>>& gaps, int step = 1) {
  ScanGaps found;
  for (int k = 0; k <= 100; k += step) {
    bool in_gap = false;
    for (const std::pair<int, int>& gap : gaps) in_gap = in_gap || (k > gap.first && k < gap.second);
    if (!in_gap) found.add(k * tenth);
  }
  return found.warning();
}

TEST(ScanGaps, AreSaid) {
  EXPECT_EQ(warning_of({}), std::nullopt);
  EXPECT_EQ(warning_of({{20, 30}}), std::nullopt) << "a second is no gap";
  EXPECT_EQ(warning_of({{20, 41}}), "no scan for 2.1 s after 2 s");
  EXPECT_EQ(warning_of({{20, 41}, {50, 80}}), "no scan for 3 s after 5 s, the longest of 2 such gaps");
}

TEST(ScanGaps, AreMeasuredByTheUsualSpacing) {
  EXPECT_EQ(warning_of({}, 10), std::nullopt);
  EXPECT_EQ(warning_of({{20, 60}}, 10), std::nullopt);
  EXPECT_EQ(warning_of({{20, 80}}, 10), "no scan for 6 s after 2 s");
  ScanGaps one;
  one.add(tenth);
  EXPECT_EQ(one.warning(), std::nullopt);
}

}  // namespace
}  // namespace plumbline::scenarios
