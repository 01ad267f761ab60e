// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report.h"

#include <algorithm>

#include "bim/config/tree.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/error_plots.h"
#include "scenarios/report/glossary.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/method_cards.h"
#include "scenarios/report/page.h"
#include "scenarios/report/page_data.h"
#include "scenarios/report/results.h"
#include "scenarios/report/results_tables.h"
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
