// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/failure_signature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/spec/dotted_key.h"

namespace plumbline::scenarios {

namespace {

std::string word_at(const Tree& map, const std::string& key) {
  const Tree* value = find_at(map, key);
  return value != nullptr && value->is_scalar() && !value->is_null() ? value->as_string() : std::string();
}

/// Numbers differ between runs that crash for one reason.
std::string without_numbers(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit) out += c;
    if (digit && (out.empty() || out.back() != '#')) out += '#';
  }
  return out;
}

const Tree::Map& methods_of(const Tree& results) {
  static const Tree::Map none;
  const Tree* methods = results.is_map() ? results.find("methods") : nullptr;
  return methods != nullptr && methods->is_map() ? methods->as_map() : none;
}

const Tree::List& gates_of(const Tree& results) {
  static const Tree::List none;
  const Tree* gates = results.is_map() ? results.find("gates") : nullptr;
  return gates != nullptr && gates->is_list() ? gates->as_list() : none;
}

FailureSignature signature_of(const std::string& method, const Tree& block) {
  return {method,
          word_at(block, "verdict"),
          word_at(block, "localization.evidence"),
          word_at(block, "localization.failure"),
          without_numbers(word_at(block, "error")),
          std::nullopt};
}

FailedGate gate_of(const Tree& gate) {
  const Tree* value = gate.find("value");
  return {word_at(gate, "metric"), word_at(gate, "op"), gate.find("limit")->as_double(),
          value != nullptr ? std::optional(value->as_double()) : std::nullopt};
}

bool is_failed(const Tree& gate) {
  return gate.is_map() && gate.find("passed") != nullptr && !gate.find("passed")->as_bool();
}

std::string list_of(const std::vector<FailureSignature>& failures) {
  std::string text;
  for (const FailureSignature& failure : failures) text += (text.empty() ? "" : "; ") + describe(failure);
  return text;
}

void check_method(const Tree& results, const std::string& method) {
  std::vector<std::string> known;
  for (const auto& [name, block] : methods_of(results)) known.push_back(name);
  if (std::find(known.begin(), known.end(), method) != known.end()) return;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  const std::string close = did_you_mean(method, known);
  throw InputError({"--method", 0, 0}, "'" + method + "' is no method of this run; " +
                                           (close.empty() ? "it has " + list : "did you mean '" + close + "'?"));
}

/// Why a gate does not fail the same way.
std::string gate_difference(const FailedGate& failed, const std::string& method, const Tree& results) {
  const auto it = std::find_if(gates_of(results).begin(), gates_of(results).end(), [&](const Tree& gate) {
    return word_at(gate, "metric") == failed.metric && word_at(gate, "method") == method &&
           word_at(gate, "op") == failed.op && gate.find("limit")->as_double() == failed.limit;
  });
  if (it == gates_of(results).end()) return "the gate is not judged";
  if (!is_failed(*it)) return "the gate passes";
  const std::optional<double> value = gate_of(*it).value;
  if (value.has_value() != failed.value.has_value()) return value ? "the metric has a value" : "the metric is absent";
  if (!value) return {};
  constexpr double least_share = 0.5;
  if (std::abs(*value - failed.limit) >= least_share * std::abs(*failed.value - failed.limit)) return {};
  return "the gate fails by less than half as much";
}

}  // namespace

bool is_bad_verdict(std::string_view verdict) {
  constexpr std::array<std::string_view, 3> good = {"complete", "success", "honest_ambiguity"};
  return std::find(good.begin(), good.end(), verdict) == good.end();
}

std::vector<FailureSignature> failures_in(const Tree& results, bool all_gates) {
  std::vector<FailureSignature> failures;
  const auto add_verdict = [&](const FailureSignature& failure) {
    if (std::none_of(failures.begin(), failures.end(),
                     [&](const FailureSignature& other) { return other.method == failure.method && !other.gate; }))
      failures.push_back(failure);
  };
  for (const Tree& gate : gates_of(results)) {
    if (!is_failed(gate)) continue;
    const std::string method = word_at(gate, "method");
    const auto& methods = methods_of(results);
    const auto block = std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.first == method; });
    if (block == methods.end()) continue;
    FailureSignature failure = signature_of(method, block->second);
    const bool bad = is_bad_verdict(failure.verdict);
    if (bad) add_verdict(failure);
    if (bad && !all_gates) continue;
    failure.gate = gate_of(gate);
    failures.push_back(std::move(failure));
  }
  for (const auto& [method, block] : methods_of(results)) {
    const FailureSignature failure = signature_of(method, block);
    if (is_bad_verdict(failure.verdict)) add_verdict(failure);
  }
  return failures;
}

FailureSignature chosen_failure(const Tree& results, const std::string& dir, const std::string& method,
                                const std::string& metric) {
  const Mark mark{dir, 0, 0};
  if (const std::string walk = word_at(results, "failure"); !walk.empty())
    throw InputError(mark, "the walk itself failed, which is no method's failure: " + walk);
  if (!method.empty()) check_method(results, method);
  const std::vector<FailureSignature> failures = failures_in(results, !metric.empty());
  if (failures.empty()) throw InputError(mark, "does not fail: every verdict is good and no gate failed");
  for (const FailureSignature& failure : failures)
    if ((method.empty() || failure.method == method) &&
        (metric.empty() || (failure.gate && failure.gate->metric == metric)))
      return failure;
  throw InputError({metric.empty() ? "--method" : "--gate", 0, 0},
                   (metric.empty() ? "'" + method + "' does not fail in this run"
                                   : "no gate on '" + metric + "'" + (method.empty() ? "" : " of '" + method + "'") +
                                         " failed in this run") +
                       "; what fails is " + list_of(failures_in(results)));
}

std::string difference_to(const FailureSignature& failure, const Tree& results) {
  const auto& methods = methods_of(results);
  const auto block =
      std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.first == failure.method; });
  if (block == methods.end()) return "the method is not there";
  if (const std::string walk = word_at(results, "failure"); !walk.empty()) return "the walk fails: " + walk;
  const FailureSignature other = signature_of(failure.method, block->second);
  if (other.verdict != failure.verdict) return "verdict " + other.verdict;
  if (other.evidence != failure.evidence) return "evidence " + (other.evidence.empty() ? "absent" : other.evidence);
  if (other.cause != failure.cause) return "cause " + (other.cause.empty() ? "absent" : other.cause);
  if (other.error != failure.error) return "another error: " + other.error;
  return failure.gate ? gate_difference(*failure.gate, failure.method, results) : std::string();
}

std::string describe(const FailureSignature& failure) {
  std::string text = failure.method + ": ";
  if (failure.gate)
    text += failure.gate->metric + (failure.gate->value ? " is " + format_number(*failure.gate->value) : " is absent") +
            ", must be " + failure.gate->op + " " + format_number(failure.gate->limit) + ", verdict ";
  text += failure.verdict;
  if (!failure.cause.empty()) text += " (" + failure.cause + ")";
  if (!failure.error.empty()) text += " (" + failure.error + ")";
  if (!failure.evidence.empty()) text += ", evidence " + failure.evidence;
  return text;
}

Tree to_results(const FailureSignature& failure) {
  Tree tree = Tree::map();
  tree.set("method", failure.method).set("verdict", failure.verdict);
  if (!failure.evidence.empty()) tree.set("evidence", failure.evidence);
  if (!failure.cause.empty()) tree.set("cause", failure.cause);
  if (!failure.error.empty()) tree.set("error", failure.error);
  if (!failure.gate) return tree;
  Tree gate = Tree::map();
  gate.set("metric", failure.gate->metric).set("op", failure.gate->op).set("limit", failure.gate->limit);
  if (failure.gate->value) gate.set("value", *failure.gate->value);
  return tree.set("gate", std::move(gate));
}

}  // namespace plumbline::scenarios
