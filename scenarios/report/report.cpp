// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/config/tree.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/error_plots.h"
#include "scenarios/report/glossary.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/method_cards.h"
#include "scenarios/report/page.h"
#include "scenarios/report/page_data.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"
#include "scenarios/report/walk_list.h"
#include "scenarios/score/moment.h"

namespace plumbline::scenarios {

namespace {

std::vector<ReportDeviation> all_deviations(const ReportInput& input) {
  std::vector<ReportDeviation> all;
  for (const ReportStorey& storey : input.storeys)
    all.insert(all.end(), storey.deviations.begin(), storey.deviations.end());
  return all;
}

/// " · building moved by -487659, -5412349, 0 m" where its file is in map coordinates.
std::string moved_text(const ReportInput& input) {
  const Tree* building = input.results.find("building");
  const Tree* moved = building != nullptr ? building->find("moved_by_m") : nullptr;
  if (moved == nullptr) return "";
  std::string numbers;
  for (const Tree& number : moved->as_list())
    numbers += (numbers.empty() ? "" : ", ") + svg::number(number.as_double(), 0);
  return " · building moved by " + numbers + " m from its file's coordinates";
}

/// What methods were told of the furniture, and how it was built; nothing where there is none.
std::string told_text(const ReportInput& input) {
  const Tree* told = input.results.find("told");
  if (told == nullptr) return "";
  std::string world = text_of(*told, "world_furniture");
  std::replace(world.begin(), world.end(), '_', ' ');
  const bool none = text_of(*told, "plan_furniture") == "none";
  return " · the methods' plan " + std::string(none ? "has no furniture" : "has the furniture as planned") +
         "; in the building: " + svg::escape(world);
}

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

/// What failed and by how much, where it is seen first.
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

/// What the scenario makes go wrong, so that nobody looks for it in a method.
std::string injected(const Tree& results) {
  std::string all;
  const Tree* list = results.find("injected");
  for (const Tree& fault : list == nullptr ? Tree::List() : list->as_list())
    all += (all.empty() ? "" : "; ") + fault.as_string();
  return all.empty() ? "" : "<p class=\"injected\"><b>Injected faults:</b> " + svg::escape(all) + "</p>";
}

std::string header(const ReportInput& input) {
  const GateCount gates = gates_of(input.results, "");
  const std::size_t count = gates.all, failed = gates.all - gates.passed;
  std::string badge = "<span class=\"badge\">no gates</span>";
  if (count > 0 && failed == 0)
    badge = "<span class=\"badge good\">PASS</span> <span>" + std::to_string(count) +
            (count == 1 ? " gate</span>" : " gates</span>");
  if (failed > 0)
    badge = "<span class=\"badge bad\">FAIL</span> <span>" + std::to_string(failed) + " of " + std::to_string(count) +
            (count == 1 ? " gate failed</span>" : " gates failed</span>");
  const Tree* results = &input.results;
  if (const Tree* failure = input.results.find("failure"))
    badge +=
        " <span class=\"badge bad\">the scenario failed</span> <span>" + svg::escape(failure->as_string()) + "</span>";
  for (const Unjudged& method : unjudged(input.results))
    badge += input.has_replay ? " <a class=\"badge bad\" href=\"replay.html#m=" + score::in_link(method.method) +
                                    "\">" + svg::escape(method.text()) + "</a>"
                              : " <span class=\"badge bad\">" + svg::escape(method.text()) + "</span>";
  std::string facts = "seed " + svg::escape(text_of(input.results, "seed"));
  if (const auto d = number_of(results, "duration_s")) facts += " · " + svg::number(*d, 1) + " s";
  if (const auto d = number_of(results, "distance_m")) facts += " · " + svg::number(*d, 1) + " m walked";
  facts += told_text(input) + moved_text(input);
  return "<header><h1>" + svg::escape(text_of(input.results, "scenario")) + "</h1>" + badge + "<span class=\"facts\">" +
         facts + "</span>" + (input.has_replay ? "<a href=\"replay.html\">replay in three dimensions</a>" : "") +
         "</header>" + injected(input.results) + failed_gates(input);
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

}  // namespace

std::string render_report(const ReportInput& input) {
  const MapBox box = bounds(input);
  const double end_s = input.truth.empty() ? 0.0 : input.truth.back().t_s;
  std::string page = open_page(text_of(input.results, "scenario")) + header(input);
  page += "<div class=\"top\"><section class=\"card\">" + draw_maps(input, box) + map_key(input) +
          "<div class=\"controls\"><button id=\"play\" type=\"button\">Play</button>"
          "<input id=\"time\" type=\"range\" min=\"0\" max=\"1\" step=\"0.1\" aria-label=\"time\">"
          "<span class=\"clock\" id=\"clock\"></span><label><input type=\"checkbox\" id=\"byerror\"> error along the "
          "paths</label></div></section><aside class=\"card\">" +
          method_cards(input) + "</aside></div>\n";
  page += list_walk(input.results.find("walk")) + "\n";
  page += draw_errors(input, end_s) + draw_hypothesis_counts(input, end_s) + "\n";
  page += list_deviations(all_deviations(input)) + "\n" + draw_beliefs(input, box, end_s) + "\n" + gates_table(input) +
          "\n" + numbers_table(input);
  page += "<details class=\"card\"><summary>What was simulated</summary><pre><code>" +
          svg::escape(input.results.find("sensors") == nullptr ? "" : write_yaml(*input.results.find("sensors"))) +
          "digest: " + svg::escape(text_of(input.results, "digest")) + "\n</code></pre></details>" + glossary() +
          "</main>\n";
  page += "<script type=\"application/json\" id=\"data\">" + script_data(input, end_s) + "</script>\n<script>";
  page += map_script();
  page += page_script();
  return page + "</script></body></html>\n";
}

}  // namespace plumbline::scenarios
