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
  std::string part = {};  ///< where it leaves out one alone, its name
};

/// Candidates, each made when its turn comes.
struct ShrinkCandidates {
  std::size_t count = 0;
  std::function<ShrinkCandidate(std::size_t)> at;
};

/// The smallest run so far, and what was tried on the way. What it does depends on neither `jobs` nor time: runs that
/// were made ahead of their turn count when it comes, if it does.
class ShrinkSearch {
 public:
  ShrinkSearch(const RunCase& whole, const Tree& results, const FailureSignature& failure,
               const ShrinkOptions& options);

  /// Tries candidates in their order until one fails the same way, which becomes the best. Returns which one it was.
  std::optional<std::size_t> first_failing(const ShrinkCandidates& candidates);
  std::optional<std::size_t> first_failing(const std::vector<ShrinkCandidate>& candidates);
  /// Of parts of the best run by delta debugging; `with` makes it anew with those parts that are kept. Returns whether
  /// any went.
  bool minimize_parts(const std::vector<std::string>& names,
                      const std::function<RunCase(const RunCase& best, const Kept& kept)>& with);

  [[nodiscard]] const RunCase& best() const { return best_; }
  [[nodiscard]] const Tree& results() const { return results_; }
  [[nodiscard]] const std::vector<ShrinkStep>& steps() const { return steps_; }
  [[nodiscard]] int runs() const { return runs_; }
  /// Whether something was left untried for want of runs.
  [[nodiscard]] bool is_exhausted() const { return exhausted_; }
  /// Whether a part of this name was left out alone, and the run no longer failed the same way.
  [[nodiscard]] bool is_needed(const std::string& part) const { return needed_.contains(part); }

 private:
  struct Try {
    std::string what, part;
    std::optional<RunCase> run;
    std::uint64_t digest = 0;
    std::string why;  ///< where it is none
  };
  using Tries = std::map<std::size_t, Try>;  ///< by candidate: the next ones, as far as they are made
  [[nodiscard]] static Try try_of(const ShrinkCandidate& candidate);
  static const Try& made(Tries& tries, const ShrinkCandidates& candidates, std::size_t i);
  /// Runs candidates from the first on that nothing is known of, as many as there are jobs and runs left.
  void run_ahead(Tries& tries, const ShrinkCandidates& candidates, std::size_t first);
  /// Counts a try, and takes it where it fails the same way.
  [[nodiscard]] bool judge(const Try& tried);
  [[nodiscard]] bool fails_as_well(const Try& tried);

  FailureSignature failure_;
  ShrinkOptions options_;
  TryCases try_all_;
  RunCase best_;
  Tree results_;
  std::map<std::uint64_t, Trial> known_;  ///< by digest
  std::set<std::uint64_t> counted_;
  std::set<std::string> refused_;  ///< what was left out of those that were no runs
  std::set<std::string> needed_;
  std::vector<ShrinkStep> steps_;
  int runs_ = 0;
  bool exhausted_ = false;
};

}  // namespace plumbline::scenarios
