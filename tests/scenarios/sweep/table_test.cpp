// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::scenarios {
namespace {

TEST(Wilson, KnownIntervals) {
  // [wilson1927] for 6, 5 and 10 of 10, rounded to percent
  EXPECT_NEAR(wilson95(6, 10).first, 0.31, 0.005);
  EXPECT_NEAR(wilson95(6, 10).second, 0.83, 0.005);
  EXPECT_NEAR(wilson95(5, 10).first, 0.24, 0.005);
  EXPECT_NEAR(wilson95(10, 10).first, 0.72, 0.005);
  EXPECT_NEAR(wilson95(10, 10).second, 1.0, 1e-12);
  EXPECT_EQ(wilson95(0, 0), (std::pair<double, double>(0.0, 1.0)));
}

TEST(Wilson, HoldsTheShareAndNarrowsWithMore) {
  for (int n = 1; n <= 200; ++n)
    for (int k = 0; k <= n; ++k) {
      const auto [low, high] = wilson95(k, n);
      const double p = static_cast<double>(k) / n;
      EXPECT_LE(low, p + 1e-12);
      EXPECT_GE(high, p - 1e-12);
      // Its ends are where a share is 1.96 standard deviations from what was seen.
      for (const double end : {low, high})
        if (end > 1e-9 && end < 1.0 - 1e-9) {
          EXPECT_NEAR((p - end) * (p - end), 1.959963984540054 * 1.959963984540054 * end * (1.0 - end) / n, 1e-12);
        }
    }
}

Tree result(const std::string& seed, const std::string& verdict, bool identifiable, double converged_at_m) {
  Tree where = Tree::map();
  where.set("identifiable", identifiable);
  if (identifiable) where.set("identifiable_at_s", 4.0).set("identifiable_at_m", 2.0);
  if (converged_at_m > 0.0) where.set("converged_at_m", converged_at_m).set("ape_rmse_m", 0.1);
  Tree methods = Tree::map();
  methods.set("finder", Tree::map().set("verdict", verdict).set("localization", where));
  methods.set("mapper", Tree::map().set("verdict", "complete").set("ate_aligned_rmse_m", 0.02));
  return Tree::map().set("scenario", "a").set("seed", seed).set("digest", "0").set("methods", methods);
}

std::vector<SweepRow> rows() {
  std::vector<SweepRow> all;
  for (const Tree& tree : {result("1", "success", true, 3.0), result("2", "success", true, 5.0),
                           result("3", "late", true, 0.0), result("4", "false_convergence", true, 4.0),
                           result("5", "honest_ambiguity", false, 0.0), result("6", "lucky", false, 1.0)})
    for (const SweepRow& row : rows_of(tree, "x")) all.push_back(row);
  return all;
}

TEST(SweepTable, CountsWeakEvidenceApart) {
  std::vector<SweepRow> marginal = rows();
  std::erase_if(marginal, [](const SweepRow& row) { return row.method != "finder"; });
  for (SweepRow& row : marginal) row.evidence = "weak";
  const SweepCell cell = cells_of(marginal).front();
  EXPECT_EQ(cell.judged + cell.ambiguous, 0);
  EXPECT_EQ(cell.marginal, 6);
  EXPECT_EQ(cell.marginal_right, 3);
  EXPECT_EQ(cell.false_convergences, 1);
}

TEST(SweepTable, CountsSuccessOverWhatCanBeTold) {
  const std::vector<SweepCell> cells = cells_of(rows());
  ASSERT_EQ(cells.size(), 2U);
  const SweepCell& finder = cells[0];
  EXPECT_EQ(finder.runs, 6);
  EXPECT_EQ(finder.judged, 4);
  EXPECT_EQ(finder.succeeded, 2);
  EXPECT_EQ(finder.ambiguous, 2);
  EXPECT_EQ(finder.honest, 1);
  EXPECT_EQ(finder.false_convergences, 1);
  EXPECT_FALSE(finder.median_converged_at_m);  // 3, 5, one that never did and one in a wrong place
  EXPECT_EQ(finder.median_identifiable_at_s, 4.0);
  EXPECT_EQ(cells[1].method, "mapper");
  EXPECT_EQ(cells[1].succeeded, 6);
  EXPECT_EQ(cells[1].median_error_m, 0.02);
}

TEST(SweepTable, NearlyAllIsNotAll) {
  SweepCell cell;
  cell.scenario = "a";
  cell.method = "finder";
  cell.runs = cell.judged = 300;
  const auto text_with = [&](int succeeded) {
    cell.succeeded = succeeded;
    return table_text({cell});
  };
  EXPECT_NE(text_with(300).find("100 % ["), std::string::npos);
  EXPECT_NE(text_with(299).find(" 99 % ["), std::string::npos) << text_with(299);
  EXPECT_NE(text_with(1).find("0.3 % ["), std::string::npos) << text_with(1);
  EXPECT_NE(text_with(0).find(" 0 % ["), std::string::npos);
}

TEST(SweepTable, AMedianOfMostlyNeverIsNever) {
  std::vector<SweepRow> all;
  for (const Tree& tree :
       {result("1", "success", true, 3.0), result("2", "late", true, 0.0), result("3", "late", true, 0.0)})
    for (const SweepRow& row : rows_of(tree, "x")) all.push_back(row);
  EXPECT_FALSE(cells_of(all)[0].median_converged_at_m.has_value());
  EXPECT_NE(table_text(cells_of(all)).find("never"), std::string::npos);
}

TEST(SweepTable, ARunWithoutAnAnswerHasAnInfiniteError) {
  std::vector<SweepRow> all;
  for (const Tree& tree :
       {result("1", "success", true, 3.0), result("2", "late", true, 0.0), result("3", "late", true, 0.0)})
    for (const SweepRow& row : rows_of(tree, "x")) all.push_back(row);
  EXPECT_FALSE(cells_of(all)[0].median_error_m.has_value());
  all.erase(all.begin() + 4, all.end());
  all.push_back(all[0]);
  EXPECT_EQ(cells_of(all)[0].median_error_m, 0.1) << "two of three have 0.1 m";
}

// A method that crashed at a walk where several poses fit has not failed to tell them apart.
TEST(SweepTable, ACrashCountsWhereTheOthersOfItsWalkDo) {
  const Tree ambiguous = result("5", "honest_ambiguity", false, 0.0), unique = result("1", "success", true, 3.0);
  std::vector<SweepRow> all;
  for (const Tree& tree : {unique, ambiguous})
    for (SweepRow& row : rows_of(tree, "x")) {
      if (row.method != "finder") continue;
      all.push_back(row);
      row.method = "other";
      if (row.seed == "5") {
        row.verdict = "crashed";
        row.identifiable.reset();
      }
      all.push_back(row);
    }
  const std::vector<SweepCell> cells = cells_of(all);
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_EQ(cells[1].judged, 1);
  EXPECT_EQ(cells[1].ambiguous, 1);
  EXPECT_EQ(cells[1].honest, 0);
}

TEST(SweepTable, FoundAtIsTheMedianWithWrongAnswersAsNever) {
  std::vector<SweepRow> all;
  for (const Tree& tree : {result("1", "success", true, 3.0), result("2", "success", true, 5.0),
                           result("3", "false_convergence", true, 0.5)})
    for (const SweepRow& row : rows_of(tree, "x")) all.push_back(row);
  EXPECT_EQ(cells_of(all)[0].median_converged_at_m, 5.0);
}

TEST(SweepTable, CsvQuotesWhatNeedsIt) {
  std::vector<SweepRow> all = rows();
  all[0].start = "{at: [1, 2], storey: \"x\"}";
  EXPECT_NE(runs_csv(all).find("a,,\"{at: [1, 2], storey: \"\"x\"\"}\",1,finder,success"), std::string::npos);
}

/// A spreadsheet would compute what begins so; numbers and the dash of an empty cell are none of it.
TEST(SweepTable, CsvHoldsNoFormula) {
  for (const char* name : {"=1+2", "+a", "-a", "@SUM(A1)", "\tx", "=cmd|' /C calc'!A0"}) {
    std::vector<SweepRow> all = rows();
    for (SweepRow& row : all) row.variant = name;
    for (const std::string& csv : {runs_csv(all), table_csv(cells_of(all))}) {
      EXPECT_EQ(csv.find("," + std::string(name)), std::string::npos) << csv;
      EXPECT_NE(csv.find(",'" + std::string(name) + ","), std::string::npos) << csv;
    }
  }
  std::vector<SweepRow> all = rows();
  all[0].values.assign(all[0].values.size(), -0.5);
  EXPECT_NE(runs_csv(all).find(",-0.5,"), std::string::npos);
  EXPECT_EQ(runs_csv(all).find('\''), std::string::npos);
  EXPECT_NE(table_csv(cells_of(all)).find(",-,-,mapper,"), std::string::npos);
}

/// table.txt is read in a terminal.
TEST(SweepTable, TextHoldsNoControlCharacter) {
  std::vector<SweepRow> all = rows();
  for (SweepRow& row : all) row.variant = "a\x1b[31m\nb";
  const std::string text = table_text(cells_of(all));
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_NE(text.find("a\\u001b[31m\\u000ab"), std::string::npos);
}

TEST(SweepTable, SaysWhyARunFailed) {
  const Tree depleted = Tree::map().set("identifiable", true).set("failure", "depleted");
  const Tree methods = Tree::map().set("finder", Tree::map().set("verdict", "late").set("localization", depleted));
  const Tree lost = Tree::map().set("scenario", "a").set("seed", "1").set("methods", methods);
  EXPECT_EQ(rows_of(lost, "x").at(0).failure, "depleted");
  const Tree failed = Tree::map().set("finder", Tree::map().set("verdict", "failed"));
  const Tree fallen = Tree::map().set("scenario", "a").set("seed", "2").set("failure", "fell").set("methods", failed);
  EXPECT_EQ(rows_of(fallen, "x").at(0).failure, "fell");
  EXPECT_NE(runs_csv({rows_of(lost, "x").at(0)}).find(",late,,true,,depleted,"), std::string::npos);
}

TEST(SweepTable, NamesWalksThatFailedOrHaveWarnings) {
  const auto walk = [](const std::string& variant, const std::string& seed, const std::string& failure,
                       const std::vector<std::string>& warnings) {
    Tree result = Tree::map().set("scenario", "a").set("variant", variant).set("seed", seed);
    if (!failure.empty()) result.set("failure", failure);
    Tree list = Tree::list();
    for (const std::string& warning : warnings) list.push(warning);
    const Tree of_method = Tree::map().set("verdict", failure.empty() ? "complete" : "failed");
    result.set("warnings", list).set("methods", Tree::map().set("first", of_method).set("second", of_method));
    std::vector<SweepRow> rows = rows_of(result, "x");
    for (SweepRow& row : rows) row.key = "a-" + variant + "-" + seed;
    return rows;
  };
  std::vector<SweepRow> all;
  for (const auto& rows : {walk("v", "1", "", {"time was up", "no walls"}), walk("v", "2", "", {"time was up at 3 s"}),
                           walk("v", "3", "fell", {}), walk("w", "1", "refused: too narrow", {}),
                           walk("w", "2", "refused: too wide", {}), walk("x", "1", "", {})})
    all.insert(all.end(), rows.begin(), rows.end());
  EXPECT_EQ(walk_notes(all), (std::vector<std::string>{"a, v: 1 of 3 walks failed: fell",
                                                       "a, v: 2 of 3 walks with a warning, the first: time was up",
                                                       "a, w: 2 of 2 walks failed, the first: refused: too narrow"}));
  EXPECT_EQ(refused_in(all), "2 of 6 runs cannot be made; a-w-1: too narrow");
  EXPECT_EQ(refused_in(walk("v", "3", "fell", {})), "");
}

// Behind a harmless warning, too.
TEST(SweepTable, WalksThatWereCutShortHaveANoteOfTheirOwn) {
  SweepRow row;
  row.scenario = "a";
  row.seed = "1";
  row.verdict = "complete";
  row.warnings = {"the walk is only 9 m long", "the walk ended when its time was up (3 s)"};
  SweepRow other = row;
  other.seed = "2";
  other.warnings.pop_back();
  EXPECT_EQ(walk_notes({row, other}),
            (std::vector<std::string>{"a: 1 of 2 walks cut short: the walk ended when its time was up (3 s)",
                                      "a: 2 of 2 walks with a warning, the first: the walk is only 9 m long"}));
}

TEST(SweepTable, AResultWithoutMethodsIsRefused) {
  EXPECT_THROW((void)rows_of(Tree::map().set("scenario", "a"), "x.json"), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios
