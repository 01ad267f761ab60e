// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/blame.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "scenarios/spec/dotted_key.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

namespace {

constexpr double near_enough_m = 0.5;  // as near as a successful localization must be
constexpr std::array<std::string_view, 5> verdicts_by_severity = {"crashed", "false_convergence", "overconfident",
                                                                  "lost", "late"};

std::string text_in(const Tree& block, const std::string& key) {
  const Tree* value = find_at(block, key);
  return value != nullptr ? value->as_string() : std::string();
}

std::optional<double> number_in(const Tree& block, const std::string& key) {
  const Tree* value = find_at(block, key);
  return value != nullptr ? std::optional(value->as_double()) : std::nullopt;
}

bool localizes(const Tree& block) { return block.find("localization") != nullptr; }

const Tree::Map& blocks_of(const Tree& results) { return results.find("methods")->as_map(); }

bool keeps(const FailedGate& gate, const Tree& block) {
  const std::optional<double> value = number_in(block, gate.metric);
  return value && (gate.op == "<=" ? *value <= gate.limit : *value >= gate.limit);
}

/// The first other SLAM method of the run that did what this one did not; empty where none did.
std::string better_method(const FailureSignature& failure, const Tree& results) {
  for (const auto& [name, block] : blocks_of(results)) {
    if (name == failure.method || name == truth_method || localizes(block)) continue;
    if (text_in(block, "verdict") != "complete") continue;
    const std::optional<double> error = number_in(block, "ate_aligned_rmse_m");
    if (failure.gate ? keeps(*failure.gate, block) : error && *error <= near_enough_m) return name;
  }
  return {};
}

Blame localization_blame(const FailureSignature& failure) {
  if (failure.verdict == "lucky") return {false, "a right answer before scans and plan determined the pose"};
  if (failure.evidence == "unique") return {true, "scans and plan determine the pose in time"};
  return {false, "scans and plan do not determine the pose in time: evidence " +
                     (failure.evidence.empty() ? "absent" : failure.evidence)};
}

std::optional<double> error_in(const Tree& block) {
  return number_in(block, localizes(block) ? "localization.ape_rmse_m" : "ate_aligned_rmse_m");
}

}  // namespace

Blame blame_of(const FailureSignature& failure, const Tree& results) {
  if (failure.verdict == "crashed") return {true, "the method crashed"};
  if (failure.verdict == "false_convergence") return {true, "it was sure of a wrong pose"};
  if (failure.verdict == "overconfident") return {true, "it gave one answer where several poses explain the scans"};
  const auto& blocks = blocks_of(results);
  const auto own = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.first == failure.method; });
  if (own != blocks.end() && localizes(own->second)) return localization_blame(failure);
  const std::string better = better_method(failure, results);
  if (better.empty()) return {false, "no other method of the run did better"};
  return {true, failure.gate ? better + " kept the same bound" : better + " had a pose for the whole walk"};
}

std::vector<MethodOutcome> outcomes_of(const Tree& results) {
  const std::vector<FailureSignature> failures = failures_in(results);
  std::vector<MethodOutcome> outcomes;
  for (const auto& [name, block] : blocks_of(results)) {
    if (name == truth_method) continue;
    MethodOutcome outcome{
        name, text_in(block, "verdict"), text_in(block, "localization.evidence"), error_in(block), {}, {}, 0.0};
    for (const FailureSignature& failure : failures) {
      if (failure.method != name) continue;
      const Blame blame = blame_of(failure, results);
      const bool first = !outcome.failure;
      if (!first && (outcome.blame.of_method || !blame.of_method)) continue;
      outcome.failure = failure;
      outcome.blame = blame;
    }
    outcome.badness = badness_of(outcome);
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

MethodOutcome died(const std::string& method, const std::string& why) {
  MethodOutcome outcome;
  outcome.method = method;
  outcome.verdict = "crashed";
  outcome.failure = FailureSignature{method, "crashed", "", "", why, std::nullopt};
  outcome.blame = {true, why};
  outcome.badness = badness_of(outcome);
  return outcome;
}

double badness_of(const MethodOutcome& outcome) {
  constexpr double of_crash = 2.0;
  if (outcome.verdict == "crashed") return of_crash;
  if (outcome.failure && !outcome.blame.of_method) return 0.0;
  const double error = outcome.error_m.value_or(0.0);
  return (outcome.failure ? 1.0 : 0.0) + error / (error + near_enough_m);
}

int severity_rank(const FailureSignature& failure) {
  const auto* const end = verdicts_by_severity.end();
  const auto* const found = std::find(verdicts_by_severity.begin(), end, failure.verdict);
  return static_cast<int>(found - verdicts_by_severity.begin());
}

}  // namespace plumbline::scenarios
