// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/shrink_search.h"

#include <algorithm>
#include <numeric>

#include "bim/errors.h"
#include "scenarios/host/interrupt.h"

namespace plumbline::scenarios {

namespace {

/// Parts that a candidate leaves out.
Kept gone_between(const Kept& before, const Kept& after) {
  Kept gone;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(gone));
  return gone;
}

std::string left_out(const std::vector<std::string>& names, const Kept& gone) {
  constexpr std::size_t most_named = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(gone.size(), most_named); ++i) text += (i == 0 ? "" : ", ") + names[gone[i]];
  if (gone.size() > most_named) text += " and " + std::to_string(gone.size() - most_named) + " more";
  return "without " + text;
}

}  // namespace

ShrinkSearch::ShrinkSearch(const RunCase& whole, const Tree& results, const FailureSignature& failure,
                           const ShrinkOptions& options)
    : failure_(failure),
      options_(options),
      try_all_(options.try_all ? options.try_all : in_processes(options.work, options.jobs)),
      best_(whole),
      results_(results) {}

ShrinkSearch::Try ShrinkSearch::try_of(const ShrinkCandidate& candidate) {
  try {
    Try tried{candidate.what, candidate.part, candidate.make(), 0, {}};
    check_case(*tried.run);
    tried.digest = digest_of(*tried.run);
    return tried;
  } catch (const InputError& error) {
    return {candidate.what, candidate.part, std::nullopt, 0, error.what()};
  }
}

const ShrinkSearch::Try& ShrinkSearch::made(Tries& tries, const ShrinkCandidates& candidates, std::size_t i) {
  const auto found = tries.find(i);
  if (found != tries.end()) return found->second;
  check_interrupt();  // of a large plan each takes its time
  return tries.emplace(i, try_of(candidates.at(i))).first->second;
}

void ShrinkSearch::run_ahead(Tries& tries, const ShrinkCandidates& candidates, std::size_t first) {
  constexpr std::size_t looked_at_for_each = 4;  // the next ones may be no runs, or known
  std::vector<RunCase> cases;
  std::vector<std::uint64_t> digests;
  const auto most = static_cast<std::size_t>(std::max(1, std::min(options_.jobs, options_.max_runs - runs_)));
  const std::size_t end = std::min(candidates.count, first + (most == 1 ? 1 : looked_at_for_each * most));
  for (std::size_t i = first; i < end && cases.size() < most; ++i) {
    const Try& tried = made(tries, candidates, i);
    if (!tried.run || known_.contains(tried.digest)) continue;
    if (std::find(digests.begin(), digests.end(), tried.digest) != digests.end()) continue;
    cases.push_back(*tried.run);
    digests.push_back(tried.digest);
  }
  std::vector<Trial> trials = try_all_(cases, {});
  for (std::size_t i = 0; i < trials.size(); ++i) known_[digests[i]] = std::move(trials[i]);
}

bool ShrinkSearch::judge(const Try& tried) {
  const bool fails = fails_as_well(tried);
  if (!fails && !tried.part.empty()) needed_.insert(tried.part);
  return fails;
}

bool ShrinkSearch::fails_as_well(const Try& tried) {
  if (!tried.run) {
    if (refused_.insert(tried.what).second) steps_.push_back({tried.what, false, tried.why});
    return false;
  }
  const Trial& trial = known_.at(tried.digest);
  const std::string why = trial.results && trial.why.empty() ? difference_to(failure_, *trial.results) : trial.why;
  const bool fresh = counted_.insert(tried.digest).second;
  if (fresh) ++runs_;
  if (fresh || why.empty()) steps_.push_back({tried.what, why.empty(), why});
  if (options_.progress) options_.progress(runs_);
  if (!why.empty()) return false;
  best_ = *tried.run;
  results_ = *trial.results;
  return true;
}

std::optional<std::size_t> ShrinkSearch::first_failing(const ShrinkCandidates& candidates) {
  Tries tries;
  for (std::size_t i = 0; i < candidates.count && !exhausted_; ++i) {
    const Try& tried = made(tries, candidates, i);
    exhausted_ = tried.run && !counted_.contains(tried.digest) && runs_ >= options_.max_runs;
    if (exhausted_) break;
    if (tried.run && !known_.contains(tried.digest)) run_ahead(tries, candidates, i);
    if (judge(tried)) return i;
    tries.erase(i);
  }
  return std::nullopt;
}

std::optional<std::size_t> ShrinkSearch::first_failing(const std::vector<ShrinkCandidate>& candidates) {
  return first_failing({candidates.size(), [&](std::size_t i) { return candidates[i]; }});
}

bool ShrinkSearch::minimize_parts(const std::vector<std::string>& names,
                                  const std::function<RunCase(const RunCase&, const Kept&)>& with) {
  const RunCase whole = best_;
  Kept current(names.size());
  std::iota(current.begin(), current.end(), std::size_t{0});
  bool all_needed = false;  // with none of them it does not fail
  const Kept left = minimize(names.size(), [&](const KeptCandidates& sets) -> FirstFailure {
    const std::optional<std::size_t> failing =
        first_failing({sets.count, [&](std::size_t i) -> ShrinkCandidate {
                         const Kept kept = sets.at(i), gone = gone_between(current, kept);
                         return {left_out(names, gone), [&whole, &with, kept] { return with(whole, kept); },
                                 gone.size() == 1 ? names[gone.front()] : ""};
                       }});
    if (failing) current = sets.at(*failing);
    all_needed = all_needed || (sets.count == 1 && !failing && !exhausted_);
    return {failing, exhausted_};
  });
  if (left.size() == 1 && all_needed) needed_.insert(names[left.front()]);
  return left.size() < names.size();
}

}  // namespace plumbline::scenarios
