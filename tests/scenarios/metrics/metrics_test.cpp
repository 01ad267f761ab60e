// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/metrics.h"

#include <gtest/gtest.h>

#include <set>

#include "scenarios/metrics/metric_kind.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios::score {
namespace {

MethodScore good_slam() {
  MethodScore score;
  score.name = "vgicp";
  score.verdict = "complete";
  score.trajectory = TrajectoryScore();
  score.trajectory->coverage = 1.0;
  score.trajectory->ate_rmse_m = 0.3;
  score.trajectory->ate_aligned_rmse_m = 0.1;
  score.trajectory->rpe_1m_rmse_m = 0.02;
  return score;
}

TEST(Metrics, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const MetricRow& row : metrics()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
  EXPECT_EQ(find_metric("ate_aligned_rmse_m")->unit, "m");
  EXPECT_EQ(find_metric("nonsense"), nullptr);
}

TEST(Metrics, AbsentNotZero) {
  const Tree tree = to_results(good_slam());
  EXPECT_EQ(tree.find("ate_aligned_rmse_m")->as_double(), 0.1);
  EXPECT_EQ(tree.find("ate_final_rmse_m"), nullptr);
  EXPECT_EQ(tree.find("localization"), nullptr);
  EXPECT_EQ(tree.find("rooms"), nullptr);
  MethodScore with_rooms = good_slam();
  with_rooms.rooms = RoomScore{};
  EXPECT_EQ(to_results(with_rooms).find("rooms")->find("found")->as_double(), 0.0);
  EXPECT_EQ(to_results(with_rooms).find("rooms")->find("precision"), nullptr);
}

TEST(Metrics, AreOfOneKindOfMethodOrOfBoth) {
  for (const MetricRow& row : metrics()) {
    const bool of_both = row.name.starts_with("map_") || row.name.starts_with("walls.");
    EXPECT_EQ(is_metric_of(row.name, true) && is_metric_of(row.name, false), of_both) << row.name;
    EXPECT_TRUE(is_metric_of(row.name, true) || is_metric_of(row.name, false)) << row.name;
  }
  EXPECT_FALSE(is_metric_of("coverage", true));
  EXPECT_FALSE(is_metric_of("localization.nees", false));
}

TEST(Gates, PassOnlyOnAPresentMetricOfAWholeRun) {
  const GateSpec below{"ate_aligned_rmse_m", "vgicp", 0.25, std::nullopt};
  const GateSpec above{"ate_aligned_rmse_m", "vgicp", std::nullopt, 0.2};
  const GateSpec absent{"rooms.recall", "vgicp", std::nullopt, 0.0};
  const GateSpec nobody{"ate_rmse_m", "other", 9.0, std::nullopt};
  const auto results = judge_gates({below, above, absent, nobody}, {good_slam()}, true);
  ASSERT_EQ(results.size(), 4U);
  EXPECT_TRUE(results[0].passed);
  EXPECT_FALSE(results[1].passed);
  EXPECT_FALSE(results[2].passed);
  EXPECT_FALSE(results[2].value);
  EXPECT_FALSE(results[3].passed);
  EXPECT_FALSE(judge_gates({below}, {good_slam()}, false)[0].passed);
  for (const char* verdict : {"crashed", "lost"}) {
    MethodScore score = good_slam();
    score.verdict = verdict;
    const GateResult result = judge_gates({below}, {score}, true)[0];
    EXPECT_FALSE(result.passed);
    EXPECT_NE(describe(result).find(std::string(", but the method ")), std::string::npos) << describe(result);
  }
  EXPECT_EQ(describe(judge_gates({below}, {good_slam()}, false)[0]),
            "ate_aligned_rmse_m of vgicp is 0.1, must be <= 0.25, but the run ended early");
  EXPECT_EQ(describe(results[0]), "ate_aligned_rmse_m of vgicp is 0.1, must be <= 0.25");
  EXPECT_EQ(describe(results[2]), "rooms.recall of vgicp is absent, must be >= 0: vgicp has no such metric");
  EXPECT_EQ(to_results(results[2]).find("reason")->as_string(), "vgicp has no such metric");
  MethodScore never = good_slam();
  never.localization.emplace();
  const GateSpec error{"localization.ape_rmse_m", "vgicp", 0.1, std::nullopt};
  EXPECT_EQ(describe(judge_gates({error}, {never}, true)[0]),
            "localization.ape_rmse_m of vgicp is absent, must be <= 0.1: it never converged on one pose");
  never.localization->converged_at_s = 2.0;
  EXPECT_EQ(describe(judge_gates({error}, {never}, true)[0]),
            "localization.ape_rmse_m of vgicp is absent, must be <= 0.1");
}

TEST(Gates, SayTrulyWhyAMetricIsAbsent) {
  const auto why = [](const std::string& metric, const MethodScore& score) {
    return judge_gates({{metric, "vgicp", std::nullopt, 0.0}}, {score}, true).front().but;
  };
  MethodScore brief = good_slam();
  brief.trajectory->rpe_1m_rmse_m.reset();
  EXPECT_EQ(why("rpe_1m_rmse_m", brief), "no 1 m of the walk has a pose at both ends");
  for (const char* metric : {"drift_10m_percent", "drift_10m_deg_per_m"})
    EXPECT_EQ(why(metric, brief), "no 10 m of the walk have a pose at both ends");
  EXPECT_EQ(why("ate_final_rmse_m", brief), "fewer than 95 % of the scans have a final pose");
  brief.rooms.emplace();
  EXPECT_EQ(why("rooms.precision", brief), "it found none");
  EXPECT_EQ(why("rooms.recall", brief), "the walk has none that it could find");
  EXPECT_EQ(why("walls.recall", brief), "vgicp has no such metric");
  MethodScore localizer;
  localizer.name = "vgicp";
  localizer.verdict = "undecided";
  localizer.localization.emplace();
  for (const char* metric : {"rooms.recall", "walls.precision", "map_rmse_m"})
    EXPECT_EQ(why(metric, localizer), "it never converged on one pose");
  EXPECT_EQ(why("ate_final_rmse_m", localizer), "vgicp has no such metric");
  localizer.localization->converged_at_s = 2.0;
  EXPECT_EQ(why("rooms.recall", localizer), "vgicp has no such metric");
}

TEST(Gates, GiveFourDigitsAndMoreWhereTheLimitNeedsThem) {
  EXPECT_EQ(gate_value(0.028344707293047434, 0.001), "0.02834");
  EXPECT_EQ(gate_value(0.25000412, 0.25), "0.250004");
  EXPECT_EQ(gate_value(0.25, 0.25), "0.25");
  EXPECT_EQ(gate_value(3e-12, 1e-9), "3e-12");
}

TEST(Junit, CountsFailuresAndEscapes) {
  const GateSpec failing{"ate_aligned_rmse_m", "vgicp", 0.05, std::nullopt};
  MethodScore crashed;
  crashed.name = "s_graphs_plus";
  crashed.verdict = "crashed";
  crashed.error = "a < b & \"c\"";
  const std::vector<MethodScore> scores = {good_slam(), crashed};
  const std::string xml = write_junit("quick", judge_gates({failing}, scores, true), scores, "");
  EXPECT_NE(xml.find("tests=\"4\" failures=\"2\""), std::string::npos) << xml;
  const std::string fallen = write_junit("quick", {}, {good_slam()}, "fell at 3 s");
  EXPECT_NE(fallen.find("tests=\"2\" failures=\"1\""), std::string::npos) << fallen;
  EXPECT_NE(fallen.find("fell at 3 s"), std::string::npos) << fallen;
  EXPECT_NE(xml.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos) << xml;
}

}  // namespace
}  // namespace plumbline::scenarios::score
