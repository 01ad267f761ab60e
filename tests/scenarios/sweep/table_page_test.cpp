// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/table_page.h"

#include <gtest/gtest.h>

#include "scenarios/metrics/metrics.h"
#include "tests/occurrences.h"

namespace plumbline::scenarios {
namespace {

SweepRow row(const std::string& seed, const std::string& verdict, double error_m) {
  Tree where = Tree::map();
  where.set("identifiable", true).set("ape_rmse_m", error_m).set("converged_at_m", 2.0);
  const Tree methods = Tree(Tree::Map{{"finder", Tree::map().set("verdict", verdict).set("localization", where)}});
  SweepRow one = rows_of(Tree::map().set("scenario", "a<b").set("seed", seed).set("methods", methods), "x").front();
  one.key = "a_b-" + seed;
  return one;
}

TEST(SweepPage, PutsTheWorstRunFirst) {
  const std::vector<SweepRow> rows = {row("1", "success", 0.01),          row("2", "late", 0.02),
                                      row("3", "overconfident", 5.0),     row("4", "false_convergence", 0.9),
                                      row("5", "false_convergence", 7.5), row("6", "success", 0.03)};
  std::string order;
  for (const SweepRow* one : worst_first(rows)) order += one->seed;
  EXPECT_EQ(order, "543261");
  const std::string page = table_html({"n", "my sweep.yaml", {}, 3}, rows, cells_of(rows));
  EXPECT_NE(page.find("a&lt;b, seed 5: <b>finder</b>"), std::string::npos);
  EXPECT_NE(page.find("<code class=\"command\">plumbline sweep 'my sweep.yaml' --seeds 3 --page a_b-5</code>"),
            std::string::npos)
      << page.substr(page.find("The worst run"), 600);
  EXPECT_EQ(page.find("a<b"), std::string::npos);
}

TEST(SweepPage, ShowsColumnsThatSaySomething) {
  const std::vector<SweepRow> rows = {row("1", "success", 0.01)};
  const std::string page = table_html({"n", "s.yaml", {}, 0}, rows, cells_of(rows));
  for (const char* head : {"success", "converged at m", "verdicts"})
    EXPECT_EQ(occurrences(page, "<th>" + std::string(head) + "</th>"), 1U) << head;
  for (const char* head : {"variant", "start", "honest", "identifiable at s"})
    EXPECT_EQ(occurrences(page, "<th>" + std::string(head) + "</th>"), 0U) << head;
}

TEST(SweepPage, LinksARunWhosePageIsThere) {
  const std::vector<SweepRow> rows = {row("1", "success", 0.01), row("2", "late", 0.02)};
  const std::string page = table_html({"n", "s.yaml", {"a_b-2"}, 0}, rows, cells_of(rows));
  EXPECT_GE(occurrences(page, "<a href=\"pages/a_b-2/report.html\">"), 1U);
  EXPECT_EQ(occurrences(page, "pages/a_b-1/"), 0U);
  EXPECT_EQ(occurrences(page, "data-copy=\"plumbline sweep s.yaml --page a_b-1\""), 1U);
}

TEST(SweepPage, ShowsTheSpreadAsDotsOrAsAHistogram) {
  std::vector<SweepRow> rows;
  for (int i = 0; i < 50; ++i) rows.push_back(row(std::to_string(i), i < 3 ? "late" : "success", 0.01 + 0.001 * i));
  const std::string few = table_html({"n", "s.yaml", {}, 0}, rows, cells_of(rows));
  EXPECT_EQ(occurrences(few, "<circle "), 50U);
  EXPECT_EQ(occurrences(few, "fill=\"var(--wrong)\""), 3U);
  EXPECT_NE(few.find("<title>seed 4: success, 1.4 cm</title>"), std::string::npos);
  for (int i = 50; i < 1500; ++i) rows.push_back(row(std::to_string(i), "success", 0.02));
  const std::string many = table_html({"n", "s.yaml", {}, 0}, rows, cells_of(rows));
  EXPECT_EQ(occurrences(many, "<circle "), 0U);
  EXPECT_NE(many.find("runs</title></rect>"), std::string::npos);
  EXPECT_NE(many.find("The worst 1000 of 1500"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
