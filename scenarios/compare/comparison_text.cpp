// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/comparison_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bim/config/printable.h"

namespace plumbline::scenarios {

namespace {

using Words = std::vector<std::string>;

std::string formatted(const char* format, double value) {
  std::array<char, 64> text{};
  (void)std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// 0.0123: four digits of a value in its unit.
std::string value_text(const std::optional<double>& value) { return value ? formatted("%.4g", *value) : "none"; }

/// "1.180" of a ratio, "+0.02" of a difference.
std::string shift_text(double shift, Change change) {
  if (std::isinf(shift)) return shift > 0.0 ? "inf" : "-inf";
  if (change == Change::difference) return formatted("%+.3g", shift);
  return shift >= 0.01 && shift < 100.0 ? formatted("%.3f", shift) : formatted("%.3g", shift);
}

std::string p_text(const std::optional<double>& p) {
  if (!p) return "";
  return *p >= 0.0995 ? formatted("%.2f", *p) : *p >= 0.001 ? formatted("%.3f", *p) : formatted("%.0e", *p);
}

std::string plural(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

/// Why nothing is shown: what would have been.
std::string not_shown_text(const ComparedValue& value) {
  if (value.differing() == 0) return value.pairs == 1 ? "equal" : "equal in all pairs";
  const std::string text = to_string(Finding::not_shown);
  if (!value.p_holm)
    return text + ", " + std::to_string(value.differing()) + (value.differing() == 1 ? " differs" : " differ");
  const std::optional<double> detectable = value.detectable();
  if (!detectable) return text;
  if (value.change == Change::difference) return text + ", detectable: " + formatted("%.2g", *detectable);
  return text + ", detectable: " +
         (*detectable < 1.0 ? formatted("%.2g", 100.0 * *detectable) + " %"
                            : formatted("%.2g", 1.0 + *detectable) + " times");
}

std::string finding_text(const ComparedValue& value) {
  if (!value.finding) return "";
  if (*value.finding == Finding::differs && value.differing() == 0) return "equal";
  return *value.finding == Finding::not_shown ? not_shown_text(value) : to_string(*value.finding);
}

std::string of_pairs(const std::optional<double>& count, std::size_t pairs) {
  return formatted("%.0f", count.value_or(0.0)) + "/" + std::to_string(pairs);
}

Words line_of(const ComparedValue& value) {
  Words line = {value.scenario.empty() ? value.name : "  " + printable(value.scenario)};
  for (const std::optional<double>& side : {value.a, value.b})
    line.push_back(value.outcome ? of_pairs(side, value.pairs) : value_text(side));
  line.push_back(value.shift && value.differing() > 0 ? shift_text(*value.shift, value.change) : "");
  line.push_back(value.interval ? "[" + shift_text(value.interval->first, value.change) + ", " +
                                      shift_text(value.interval->second, value.change) + "]"
                                : "");
  for (const std::size_t count : {value.better, value.equal, value.worse})
    line.push_back(value.pairs == 1 ? "" : std::to_string(count));
  line.push_back(value.missing_a + value.missing_b == 0
                     ? ""
                     : std::to_string(value.missing_a) + "/" + std::to_string(value.missing_b));
  line.push_back(p_text(value.p));
  line.push_back(p_text(value.p_holm));
  line.push_back(finding_text(value));
  return line;
}

/// Columns that say nothing are left out; the first and the last begin at their left, numbers end at their right.
std::string in_columns(const std::vector<Words>& lines) {
  const std::size_t columns = lines.front().size();
  std::vector<std::size_t> width(columns, 0);
  std::vector<bool> shown(columns, false);
  for (std::size_t line = 0; line < lines.size(); ++line)
    for (std::size_t i = 0; i < columns && i < lines[line].size(); ++i) {
      if (lines[line].size() == columns) width[i] = std::max(width[i], lines[line][i].size());
      if (line > 0 && !lines[line][i].empty()) shown[i] = true;
    }
  std::string text;
  const bool any = std::find(shown.begin() + 1, shown.end(), true) != shown.end();
  for (std::size_t number = any ? 0 : 1; number < lines.size(); ++number) {
    const Words& line = lines[number];
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!shown[i]) continue;
      const std::string blank(width[i] - std::min(width[i], line[i].size()), ' ');
      const bool left = i == 0 || i + 1 == columns;
      row += (i == 0 ? "" : "  ") + (left ? line[i] + blank : blank + line[i]);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string table_of(const Comparison& comparison) {
  std::vector<Words> lines = {
      {"", "A", "B", "B/A, B-A", "95 %", "better", "equal", "worse", "none A/B", "p", "Holm", "B is"}};
  for (const ComparedMethod& method : comparison.methods) {
    lines.push_back({printable(method.name) + ", " + plural(method.pairs, "pair") +
                     (method.failed > 0 ? ", " + std::to_string(method.failed) + " left out: failed walks" : "") +
                     (method.same ? ": same, byte for byte" : "")});
    for (const ComparedValue& value : method.values) {
      lines.push_back(line_of(value));
      lines.back().front() = "  " + lines.back().front();
    }
  }
  return in_columns(lines);
}

/// "what: 12: a; b; and 6 more", a line.
std::string list_text(const std::string& what, const Words& items) {
  constexpr std::size_t most = 6;
  if (items.empty()) return "";
  std::string text = what + ": " + std::to_string(items.size());
  for (std::size_t i = 0; i < std::min(items.size(), most); ++i) text += (i == 0 ? ": " : "; ") + printable(items[i]);
  if (items.size() > most) text += "; and " + std::to_string(items.size() - most) + " more";
  return text + "\n";
}

Words failure_texts(const std::vector<OneSidedFailure>& runs) {
  Words texts;
  for (const OneSidedFailure& run : runs) texts.push_back(run.run + ", " + run.method + ": " + run.a + " -> " + run.b);
  return texts;
}

std::string sensors_text(const Comparison& comparison) {
  const std::size_t all = comparison.same_sensors + comparison.other_sensors + comparison.unknown_sensors;
  if (all == 0) return "sensor data: none, all walks failed in A or B\n";
  if (comparison.same_sensors == all) return "sensor data: the same in A and B\n";
  std::string text = "sensor data: ";
  if (comparison.other_sensors > 0)
    text += "not the same in " + std::to_string(comparison.other_sensors) + " of " + plural(all, "pair") +
            ", which are paired by name only\n";
  else
    text += "not known to be the same in " + std::to_string(comparison.unknown_sensors) + " of " + plural(all, "pair") +
            ": no digest tells\n";
  return text;
}

std::string names_of(const Comparison& comparison, Finding finding) {
  std::string names;
  for (const ComparedMethod& method : comparison.methods)
    for (const ComparedValue& value : method.values)
      if (value.finding == finding) names += (names.empty() ? "" : ", ") + printable(method.name) + " " + value.name;
  return names;
}

bool is_any_different(const Comparison& comparison) {
  return std::any_of(comparison.methods.begin(), comparison.methods.end(),
                     [](const ComparedMethod& method) { return method.different; });
}

std::string verdict_text(const Comparison& comparison) {
  std::string text = "verdict: " + to_string(comparison.finding);
  const std::string better = names_of(comparison, Finding::better), worse = names_of(comparison, Finding::worse);
  if (!worse.empty()) text += (better.empty() ? " in " : "; worse in ") + worse;
  if (!better.empty()) text += (worse.empty() ? " in " : "; better in ") + better;
  if (comparison.finding == Finding::same) text += ", byte for byte";
  if (comparison.finding == Finding::differs) text += "; a single pair shows no more";
  if (comparison.tests > 0)
    text += " (" + plural(comparison.tests, "test") + " at 5 % in all" + (comparison.tests > 1 ? ", Holm)" : ")");
  else if (comparison.finding == Finding::not_shown && !is_any_different(comparison))
    text += " (all scores are equal; no digest tells whether all else is)";
  else if (comparison.finding == Finding::not_shown)
    text += " (no test: no value differs in 6 pairs or more)";
  if (!comparison.failures_b.empty()) text += "; failures only in B: " + std::to_string(comparison.failures_b.size());
  return text + "\n";
}

Tree list_of(const Words& words) {
  Tree list = Tree::list();
  for (const std::string& word : words) list.push(word);
  return list;
}

Tree list_of(const std::vector<OneSidedFailure>& runs) {
  Tree list = Tree::list();
  for (const OneSidedFailure& run : runs)
    list.push(Tree::map().set("run", run.run).set("method", run.method).set("a", run.a).set("b", run.b));
  return list;
}

Tree number(std::size_t count) { return {static_cast<std::int64_t>(count)}; }

/// JSON has no infinity: the word stands for it.
Tree number(double value) {
  if (std::isinf(value)) return {value > 0.0 ? "inf" : "-inf"};
  return {value};
}

Tree tree_of(const ComparedValue& value) {
  Tree tree = Tree::map();
  tree.set("name", value.name);
  if (!value.scenario.empty()) tree.set("scenario", value.scenario);
  tree.set("pairs", number(value.pairs)).set("better", number(value.better)).set("equal", number(value.equal));
  tree.set("worse", number(value.worse));
  if (value.missing_a + value.missing_b > 0)
    tree.set("without_value", Tree::map().set("a", number(value.missing_a)).set("b", number(value.missing_b)));
  if (value.a) tree.set("a", number(*value.a));
  if (value.b) tree.set("b", number(*value.b));
  if (value.shift) tree.set(value.change == Change::ratio ? "ratio" : "difference", number(*value.shift));
  if (value.interval)
    tree.set("interval", Tree::list().push(number(value.interval->first)).push(number(value.interval->second)));
  if (value.geometric_mean) tree.set("geometric_mean_ratio", number(*value.geometric_mean));
  if (value.detectable()) tree.set("detectable", number(*value.detectable()));
  if (value.p) tree.set("p", number(*value.p));
  if (value.p_holm) tree.set("p_holm", number(*value.p_holm));
  if (value.finding) tree.set("verdict", to_string(*value.finding));
  return tree;
}

}  // namespace

std::string comparison_text(const Comparison& comparison, const ComparedNames& names) {
  std::string text = "A: " + printable(names.a) + "\nB: " + printable(names.b) + "\n\n" + table_of(comparison) + "\n";
  text += sensors_text(comparison);
  text += list_text("only in A", comparison.only_a) + list_text("only in B", comparison.only_b);
  if (comparison.shared_walks) text += "walks: some pairs share a walk, as variants do; p takes pairs as independent\n";
  if (comparison.rescored > 0)
    text += "scores: other in " + plural(comparison.rescored, "pair") + " with equal digests: the scoring changed\n";
  text += list_text("failures only in A", failure_texts(comparison.failures_a));
  text += list_text("failures only in B", failure_texts(comparison.failures_b));
  return text + verdict_text(comparison);
}

Tree comparison_results(const Comparison& comparison, const ComparedNames& names) {
  Tree tree = Tree::map();
  tree.set("a", names.a).set("b", names.b).set("verdict", to_string(comparison.finding));
  tree.set("tests", number(comparison.tests)).set("pairs", number(comparison.pairs));
  tree.set("only_a", list_of(comparison.only_a)).set("only_b", list_of(comparison.only_b));
  tree.set("failures_only_in_a", list_of(comparison.failures_a))
      .set("failures_only_in_b", list_of(comparison.failures_b));
  tree.set("sensor_data", Tree::map()
                              .set("same", number(comparison.same_sensors))
                              .set("other", number(comparison.other_sensors))
                              .set("unknown", number(comparison.unknown_sensors)));
  tree.set("shared_walks", comparison.shared_walks).set("rescored", number(comparison.rescored));
  Tree methods = Tree::map();
  for (const ComparedMethod& method : comparison.methods) {
    Tree values = Tree::list();
    for (const ComparedValue& value : method.values) values.push(tree_of(value));
    methods.set(method.name, Tree::map()
                                 .set("pairs", number(method.pairs))
                                 .set("failed_walks", number(method.failed))
                                 .set("same", method.same)
                                 .set("values", std::move(values)));
  }
  return tree.set("methods", std::move(methods));
}

}  // namespace plumbline::scenarios
