// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "scenarios/metrics/metrics.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios::score {

namespace {

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string test_case(const std::string& class_name, const std::string& name, const std::string& failure,
                      const std::string& see) {
  std::string text = "  <testcase classname=\"" + escape_xml(class_name) + "\" name=\"" + escape_xml(name) + "\"";
  if (failure.empty()) return text + "/>\n";
  return text + ">\n    <failure message=\"" + escape_xml(failure) + "\">see report.html" +
         (see.empty() ? "" : ", or replay.html" + escape_xml(see) + " (plumbline report --3d writes it)") +
         "</failure>\n  </testcase>\n";
}

/// Whether the block of a metric was scored at all.
bool has_block(std::string_view metric, const MethodScore& score) {
  return (metric.starts_with("rooms.") && score.rooms) || (metric.starts_with("walls.") && score.walls) ||
         (metric.starts_with("storeys.") && score.storeys) || (metric.starts_with("loops.") && score.loops) ||
         (metric.starts_with("segmentation.") && score.segmentation);
}

/// Why a method that went to the end has no value of a metric, a clause; empty where none is known.
std::string why_absent(std::string_view metric, const MethodScore& score) {
  const bool never = score.localization && !score.localization->converged_at_s;
  if (score.localization && metric.starts_with("localization."))
    return never ? "it never converged on one pose" : std::string();
  if (score.trajectory) {
    if (metric == "ate_final_rmse_m") return "fewer than 95 % of the scans have a final pose";
    if (metric == "rpe_1m_rmse_m") return "no 1 m of the walk has a pose at both ends";
    if (metric.starts_with("drift_10m_")) return "no 10 m of the walk have a pose at both ends";
  }
  if (has_block(metric, score))
    return metric.ends_with(".recall") ? "the walk has none that it could find" : "it found none";
  // What it found stands in the plan's frame only from then on.
  if (never && (metric.starts_with("map_") || metric.starts_with("rooms.") || metric.starts_with("walls.")))
    return "it never converged on one pose";
  return score.name + " has no such metric";
}

std::string lost(const MethodScore& score) {
  return std::string("the method was lost") + (score.localization ? "" : ": fewer than 95 % of the scans have a pose");
}

}  // namespace

GateResult judge_gate(const GateSpec& gate, const std::string& method, std::optional<double> value, std::string but) {
  const bool within = value && (gate.max ? *value <= *gate.max : *value >= *gate.min);
  const bool passed = within && but.empty();
  return {gate.metric, method, gate.max ? "<=" : ">=", gate.max ? *gate.max : *gate.min, value, std::move(but), passed};
}

std::vector<GateResult> judge_gates(const std::vector<GateSpec>& gates, const std::vector<MethodScore>& scores,
                                    bool run_completed) {
  std::vector<GateResult> results;
  for (const GateSpec& gate : gates) {
    std::optional<double> value;
    std::string but;
    const auto score =
        std::find_if(scores.begin(), scores.end(), [&](const MethodScore& s) { return s.name == gate.method; });
    if (score != scores.end()) {
      const MetricRow& metric = *find_metric(gate.metric);
      value = metric.value(*score);
      but = !run_completed                                       ? "the run ended early"
            : score->verdict == "crashed"                        ? "the method crashed"
            : score->verdict == "lost" && !metric.also_when_lost ? lost(*score)
            : value                                              ? ""
                                                                 : why_absent(gate.metric, *score);
    }
    results.push_back(judge_gate(gate, gate.method, value, std::move(but)));
  }
  return results;
}

Tree to_results(const GateResult& gate) {
  Tree tree = Tree::map();
  tree.set("metric", gate.metric).set("method", gate.method).set("op", gate.op).set("limit", gate.limit);
  if (gate.value) tree.set("value", *gate.value);
  tree.set("passed", gate.passed);
  if (!gate.but.empty()) tree.set("reason", gate.but);
  if (!gate.see.empty()) tree.set("see", "replay.html" + gate.see);
  return tree;
}

std::string describe(const GateResult& gate) {
  const std::string what = gate.metric + " of " + gate.method;
  const std::string must = ", must be " + gate.op + " " + format_number(gate.limit);
  return what + (gate.value ? " is " + gate_value(*gate.value, gate.limit) : " is absent") + must +
         (gate.but.empty() ? "" : (gate.value ? ", but " : ": ") + gate.but);
}

std::string gate_value(double value, double limit) {
  std::array<char, 32> text{};
  constexpr int all = std::numeric_limits<double>::max_digits10;
  for (int digits = 4; digits <= all; ++digits) {
    char* end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr;
    double shown = 0.0;
    std::from_chars(text.data(), end, shown);
    if ((shown < limit) == (value < limit) && (shown > limit) == (value > limit)) return {text.data(), end};
  }
  return format_number(value);
}

std::string write_junit(const std::string& suite, const std::vector<GateResult>& gates,
                        const std::vector<MethodScore>& scores, const std::string& failure) {
  std::string cases;
  std::size_t count = 0;
  std::size_t failures = 0;
  const auto add = [&](const std::string& class_name, const std::string& name, const std::string& failure,
                       const std::string& see = "") {
    cases += test_case(class_name, name, failure, see);
    ++count;
    if (!failure.empty()) ++failures;
  };
  add(suite, "the walk is done", failure);
  for (const GateResult& gate : gates)
    add(suite + "." + gate.method, gate.metric + " " + gate.op + " " + format_number(gate.limit),
        gate.passed ? "" : describe(gate), gate.see);
  for (const MethodScore& score : scores)
    add(suite + "." + score.name, "runs to the end", score.verdict == "crashed" ? "crashed: " + score.error : "");
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"" + escape_xml(suite) + "\" tests=\"" +
         std::to_string(count) + "\" failures=\"" + std::to_string(failures) + "\">\n" + cases + "</testsuite>\n";
}

}  // namespace plumbline::scenarios::score
