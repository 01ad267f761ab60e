// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/comparison_text.h"

#include <gtest/gtest.h>

#include "tests/scenarios/compare/sample_rows.h"

namespace plumbline::scenarios {
namespace {

using Rows = std::vector<SweepRow>;

Comparison compared(const Rows& a, const Rows& b) { return compare_rows(pair_rows(a, b), {"ate_aligned_rmse_m"}); }

std::string text_of(const Comparison& comparison) { return comparison_text(comparison, {"before", "after"}); }

TEST(ComparisonText, IsATableAndAVerdict) {
  EXPECT_EQ(
      text_of(compared(slam_rows({1, 2, 3, 4, 5, 6, 7, 8}), slam_rows({2, 4, 6, 8, 10, 12, 14, 16}))),
      "A: before\n"
      "B: after\n"
      "\n"
      "                        A    B  B/A, B-A            95 %  better  equal  worse      p   Holm  B is\n"
      "vgicp, 8 pairs\n"
      "  right               8/8  8/8                                 0      8      0                equal in all "
      "pairs\n"
      "  ate_aligned_rmse_m  4.5    9     2.000  [2.000, 2.000]       0      0      8  0.008  0.008  worse\n"
      "\n"
      "sensor data: the same in A and B\n"
      "verdict: worse in vgicp ate_aligned_rmse_m (1 test at 5 % in all)\n");
}

TEST(ComparisonText, OfOnePairHasNoStatistics) {
  EXPECT_EQ(text_of(compared(slam_rows({1}), slam_rows({3}))),
            "A: before\n"
            "B: after\n"
            "\n"
            "                        A    B  B/A, B-A  B is\n"
            "vgicp, 1 pair\n"
            "  right               1/1  1/1            equal\n"
            "  ate_aligned_rmse_m    1    3     3.000  differs\n"
            "\n"
            "sensor data: the same in A and B\n"
            "verdict: differs; a single pair shows no more\n");
}

TEST(ComparisonText, OfTheSameIsShort) {
  const Rows rows = slam_rows({1, 2});
  EXPECT_EQ(text_of(compared(rows, rows)),
            "A: before\nB: after\n\nvgicp, 2 pairs: same, byte for byte\n\nsensor data: the same in A and B\n"
            "verdict: same, byte for byte\n");
}

TEST(ComparisonText, SaysWhatPairsCouldHaveShown) {
  const std::string text =
      text_of(compared(slam_rows({1, 1, 1, 1, 1, 1, 1, 1}), slam_rows({1.1, 0.9, 1.1, 0.9, 1.1, 0.9, 1.1, 0.9})));
  EXPECT_NE(text.find("no difference shown, detectable: 11 %\n"), std::string::npos) << text;
  EXPECT_NE(text.find("verdict: no difference shown (1 test at 5 % in all)\n"), std::string::npos) << text;
  const std::string wide = text_of(compared(slam_rows({1, 1, 1, 1, 1, 1}), slam_rows({9, .1, 8, .1, 9, .1})));
  EXPECT_NE(wide.find("no difference shown, detectable: 9.5 times\n"), std::string::npos) << wide;
  Rows unknown = slam_rows({1});
  unknown.front().method_digest.clear();
  const std::string equal = text_of(compared(unknown, unknown));
  EXPECT_TRUE(
      equal.ends_with("verdict: no difference shown (all scores are equal; no digest tells whether all else is)\n"))
      << equal;
  const std::string few = text_of(compared(slam_rows({1, 1}), slam_rows({1, 2})));
  EXPECT_NE(few.find("no difference shown, 1 differs\n"), std::string::npos) << few;
  EXPECT_NE(few.find("(no test: no value differs in 6 pairs or more)\n"), std::string::npos) << few;
}

TEST(ComparisonText, NamesRunsAndKeepsTerminalsSafe) {
  Rows a = slam_rows({1, 2, 3, 4, 5, 6, 7, 8, 9}), b = slam_rows({1});
  b.front().verdict = "crashed";
  b.push_back(slam_row(1, 1.0, "of\x1b[31mfice"));
  const std::string text = text_of(compared(a, b));
  EXPECT_NE(text.find("only in A: 8: house, seed 2, vgicp; "), std::string::npos) << text;
  EXPECT_NE(text.find("; and 2 more\n"), std::string::npos) << text;
  EXPECT_NE(text.find("only in B: 1: of\\u001b[31mfice, seed 1, vgicp\n"), std::string::npos) << text;
  EXPECT_NE(text.find("failures only in B: 1: house, seed 1, vgicp: complete -> crashed\n"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("; failures only in B: 1\n")) << text;
}

TEST(ComparisonResults, AreTheSameNumbers) {
  const Rows a = slam_rows({1, 2, 3, 4, 5, 6, 7, 8}), b = slam_rows({2, 4, 6, 8, 10, 12, 14, 16});
  const Tree tree = read_json(write_json(comparison_results(compared(a, b), {"x", "y"})), "json");
  EXPECT_EQ(tree.find("a")->as_string(), "x");
  EXPECT_EQ(tree.find("verdict")->as_string(), "worse");
  const Tree& values = *tree.find("methods")->find("vgicp")->find("values");
  const Tree& ate = values.as_list()[1];
  EXPECT_EQ(ate.find("name")->as_string(), "ate_aligned_rmse_m");
  EXPECT_EQ(ate.find("p")->as_double(), 2.0 / 256.0);
  EXPECT_NEAR(ate.find("ratio")->as_double(), 2.0, 1e-12);
  EXPECT_EQ(ate.find("worse")->as_int(), 8);
  EXPECT_EQ(ate.find("verdict")->as_string(), "worse");
}

TEST(ComparisonResults, WriteInfinityAsAWord) {
  Rows b = slam_rows({1});
  b.front().values.assign(b.front().values.size(), std::nullopt);
  b.front().verdict = "crashed";
  const std::string text = write_json(comparison_results(compared(slam_rows({1}), b), {"x", "y"}));
  EXPECT_NE(text.find("\"ratio\": \"inf\""), std::string::npos) << text;
}

}  // namespace
}  // namespace plumbline::scenarios
