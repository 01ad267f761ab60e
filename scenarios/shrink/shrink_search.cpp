// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/shrink_search.h"

#include <algorithm>
#include <numeric>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

/// What a candidate leaves out, in words.
std::string left_out(const std::vector<std::string>& names, const Kept& before, const Kept& after) {
  constexpr std::size_t most_named = 6;
  Kept gone;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(gone));
  std::string text;
  for (std::size_t i = 0; i < std::min(gone.size(), most_named); ++i) text += (i == 0 ? "" : ", ") + names[gone[i]];
  if (gone.size() > most_named) text += " and " + std::to_string(gone.size() - most_named) + " more";
  return "without " + text;
}

}  // namespace

ShrinkSearch::Try ShrinkSearch::try_of(const ShrinkCandidate& candidate) const {
  try {
    Try tried{candidate.make(), 0, {}};
    check_case(*tried.run);
    tried.digest = digest_of(*tried.run);
    return tried;
  } catch (const InputError& error) {
    return {std::nullopt, 0, error.what()};
  }
}

void ShrinkSearch::run_ahead(const std::vector<Try>& tries, std::size_t first) {
  std::vector<RunCase> cases;
  std::vector<std::uint64_t> digests;
  const auto most = static_cast<std::size_t>(std::max(1, std::min(options_.jobs, options_.max_runs - runs_)));
  for (std::size_t i = first; i < tries.size() && cases.size() < most; ++i) {
    const Try& tried = tries[i];
    if (!tried.run || known_.contains(tried.digest)) continue;
    if (std::find(digests.begin(), digests.end(), tried.digest) != digests.end()) continue;
    cases.push_back(*tried.run);
    digests.push_back(tried.digest);
  }
  std::vector<Trial> trials = try_cases(cases, options_.work, options_.jobs);
  for (std::size_t i = 0; i < trials.size(); ++i) known_[digests[i]] = std::move(trials[i]);
}

bool ShrinkSearch::judge(const ShrinkCandidate& candidate, const Try& tried) {
  if (!tried.run) {
    if (refused_.insert(candidate.what).second) steps_.push_back({candidate.what, false, tried.why});
    return false;
  }
  const Trial& trial = known_.at(tried.digest);
  const std::string why = trial.results && trial.why.empty() ? difference_to(failure_, *trial.results) : trial.why;
  const bool fresh = counted_.insert(tried.digest).second;
  if (fresh) ++runs_;
  if (fresh || why.empty()) steps_.push_back({candidate.what, why.empty(), why});
  if (options_.progress) options_.progress(runs_);
  if (!why.empty()) return false;
  best_ = *tried.run;
  results_ = *trial.results;
  return true;
}

std::optional<std::size_t> ShrinkSearch::first_failing(const std::vector<ShrinkCandidate>& candidates) {
  std::vector<Try> tries;
  for (const ShrinkCandidate& candidate : candidates) tries.push_back(try_of(candidate));
  for (std::size_t i = 0; i < tries.size(); ++i) {
    const bool fresh = tries[i].run && !counted_.contains(tries[i].digest);
    if (fresh && runs_ >= options_.max_runs) {
      exhausted_ = true;
      return std::nullopt;
    }
    if (tries[i].run && !known_.contains(tries[i].digest)) run_ahead(tries, i);
    if (judge(candidates[i], tries[i])) return i;
  }
  return std::nullopt;
}

bool ShrinkSearch::minimize_parts(const std::vector<std::string>& names,
                                  const std::function<RunCase(const RunCase&, const Kept&)>& with) {
  const RunCase whole = best_;
  Kept current(names.size());
  std::iota(current.begin(), current.end(), std::size_t{0});
  const Kept left = minimize(names.size(), [&](const std::vector<Kept>& sets) {
    std::vector<ShrinkCandidate> candidates;
    for (const Kept& kept : sets)
      candidates.push_back({left_out(names, current, kept), [&whole, &with, kept] { return with(whole, kept); }});
    const std::optional<std::size_t> failing = first_failing(candidates);
    if (failing) current = sets[*failing];
    return failing;
  });
  return left.size() < names.size();
}

}  // namespace plumbline::scenarios
