// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/results_tables.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"
#include "scenarios/score/moment.h"

namespace plumbline::scenarios {

namespace {

double limit_of(const Tree& gate) { return number_of(&gate, "limit").value_or(0.0); }

std::string value_text(const Tree& gate) {
  const auto value = number_of(&gate, "value");
  return value ? score::gate_value(*value, limit_of(gate)) : "absent";
}

std::string limit_text(const Tree& gate) {
  return svg::escape(text_of(gate, "op")) + " " + format_number(limit_of(gate));
}

/// A text about a gate, as a link to the replay page at the moment at which its method failed, where there is one.
std::string linked(const Tree& gate, const std::string& text) {
  const std::string see = text_of(gate, "see");
  return see.empty() ? svg::escape(text) : "<a href=\"" + svg::escape(see) + "\">" + svg::escape(text) + "</a>";
}

/// Every scalar of a tree as rows "a.b.c = value".
void flatten(const Tree& tree, const std::string& prefix, std::vector<std::pair<std::string, std::string>>& rows) {
  if (tree.is_map()) {
    for (const auto& [key, child] : tree.as_map()) flatten(child, prefix.empty() ? key : prefix + "." + key, rows);
  } else if (tree.is_scalar()) {
    if (const auto* d = std::get_if<double>(&tree.value))
      rows.emplace_back(prefix, svg::number(*d, 4));
    else if (const auto* s = std::get_if<std::string>(&tree.value))
      rows.emplace_back(prefix, *s);
    else
      rows.emplace_back(prefix, write_json(tree, 0));
  }
}

}  // namespace

std::string failed_gates(const ReportInput& input) {
  constexpr std::size_t most = 6;
  std::string out;
  std::size_t failed = 0;
  const Tree* gates = input.results.find("gates");
  for (const Tree& gate : gates == nullptr ? Tree::List() : gates->as_list()) {
    if (gate.find("passed")->as_bool() || ++failed > most) continue;
    const std::string reason = text_of(gate, "reason");
    out += "<li>" + linked(gate, text_of(gate, "metric") + " of " + text_of(gate, "method")) + ": " + value_text(gate) +
           ", must be " + limit_text(gate) + (reason.empty() ? "" : "; " + svg::escape(reason)) + "</li>";
  }
  if (failed > most) out += "<li>and " + std::to_string(failed - most) + " more, under Gates</li>";
  return failed == 0 ? "" : "<ul class=\"failed\" aria-label=\"gates that failed\">" + out + "</ul>";
}

std::string gates_table(const ReportInput& input) {
  const Tree* gates = input.results.find("gates");
  if (gates == nullptr || gates->as_list().empty()) return "";
  std::string out =
      "<section class=\"card\"><h2>Gates</h2><div class=\"scroll\"><table class=\"stacked\" aria-label=\"gates\"><tr "
      "class=\"heads\"><th>gate</th><th>method</th>"
      "<th class=\"num\">value</th><th class=\"num\">limit</th><th></th></tr>";
  for (const Tree& gate : gates->as_list()) {
    const bool passed = gate.find("passed")->as_bool();
    out += "<tr><td>" + linked(gate, text_of(gate, "metric")) + "</td><td data-head=\"method\">" +
           svg::escape(text_of(gate, "method")) + "</td><td class=\"num\" data-head=\"value\">" + value_text(gate) +
           "</td><td class=\"num\" data-head=\"limit\">" + limit_text(gate) + "</td><td class=\"verdict " +
           (passed ? "good\">passed" : "bad\">failed") + "</td></tr>";
  }
  return out + "</table></div></section>";
}

std::string numbers_table(const ReportInput& input) {
  std::vector<std::string> keys;
  std::vector<std::vector<std::pair<std::string, std::string>>> columns;
  for (const auto& method : input.methods) {
    auto& column = columns.emplace_back();
    if (const Tree* results = results_of(input, method.name)) flatten(*results, "", column);
    for (const auto& [key, value] : column)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  std::string out =
      "<details class=\"card fold\" open><summary>All numbers</summary><div class=\"scroll\"><table class=\"stacked\" "
      "aria-label=\"all "
      "numbers\"><tr "
      "class=\"heads\"><th></th>";
  for (const auto& method : input.methods) out += "<th class=\"num\">" + svg::escape(method.name) + "</th>";
  out += "</tr>";
  for (const std::string& key : keys) {
    out += "<tr><td>" + svg::breakable(key) + "</td>";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto& column = columns[i];
      const auto it = std::find_if(column.begin(), column.end(), [&](const auto& row) { return row.first == key; });
      out += "<td class=\"num" + std::string(it == column.end() ? " none" : "") + "\" data-head=\"" +
             svg::escape(input.methods[i].name) + "\">" +
             (it == column.end() ? std::string("–") : svg::escape(it->second)) + "</td>";
    }
    out += "</tr>";
  }
  return out + "</table></div></details>";
}

}  // namespace plumbline::scenarios
