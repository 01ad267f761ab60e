// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/answer_sentence.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

TEST(AnswerSentence, OfALocalizationSaysHowItEnded) {
  MethodRecord method;
  method.localization = true;
  BeliefRecord& last = method.beliefs.emplace_back();
  last.hypotheses.push_back({1.0, Pose(), Eigen::Matrix3d::Zero(), "kitchen"});
  const std::vector<StateSpan> spans = {
      {0.0, 2.0, "SEARCHING"}, {2.0, 6.0, "CONVERGED"}, {6.0, 7.0, "LOST"}, {7.0, 10.0, "CONVERGED"}};
  EXPECT_EQ(answer_sentence(method, spans),
            "Ended CONVERGED in kitchen; it first announced a pose 2 s after the first scan. CONVERGED 70 % of the "
            "time, SEARCHING 20 %, LOST 10 %. It reported LOST from 6 s to 7 s.");
  EXPECT_EQ(final_state(method, spans), "CONVERGED");
}

TEST(AnswerSentence, OfALocalizationWithoutAnAnswerSaysSo) {
  MethodRecord method;
  method.localization = true;
  method.beliefs.emplace_back().hypotheses.resize(3);
  EXPECT_EQ(answer_sentence(method, {{0.0, 4.0, "AMBIGUOUS"}}),
            "Ended AMBIGUOUS with 3 hypotheses; it never announced a pose. AMBIGUOUS 100 % of the time.");
  EXPECT_EQ(answer_sentence(method, {{0.0, 4.0, "CONVERGED"}, {4.0, 9.0, "LOST"}}),
            "Ended LOST with 3 hypotheses; it first announced a pose 0 s after the first scan. LOST 56 % of the time, "
            "CONVERGED 44 %. It reported LOST from 4 s to the end.");
}

TEST(AnswerSentence, OfSlamSaysWhatItFollowedAndFound) {
  MethodRecord method;
  for (int i = 0; i <= 10; ++i) {
    Pose X_MR;
    X_MR.t.x() = 0.5 * i;
    method.causal.push_back({i * 1'000'000'000LL, X_MR});
  }
  method.scans = 12;
  EXPECT_EQ(answer_sentence(method, {}), "A path of 5 m in 10 s; 11 of 12 scans have a pose, never LOST.");
  method.lost_scans = 3;
  method.degenerate_scans = 6;
  method.estimate.loops.emplace().resize(1);
  method.estimate.planes.resize(4);
  method.estimate.rooms.resize(1);
  EXPECT_EQ(answer_sentence(method, {{0.0, 8.0, "followed"}, {8.0, 11.0, "LOST"}}),
            "A path of 5 m in 10 s; 11 of 12 scans have a pose, LOST at 3 (25 %), 6 (50 %) leave a direction of the "
            "pose open. Found: 4 planes, 1 room. 1 loop closed. It reported LOST from 8 s to the end.");
}

TEST(AnswerSentence, NamesAFewLostSpans) {
  MethodRecord method;
  method.causal.push_back({0, Pose()});
  std::vector<StateSpan> spans;
  for (int i = 0; i < 5; ++i) {
    spans.push_back({2.0 * i, 2.0 * i + 1.0, "LOST"});
    spans.push_back({2.0 * i + 1.0, 2.0 * i + 2.0, "followed"});
  }
  const std::string text = answer_sentence(method, spans);
  EXPECT_NE(text.find("from 0 s to 1 s, from 2 s to 3 s, from 4 s to 5 s and 2 times more."), std::string::npos)
      << text;
}

TEST(AnswerSentence, OfWhatCrashedOrGaveNothing) {
  MethodRecord method;
  EXPECT_EQ(answer_sentence(method, {}), "The method gave no pose.");
  EXPECT_EQ(final_state(method, {}), "no pose");
  method.crashed = true;
  method.error = "out of memory";
  EXPECT_EQ(answer_sentence(method, {}), "The method stopped with an error: out of memory");
  EXPECT_EQ(final_state(method, {}), "crashed");
}

}  // namespace
}  // namespace plumbline::scenarios
