// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/score_file.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::scenarios {
namespace {

const std::string scored_gate = R"({"metric": "a", "method": "m", "op": "<=", "limit": 1, "value": 2.5, "passed": false,
  "reason": "why", "see": "javascript:0"
})";

TEST(ScoreFile, IsReadWithItsGates) {
  const EstimateScores scores = read_estimate_scores(
      R"({"plumbline": "1", "method": "m", "scans": 3, "unchecked": ["a"], "causal": {"poses": 3}, "gates": [)" +
          scored_gate + "]}",
      "score.json");
  EXPECT_EQ(write_json(scores.numbers, 0), R"({"scans":3,"unchecked":["a"],"causal":{"poses":3}})");
  ASSERT_EQ(scores.gates.size(), 1U);
  EXPECT_EQ(scores.gates[0].value, 2.5);
  EXPECT_EQ(scores.gates[0].but, "why");
  EXPECT_FALSE(scores.gates[0].passed);
  EXPECT_EQ(scores.gates[0].see, "") << "an estimate has no page to link to";
}

TEST(ScoreFile, RefusesWhatNoPageCanShow) {
  const auto refused = [](const std::string& text) {
    EXPECT_THROW((void)read_estimate_scores(text, "score.json"), InputError) << text;
  };
  refused("[]");
  refused(R"({"gates": [1]})");
  refused(R"({"gates": {}})");
  refused(R"({"gates": [{"metric": "a"}]})");
  refused(R"({"gates": [{"metric": 3, "method": "m", "op": "<=", "limit": 1, "passed": true}]})");
  refused(R"({"gates": [{"metric": "a", "method": "m", "op": "<", "limit": 1, "passed": true}]})");
  refused(R"({"causal": {"ate_aligned_rmse_m": 1e300}})");
  refused(R"({"causal": [{"poses": 1e300}]})");
  refused(R"({"causal": 3})");
  refused(R"({"verdict": 3})");
  refused(R"({"a": {"b": {"c": {"d": {"e": {"f": 1}}}}}})");
  refused("{\"a\": \"" + std::string(3000, 'x') + "\"}");
  std::string many = "{\"causal\": {\"k\": 0";
  for (int i = 0; i < 600; ++i) many += ", \"k" + std::to_string(i) + "\": 0";
  refused(many + "}}");
}

}  // namespace
}  // namespace plumbline::scenarios
