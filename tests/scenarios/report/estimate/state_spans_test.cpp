// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/state_spans.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds tenth = 100'000'000;

std::vector<slam::Nanoseconds> every_tenth(int count, slam::Nanoseconds from = 0) {
  std::vector<slam::Nanoseconds> scans;
  for (int i = 0; i < count; ++i) scans.push_back(from + i * tenth);
  return scans;
}

TEST(StateSpans, OfSlamAreWhereItWasLost) {
  MethodRecord method;
  method.lost = {{3 * tenth, 5 * tenth}, {9 * tenth, 10 * tenth}};
  const std::vector<StateSpan> spans = state_spans(method, every_tenth(11));
  ASSERT_EQ(spans.size(), 4U);
  EXPECT_EQ(spans[0].state, "followed");
  EXPECT_EQ(spans[1].state, "LOST");
  EXPECT_DOUBLE_EQ(spans[1].from_s, 0.3);
  EXPECT_DOUBLE_EQ(spans[1].to_s, 0.6);  // a state holds until the next scan
  EXPECT_EQ(spans[3].state, "LOST");
  EXPECT_DOUBLE_EQ(spans[3].to_s, 1.0);
  EXPECT_NEAR(share_of_time(spans, "LOST"), 0.4, 1e-9);
  EXPECT_NEAR(share_of_time(spans, "followed"), 0.6, 1e-9);
  EXPECT_EQ(share_of_time(spans, "CONVERGED"), 0.0);
}

TEST(StateSpans, OfALocalizationAreWhatItSaid) {
  MethodRecord method;
  method.localization = true;
  const slam::Nanoseconds from = 1'000 * tenth;
  for (int i = 0; i < 10; ++i) {
    BeliefRecord& belief = method.beliefs.emplace_back();
    belief.stamp = from + i * tenth;
    belief.state = i < 5 ? slam::State::searching : slam::State::converged;
  }
  const std::vector<StateSpan> spans = state_spans(method, every_tenth(10, from));
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].state, "SEARCHING");
  EXPECT_DOUBLE_EQ(spans[1].from_s, 0.5);
  EXPECT_DOUBLE_EQ(spans[1].to_s, 0.9);
  method.beliefs.clear();
  EXPECT_TRUE(state_spans(method, every_tenth(10, from)).empty());
}

TEST(StateSpans, OfOneScanAreAllOfIt) {
  const std::vector<StateSpan> spans = state_spans(MethodRecord(), {5});
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(share_of_time(spans, "followed"), 1.0);
  EXPECT_EQ(share_of_time({}, "followed"), 0.0);
}

TEST(ScanPauses, AreLongForTheSensor) {
  std::vector<slam::Nanoseconds> scans = every_tenth(20, 7 * tenth);
  EXPECT_TRUE(scan_pauses(scans).empty());
  scans.push_back(scans.back() + 15 * tenth);
  scans.push_back(scans.back() + tenth);
  scans.push_back(scans.back() + 32 * tenth);
  const std::vector<ScanPause> pauses = scan_pauses(scans);
  ASSERT_EQ(pauses.size(), 2U);
  EXPECT_NEAR(pauses[0].to_s - pauses[0].from_s, 3.2, 1e-9);
  EXPECT_NEAR(pauses[1].from_s, 1.9, 1e-9);
  EXPECT_NEAR(usual_interval_s(scans), 0.1, 1e-9);
  EXPECT_EQ(usual_interval_s({5}), 0.0);
  std::vector<slam::Nanoseconds> slow;  // a scan a second has no pauses of a second
  for (int i = 0; i < 10; ++i) slow.push_back(11 * tenth * i);
  EXPECT_TRUE(scan_pauses(slow).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
