// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/compared_folder.h"

#include <gtest/gtest.h>

#include "tests/input_error.h"
#include "tests/scenarios/compare/sample_rows.h"

namespace plumbline::scenarios {
namespace {

TEST(RunsCsv, ReadsWhatASweepWrites) {
  std::vector<SweepRow> rows = slam_rows({0.1, 1e-17, 123456.789});
  rows[0].variant = "a, \"b\"\nc";
  rows[1].failure = "fell, as \"it\" does";
  rows.push_back(localization_row(4, "success", 2.5));
  const std::vector<SweepRow> again = read_runs_csv(runs_csv(rows), "runs.csv");
  ASSERT_EQ(again.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(again[i].variant, rows[i].variant);
    EXPECT_EQ(again[i].seed, rows[i].seed);
    EXPECT_EQ(again[i].method, rows[i].method);
    EXPECT_EQ(again[i].verdict, rows[i].verdict);
    EXPECT_EQ(again[i].digest, rows[i].digest);
    EXPECT_EQ(again[i].sensor_digest, rows[i].sensor_digest);
    EXPECT_EQ(again[i].method_digest, rows[i].method_digest);
    EXPECT_EQ(again[i].failure, rows[i].failure);
    EXPECT_EQ(again[i].identifiable, rows[i].identifiable);
    EXPECT_EQ(again[i].values, rows[i].values);
  }
}

TEST(RunsCsv, TakesThoseOfOtherVersions) {
  const std::string text =
      "seed,scenario,variant,start,method,verdict,digest,some_new_metric,map_rmse_m\n7,house,,,vgicp,complete,ab,3,0."
      "5\n";
  std::vector<SweepRow> rows = read_runs_csv(text, "runs.csv");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows.front().seed, "7");
  EXPECT_EQ(value_in(rows.front(), "map_rmse_m"), 0.5);
  EXPECT_FALSE(value_in(rows.front(), "ate_rmse_m"));
  EXPECT_TRUE(rows.front().sensor_digest.empty());
}

TEST(RunsCsv, SaysWhereItIsDamaged) {
  const std::string head = "scenario,variant,start,seed,method,verdict,digest,map_rmse_m\n";
  const auto error_of = [&](const std::string& text) {
    return input_error([&] { (void)read_runs_csv(text, "runs.csv"); });
  };
  EXPECT_EQ(error_of(head), "no error");
  EXPECT_EQ(error_of(""), "runs.csv:1:1: has no column 'scenario'; runs.csv of a sweep has");
  EXPECT_EQ(error_of("scenario,seed\n"), "runs.csv:1:1: has no column 'variant'; runs.csv of a sweep has");
  EXPECT_EQ(error_of(head + "a,,,1,m,complete,d\n"), "runs.csv:2:1: has 7 cells; the head has 8");
  EXPECT_EQ(error_of(head + "\"a\nb\",,,1,m,complete,d,1\na,,,1,m,complete,d,1x\n"),
            "runs.csv:4:1: '1x' must be a number");
  EXPECT_EQ(error_of(head + "a,,,1,m,comp"), "runs.csv:2:1: the file ends in the middle of a line");
}

}  // namespace
}  // namespace plumbline::scenarios
