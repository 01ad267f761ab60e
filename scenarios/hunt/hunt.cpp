// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <tuple>

#include "bim/errors.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/hunt/hunt_case.h"
#include "scenarios/hunt/methods_alone.h"
#include "scenarios/shrink/ingredients.h"
#include "scenarios/shrink/trial.h"

namespace plumbline::scenarios {

namespace {

/// Runs that are drawn from what is known by then: fewer would be slower with many jobs, more would learn later.
constexpr std::size_t generation_size = 8;
/// Of runs that fail in one way so many are refined, so that the search does not end with one failure.
constexpr int most_of_one_kind = 2;

/// Methods and verdicts of what went wrong, or of nothing.
std::string kind_of(const HuntRun& run) {
  std::string kind = std::to_string(run.base);
  for (const MethodOutcome& outcome : run.outcomes)
    if (outcome.failure && outcome.blame.of_method) kind += " " + outcome.method + " " + outcome.verdict;
  return kind;
}

/// The worst runs, of which each kind is there a few times at most.
std::vector<std::size_t> worst_of(const std::vector<HuntRun>& runs) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (!runs[i].outcomes.empty()) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return runs[a].badness > runs[b].badness; });
  std::map<std::string, int> taken;
  std::erase_if(order, [&](std::size_t i) { return ++taken[kind_of(runs[i])] > most_of_one_kind; });
  if (order.size() > generation_size) order.resize(generation_size);
  return order;
}

class HuntSearch {
 public:
  HuntSearch(const Hunt& hunt, const HuntOptions& options, slam::MethodTable table)
      : hunt_(hunt),
        options_(options),
        try_all_(options.try_all ? options.try_all : in_processes(options.work, options.jobs)),
        cases_(hunt, options.work, table),
        stream_(hunt.file.seed, "scenario.hunt") {}

  void explore(std::size_t count) {
    std::size_t dimensions = 0;
    for (const HuntBase& base : hunt_.bases) dimensions = std::max(dimensions, base.dimensions(hunt_.file));
    std::vector<Point> points = latin_hypercube(count, dimensions, stream_);
    // In slices: what is done stays when this is interrupted.
    const std::size_t slice = std::max(generation_size, static_cast<std::size_t>(std::max(options_.jobs, 1)));
    while (runs_.size() < count) {
      std::vector<HuntRun> runs;
      for (std::size_t i = runs_.size(); i < std::min(count, runs_.size() + slice); ++i) {
        HuntRun run{i % hunt_.bases.size(), std::move(points[i]), seed_of_run(i), std::nullopt};
        run.point.resize(hunt_.bases[run.base].dimensions(hunt_.file));
        note(run);
        runs.push_back(std::move(run));
      }
      make(std::move(runs));
    }
  }

  void refine(std::size_t count) {
    constexpr double widest = 0.25, narrowest = 0.03, same_noise = 0.5;
    for (std::size_t generation = 0; count > 0; ++generation) {
      const std::vector<std::size_t> parents = worst_of(runs_);
      if (parents.empty()) return;
      const double sigma = std::max(narrowest, widest / static_cast<double>(generation + 1));
      std::vector<HuntRun> runs;
      for (std::size_t i = 0; i < std::min(count, generation_size); ++i) {
        const std::size_t number = runs_.size() + i, parent = parents[i % parents.size()];
        const HuntRun& old = runs_[parent];
        const bool keeps_seed = stream_.uniform(number, seed_lane, 1) < same_noise;
        HuntRun run{old.base, near_point(old.point, sigma, stream_, number),
                    keeps_seed ? old.seed : seed_of_run(number), parent};
        if (!note(run)) {  // of few values the same may be drawn again
          run.seed = seed_of_run(number);
          note(run);
        }
        runs.push_back(std::move(run));
      }
      count -= runs.size();
      make(std::move(runs));
    }
  }

  [[nodiscard]] std::vector<HuntRun> take() { return std::move(runs_); }

  /// Makes the building of a run again, which was not kept.
  void restore(HuntRun& run) const {
    if (run.run->bytes) return;
    HuntRun again = run;
    cases_.make(again);
    run.run->bytes = again.run->bytes;
  }

 private:
  static constexpr std::uint32_t seed_lane = 1U << 20U;

  [[nodiscard]] std::uint64_t seed_of_run(std::size_t number) const {
    constexpr std::uint64_t seeds = 1'000'000'000;
    return stream_.bits(number, seed_lane, 0) % seeds;
  }

  /// Whether this run is another one than all before it.
  bool note(const HuntRun& run) {
    return known_.emplace(run.base, run.seed, cases_.values_at(hunt_.bases[run.base], run.point)).second;
  }

  void make(std::vector<HuntRun> runs) {
    std::vector<RunCase> cases;
    std::vector<std::size_t> of_case;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      check_interrupt();
      cases_.make(runs[i]);
      if (!runs[i].run) continue;
      cases.push_back(*runs[i].run);
      of_case.push_back(i);
    }
    const int done = static_cast<int>(runs_.size());
    int ended = 0;
    const std::vector<Trial> trials = try_all_(cases, [&] {
      if (options_.progress) options_.progress(done + ++ended);
    });
    for (std::size_t k = 0; k < trials.size(); ++k) judge(runs[of_case[k]], trials[k]);
    for (HuntRun& run : runs) {
      if (run.run && hunt_.bases[run.base].family)
        run.run->bytes.reset();  // one for each run: all would fill the memory
      runs_.push_back(std::move(run));
    }
  }

  void judge(HuntRun& run, const Trial& trial) const {
    run.why = trial.why;
    run.begun = !trial.refused;
    if (trial.signal != 0) {
      MethodsAlone alone = methods_alone(*run.run, trial, try_all_);
      run.outcomes = std::move(alone.outcomes);
      run.alone = !run.outcomes.empty();
      run.why = std::move(alone.why);
    } else if (trial.results && trial.why.empty()) {
      run.outcomes = outcomes_of(*trial.results);
    }
    for (const MethodOutcome& outcome : run.outcomes) run.badness = std::max(run.badness, outcome.badness);
  }

  const Hunt& hunt_;
  HuntOptions options_;
  TryCases try_all_;
  HuntCases cases_;
  Stream stream_;
  std::set<std::tuple<std::size_t, std::uint64_t, DrawnValues>> known_;  ///< base, seed and values of each run
  std::vector<HuntRun> runs_;
};

/// Keys of what a run has beside the simplest one.
std::vector<std::string> ingredient_keys(const HuntRun& run) {
  std::set<std::string> keys;
  for (const Ingredient& ingredient : ingredients_of(run.run->scenario)) keys.insert(ingredient.key);
  return {keys.begin(), keys.end()};
}

}  // namespace

HuntResult run_hunt(const Hunt& hunt, const HuntOptions& options, slam::MethodTable table) {
  const auto all = static_cast<std::size_t>(hunt.file.runs);
  const auto near = static_cast<std::size_t>(std::floor(hunt.file.refine * static_cast<double>(all)));
  HuntSearch search(hunt, options, table);
  HuntResult result;
  try {
    search.explore(std::max<std::size_t>(all - near, 1));
    search.refine(all - std::max<std::size_t>(all - near, 1));
  } catch (const Interrupted& interrupted) {
    result.signal = interrupted.signal();
  }
  result.runs = search.take();
  const auto begun = [](const HuntRun& run) { return run.begun; };
  if (result.signal == 0 && std::none_of(result.runs.begin(), result.runs.end(), begun))
    throw InputError(hunt.bases[result.runs.front().base].mark,
                     "no run can be made; the first: " + result.runs.front().why);
  summarize(result);
  for (const HuntFinding& finding : result.findings) search.restore(result.runs[finding.worst]);
  return result;
}

RunCase case_of(const HuntResult& result, const HuntFinding& finding) {
  const HuntRun& run = result.runs[finding.worst];
  return run.alone ? with_method(*run.run, finding.failure.method) : *run.run;
}

bool any_walked(const HuntResult& result) {
  return std::any_of(result.runs.begin(), result.runs.end(), [](const HuntRun& run) { return !run.outcomes.empty(); });
}

void summarize(HuntResult& result) {
  std::map<std::tuple<std::string, std::string, std::string, std::string, std::vector<std::string>>, HuntFinding> kinds;
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    for (const MethodOutcome& outcome : result.runs[i].outcomes) {
      if (!outcome.failure) continue;
      const FailureSignature& failure = *outcome.failure;
      if (!outcome.blame.of_method) {
        ++result.excused[outcome.blame.why];
        continue;
      }
      const std::vector<std::string> keys = ingredient_keys(result.runs[i]);
      HuntFinding& finding = kinds[{failure.method, failure.verdict, failure.gate ? failure.gate->metric : "",
                                    failure.cause + failure.error, keys}];
      if (finding.runs.empty() || outcome.badness > finding.badness) {
        finding.failure = failure;
        finding.ingredients = keys;
        finding.worst = i;
        finding.badness = outcome.badness;
      }
      finding.runs.push_back(i);
    }
  for (auto& [key, finding] : kinds) result.findings.push_back(std::move(finding));
  std::stable_sort(result.findings.begin(), result.findings.end(), [](const HuntFinding& a, const HuntFinding& b) {
    const int rank_a = severity_rank(a.failure), rank_b = severity_rank(b.failure);
    return rank_a != rank_b ? rank_a < rank_b : a.badness > b.badness;
  });
}

}  // namespace plumbline::scenarios
