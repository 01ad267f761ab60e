// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/score_file.h"

#include <array>
#include <cmath>
#include <utility>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_values = 500, most_gates = 500, longest_text = 2000;
constexpr double most_number = 1e30;

const Tree& gate_part(const Tree& gate, std::string_view key) {
  const Tree* part = gate.find(key);
  if (part == nullptr) throw InputError(gate.mark, "a gate must have '" + std::string(key) + "'");
  return *part;
}

std::string short_text(const Tree& text) {
  if (text.as_string().size() > longest_text)
    throw InputError(text.mark, "a text must have at most " + std::to_string(longest_text) + " bytes");
  return text.as_string();
}

double bounded_number(const Tree& number) {
  const double value = number.as_double();
  if (!(std::abs(value) <= most_number)) throw InputError(number.mark, "a number must be at most 1e30");
  return value;
}

/// Throws where a value, or one in it, is none that a table can show.
void check_value(const Tree& value, std::size_t depth, std::size_t& values) {
  constexpr std::size_t deepest = 4;
  if (depth > deepest) throw InputError(value.mark, "blocks must not stand deeper in one another");
  if (++values > most_values)
    throw InputError(value.mark, "there must be at most " + std::to_string(most_values) + " values");
  if (std::holds_alternative<double>(value.value)) static_cast<void>(bounded_number(value));
  if (std::holds_alternative<std::string>(value.value)) static_cast<void>(short_text(value));
  if (value.is_list())
    for (const Tree& entry : value.as_list()) check_value(entry, depth + 1, values);
  if (value.is_map())
    for (const auto& [key, entry] : value.as_map()) check_value(entry, depth + 1, values);
}

score::GateResult gate_in(const Tree& gate) {
  score::GateResult read;
  read.metric = short_text(gate_part(gate, "metric"));
  read.method = short_text(gate_part(gate, "method"));
  read.op = short_text(gate_part(gate, "op"));
  if (read.op != "<=" && read.op != ">=") throw InputError(gate_part(gate, "op").mark, "'<=' or '>=' is expected");
  read.limit = gate_part(gate, "limit").as_double();
  if (const Tree* value = gate.find("value")) read.value = value->as_double();
  if (const Tree* reason = gate.find("reason")) read.but = short_text(*reason);
  read.passed = gate_part(gate, "passed").as_bool();
  return read;
}

}  // namespace

EstimateScores read_estimate_scores(std::string_view text, const std::string& file) {
  const Tree tree = read_json(text, file);
  EstimateScores scores{Tree::map(), {}};
  std::size_t values = 0;
  for (const auto& [key, value] : tree.as_map()) {
    if (key == "gates") {
      if (value.as_list().size() > most_gates)
        throw InputError(value.mark, "there must be at most " + std::to_string(most_gates) + " gates");
      for (const Tree& gate : value.as_list()) scores.gates.push_back(gate_in(gate));
      continue;
    }
    check_value(value, 0, values);
    for (const char* block : {"reference", "silence", "localization", "causal", "final"})
      if (key == block) static_cast<void>(value.as_map());
    if (key == "verdict") static_cast<void>(value.as_string());
    if (key != "plumbline" && key != "method") scores.numbers.set(key, value);
  }
  return scores;
}

}  // namespace plumbline::scenarios
