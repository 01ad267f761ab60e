// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenarios/shrink/ddmin.h"
#include "scenarios/shrink/shrink.h"
#include "scenarios/shrink/trial.h"

namespace plumbline::scenarios {

/// A smaller run to try; `make` throws InputError where it would be none.
struct ShrinkCandidate {
  std::string what;
  std::function<RunCase()> make;
};

/// The smallest run so far, and what was tried on the way. What it does depends on neither `jobs` nor time: runs that
/// were made ahead of their turn count when it comes, if it does.
class ShrinkSearch {
 public:
  ShrinkSearch(const RunCase& whole, const Tree& results, const FailureSignature& failure, const ShrinkOptions& options)
      : failure_(failure), options_(options), best_(whole), results_(results) {}

  /// Tries candidates in their order until one fails the same way, which becomes the best. Returns which one it was.
  std::optional<std::size_t> first_failing(const std::vector<ShrinkCandidate>& candidates);
  /// Of parts of the best run by delta debugging; `without` makes it anew with those parts that are kept. Returns
  /// whether any went.
  bool minimize_parts(const std::vector<std::string>& names,
                      const std::function<RunCase(const RunCase& best, const Kept& kept)>& with);

  [[nodiscard]] const RunCase& best() const { return best_; }
  [[nodiscard]] const Tree& results() const { return results_; }
  [[nodiscard]] const std::vector<ShrinkStep>& steps() const { return steps_; }
  [[nodiscard]] int runs() const { return runs_; }
  /// Whether something was left untried for want of runs.
  [[nodiscard]] bool is_exhausted() const { return exhausted_; }

 private:
  struct Try {
    std::optional<RunCase> run;
    std::uint64_t digest = 0;
    std::string why;  ///< where it is none
  };
  [[nodiscard]] Try try_of(const ShrinkCandidate& candidate) const;
  /// Makes the runs of `tries` from the first on that nothing is known of, as many as there are jobs and runs left.
  void run_ahead(const std::vector<Try>& tries, std::size_t first);
  /// Counts a try, and takes it where it fails the same way.
  [[nodiscard]] bool judge(const ShrinkCandidate& candidate, const Try& tried);

  FailureSignature failure_;
  ShrinkOptions options_;
  RunCase best_;
  Tree results_;
  std::map<std::uint64_t, Trial> known_;  ///< by digest
  std::set<std::uint64_t> counted_;
  std::set<std::string> refused_;  ///< what was left out of those that were no runs
  std::vector<ShrinkStep> steps_;
  int runs_ = 0;
  bool exhausted_ = false;
};

}  // namespace plumbline::scenarios
