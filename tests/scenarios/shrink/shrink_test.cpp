// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/shrink.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/shrink/shrink_search.h"
#include "scenarios/shrink/shrink_text.h"
#include "tests/data.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

Tree verdict(const std::string& text) {
  return read_json(R"({"gates": [], "duration_s": 6, "methods": {"vgicp": {"verdict": ")" + text + R"("}}})", "r.json");
}

RunCase walk() {
  return {read_yaml("scenario: 1\nbuilding: a.plan.yaml\nroute: {rooms: [a, b]}\nduration_s: 6\n"
                    "methods: [truth, vgicp]\nlidar: {preset: ideal}\nodometry: {preset: ideal}\n"
                    "prior: {yaw: known, storey: known}\npeople: [{rooms: [a]}, {rooms: [b]}]\n"
                    "faults: {slip_mps: 0.3}\n",
                    "a.yaml"),
          "a.plan.yaml", std::make_shared<const std::string>("plan: 1\n")};
}

/// Runs that are lost where the scenario's text says so.
TryCases lost_where(std::function<bool(const std::string&)> lost) {
  return [lost](const std::vector<RunCase>& cases, const auto&) {
    std::vector<Trial> trials;
    for (const RunCase& run : cases) {
      trials.emplace_back();
      trials.back().results = verdict(lost(write_yaml(run.scenario)) ? "lost" : "complete");
    }
    return trials;
  };
}

Shrunk shrunk(const ShrinkOptions& options) {
  const Tree results = verdict("lost");
  return shrink(walk(), results, failures_in(results).front(), options);
}

bool slips(const std::string& text) { return text.find("slip_mps: 0.3") != std::string::npos; }

using Names = std::vector<std::string>;
const Names all = {"people 1", "people 2", "faults.slip_mps: 0.3"};

TEST(Shrink, NeedsWhatWasLeftOutAloneAndFailedNoMore) {
  const Shrunk small = shrunk({"run", "", 200, 2, {"building"}, {}, lost_where(slips)});
  EXPECT_EQ(small.needed, Names{"faults.slip_mps: 0.3"});
  EXPECT_EQ(small.not_needed, (Names{"people 1", "people 2"}));
  EXPECT_TRUE(small.not_tried.empty());
  EXPECT_EQ(small.end, ShrinkEnd::smallest);
}

TEST(Shrink, WhatWasNotTriedIsNotSaidToBeNeeded) {
  const Shrunk kept = shrunk({"run", "", 200, 1, {"building", "ingredients"}, {}, lost_where(slips)});
  EXPECT_TRUE(kept.needed.empty());
  EXPECT_EQ(kept.not_tried, all);
  const Shrunk ended = shrunk({"run", "", 1, 1, {"building"}, {}, lost_where(slips)});
  EXPECT_EQ(ended.end, ShrinkEnd::max_runs);
  EXPECT_TRUE(ended.needed.empty());
  EXPECT_EQ(ended.not_tried, all);
  EXPECT_NE(shrink_text(ended).find("not tried alone: people 1, people 2"), std::string::npos);
  EXPECT_EQ(to_results(ended).find("not_tried")->as_list().size(), 3U);
}

TEST(Shrink, DoesNotDependOnJobs) {
  const auto small = [](int jobs) {
    return write_json(to_results(shrunk({"run", "", 9, jobs, {"building"}, {}, lost_where(slips)})));
  };
  EXPECT_EQ(small(1), small(3));
}

TEST(Shrink, OneRunThatShowsNoFailureIsRefused) {
  const auto error = [](int max_runs) {
    return input_error([&] {
      (void)shrunk({"run", "", max_runs, 1, {}, {}, lost_where([](const std::string&) { return false; })});
    });
  };
  EXPECT_NE(error(1).find("--max-runs 2"), std::string::npos) << error(1);
  EXPECT_NE(error(2).find("does not fail the same way when it is run again"), std::string::npos) << error(2);
}

TEST(ShrinkSearch, MakesNoMoreCandidatesThanItTries) {
  const Tree results = verdict("lost");
  ShrinkSearch search(walk(), results, failures_in(results).front(),
                      {"run", "", 3, 1, {}, {}, lost_where([](const std::string&) { return false; })});
  int made = 0;
  const auto with = [&](const RunCase& best, const Kept& kept) {
    ++made;
    RunCase run = best;
    run.scenario.set("seed", static_cast<int>(kept.size()) + made);
    return run;
  };
  EXPECT_FALSE(search.minimize_parts(std::vector<std::string>(1000, "part"), with));
  EXPECT_TRUE(search.is_exhausted());
  EXPECT_EQ(search.runs(), 3);
  EXPECT_LE(made, 4);
  EXPECT_FALSE(search.minimize_parts(std::vector<std::string>(1000, "part"), with));
  EXPECT_LE(made, 4);
}

}  // namespace
}  // namespace plumbline::scenarios
