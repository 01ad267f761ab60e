// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "bim/config/tree.h"
#include "scenarios/metrics/state_names.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/glossary.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/page.h"
#include "scenarios/report/plot.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"
#include "scenarios/report/walk_list.h"

namespace plumbline::scenarios {

namespace {

std::string centimetres(double metres) { return svg::number(100.0 * metres, 1) + " cm"; }

struct GateCount {
  std::size_t passed = 0, all = 0;
};

/// Of one method, or of all where `method` is empty.
GateCount gates_of(const ReportInput& input, const std::string& method) {
  GateCount count;
  const Tree* gates = input.results.find("gates");
  if (gates == nullptr) return count;
  for (const Tree& gate : gates->as_list()) {
    if (!method.empty() && text_of(gate, "method") != method) continue;
    ++count.all;
    if (gate.find("passed")->as_bool()) ++count.passed;
  }
  return count;
}

/// A method's gates decide on its colour. Without any a verdict that says something of the answer does: `complete` does
/// not.
std::string judged(const ReportInput& input, const std::string& method, const std::string& verdict) {
  const GateCount gates = gates_of(input, method);
  if (gates.passed < gates.all) return "bad";
  if (verdict == "success" || verdict == "honest_ambiguity") return "good";
  if (verdict != "complete") return "bad";
  return gates.all > 0 ? "good" : "open";
}

std::string gates_sentence(const ReportInput& input, const std::string& method) {
  const GateCount gates = gates_of(input, method);
  if (gates.all == 0) return "No gate judges it.";
  return std::to_string(gates.passed) + " of " + std::to_string(gates.all) +
         (gates.all == 1 ? " gate passed." : " gates passed.");
}

/// ", since ... (at 12.3 s)", or nothing.
std::string why_it_failed(const Tree* where) {
  const std::string failure = where == nullptr ? "" : text_of(*where, "failure");
  std::string why;
  if (failure == "never_sampled") why = "the true pose was never among the hypotheses";
  if (failure == "depleted") why = "the true pose dropped out of the hypotheses";
  if (failure == "twin_preferred") why = "a pose aliased with the true one at the start was preferred";
  if (failure == "wrong_model") why = "a pose not aliased with the true one was preferred";
  if (failure == "tracking_lost") why = "the right pose was lost again";
  if (failure == "undecided") why = "the true pose remained one of several to the end";
  if (why.empty()) return "";
  const auto at = number_of(where, "failure_at_s");
  return ", since " + why + (at ? " (at " + svg::number(*at, 1) + " s)" : "");
}

/// What came of a kidnapping, as sentences of their own, or nothing. Durations and times of the run stand apart.
std::string after_kidnap(const ReportInput& input, const Tree* where) {
  const auto wrong = number_of(where, "kidnap_wrong_s");
  if (!wrong || !input.kidnap) return "";
  const auto found = number_of(where, "kidnap_found_s");
  const double down_s = input.kidnap->set_down_s;
  const std::string text =
      " Kidnapped at t = " + svg::number(input.kidnap->lifted_s, 1) + " s, set down at t = " + svg::number(down_s, 1) +
      " s. From there on " +
      (*wrong > 0.0 ? "a wrong answer stood for up to " + svg::number(*wrong, 1) + " s" : "it gave no wrong answer");
  return text + (found ? ", and it was localized again at t = " + svg::number(down_s + *found, 1) + " s, " +
                             svg::number(*found, 1) + " s after it was set down."
                       : ", and it was not localized again for good.");
}

/// What a plan localization did; `where` is its block of numbers, may be null.
std::string place_sentence(const std::string& verdict, const Tree* where) {
  const auto time = number_of(where, "converged_at_s");
  const auto error = number_of(where, "ape_rmse_m");
  const auto places = number_of(where, "hypotheses");
  if (verdict == "honest_ambiguity" && places)
    return "Kept " + svg::number(*places, 0) + " hypotheses, rightly: the scans do not distinguish them.";
  if (verdict == "overconfident") return "Converged on one pose though several explain the scans.";
  if (!time) return "Never converged on one pose in the building" + why_it_failed(where) + ".";
  if (verdict == "lucky") return "Converged on the right pose before the scans distinguished it from others.";
  if (verdict == "false_convergence") return "Converged on a wrong pose" + why_it_failed(where) + ".";
  const std::string failure = text_of(*where, "failure");
  if (verdict == "lost")
    return "Converged after " + svg::number(*time, 1) + " s and lost the pose later" + why_it_failed(where) + ".";
  if (verdict == "late" && failure != "undecided")
    return "Converged after " + svg::number(*time, 1) + " s and withdrew its answer" + why_it_failed(where) + ".";
  std::string text = "Converged on the right pose after " + svg::number(*time, 1) + " s";
  if (error) text += ", with an error of " + centimetres(*error) + " from then on (rms)";
  return text + (verdict == "late" ? "; too late to count: an answer must hold for 5 s and 1 m." : ".");
}

/// What happened, in a sentence or two.
std::string sentence(const ReportInput& input, const ReportMethod& method, const Tree* results) {
  const std::string verdict = results == nullptr ? "" : text_of(*results, "verdict");
  if (verdict == "crashed") return "The method stopped with an error.";
  if (method.localization) {
    const Tree* where = results == nullptr ? nullptr : results->find("localization");
    const bool by_furniture = where != nullptr && where->find("evidence_by_furniture") != nullptr;
    return place_sentence(verdict, where) + after_kidnap(input, where) +
           (by_furniture ? " Only furniture tells these apart." : "");
  }
  const auto error = number_of(results, "ate_aligned_rmse_m");
  if (!error) return "No trajectory that could be scored.";
  std::string text = "Position error " + centimetres(*error) + " rms after alignment";
  const Tree* rooms = results->find("rooms");
  const auto visited = number_of(rooms, "visited");
  const auto recall = number_of(rooms, "recall");
  if (visited && recall)
    text += "; recognised " + svg::number(*recall * *visited, 0) + " of the " + svg::number(*visited, 0) +
            " rooms it was in";
  return text + ".";
}

std::vector<ReportDeviation> all_deviations(const ReportInput& input) {
  std::vector<ReportDeviation> all;
  for (const ReportStorey& storey : input.storeys)
    all.insert(all.end(), storey.deviations.begin(), storey.deviations.end());
  return all;
}

std::string method_cards(const ReportInput& input) {
  std::string out;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    const ReportMethod& method = input.methods[i];
    if (is_truth(method)) continue;
    const Tree* results = results_of(input, method.name);
    const std::string verdict = results == nullptr ? "" : text_of(*results, "verdict");
    const std::string name = svg::escape(method.name);
    out += "<div class=\"method\" style=\"border-color:" + colour(i) +
           "\"><h3><label><input type=\"checkbox\" checked data-layer=\"" + name + "\"> " + name +
           "</label> <button type=\"button\" class=\"only\" data-only=\"" + name +
           "\">only</button> <span class=\"verdict " + judged(input, method.name, verdict) + "\">" +
           svg::escape(verdict) + "</span></h3><p>" + svg::escape(sentence(input, method, results)) + "</p><p>" +
           gates_sentence(input, method.name) + "</p><p id=\"now-" + name + "\"></p></div>";
  }
  return out;
}

/// What methods were told of the furniture, and how it was built; nothing where there is none.
std::string told_text(const ReportInput& input) {
  const Tree* told = input.results.find("told");
  if (told == nullptr) return "";
  std::string world = text_of(*told, "world_furniture");
  std::replace(world.begin(), world.end(), '_', ' ');
  const bool none = text_of(*told, "plan_furniture") == "none";
  return " · furniture in the methods' plan: " + std::string(none ? "none" : "as planned") +
         ", as built: " + svg::escape(world);
}

std::string header(const ReportInput& input) {
  const GateCount gates = gates_of(input, "");
  const std::size_t count = gates.all, failed = gates.all - gates.passed;
  std::string badge = "<span class=\"badge\">no gates</span>";
  if (count > 0 && failed == 0) badge = "<span class=\"badge good\">PASS</span>";
  if (failed > 0)
    badge = "<span class=\"badge bad\">FAIL</span> <span>" + std::to_string(failed) + " of " + std::to_string(count) +
            (count == 1 ? " gate failed</span>" : " gates failed</span>");
  const Tree* results = &input.results;
  if (const Tree* failure = input.results.find("failure"))
    badge +=
        " <span class=\"badge bad\">the scenario failed</span> <span>" + svg::escape(failure->as_string()) + "</span>";
  std::string facts = "seed " + svg::escape(text_of(input.results, "seed"));
  if (const auto d = number_of(results, "duration_s")) facts += " · " + svg::number(*d, 1) + " s";
  if (const auto d = number_of(results, "distance_m")) facts += " · " + svg::number(*d, 1) + " m walked";
  facts += told_text(input);
  return "<header><h1>" + svg::escape(text_of(input.results, "scenario")) + "</h1>" + badge + "<span class=\"facts\">" +
         facts + "</span></header>";
}

/// Four digits, however small the value is.
std::string few_digits(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4).ptr;
  return {text.data(), end};
}

std::string gates_table(const ReportInput& input) {
  const Tree* gates = input.results.find("gates");
  if (gates == nullptr || gates->as_list().empty()) return "";
  std::string out =
      "<section class=\"card\"><h2>Gates</h2><div class=\"scroll\"><table><tr><th>gate</th><th>method</th>"
      "<th class=\"num\">value</th><th class=\"num\">limit</th><th></th></tr>";
  for (const Tree& gate : gates->as_list()) {
    const bool passed = gate.find("passed")->as_bool();
    const auto value = number_of(&gate, "value");
    out += "<tr><td>" + svg::escape(text_of(gate, "metric")) + "</td><td>" + svg::escape(text_of(gate, "method")) +
           "</td><td class=\"num\">" + (value ? few_digits(*value) : "absent") + "</td><td class=\"num\">" +
           svg::escape(text_of(gate, "op")) + " " + format_number(number_of(&gate, "limit").value_or(0.0)) +
           "</td><td class=\"verdict " + (passed ? "good\">passed" : "bad\">failed") + "</td></tr>";
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
  std::string out = "<section class=\"card\"><h2>All numbers</h2><div class=\"scroll\"><table><tr><th></th>";
  for (const auto& method : input.methods) out += "<th class=\"num\">" + svg::escape(method.name) + "</th>";
  out += "</tr>";
  for (const std::string& key : keys) {
    out += "<tr><td>" + svg::escape(key) + "</td>";
    for (const auto& column : columns) {
      const auto it = std::find_if(column.begin(), column.end(), [&](const auto& row) { return row.first == key; });
      out += "<td class=\"num\">" + (it == column.end() ? std::string("–") : svg::escape(it->second)) + "</td>";
    }
    out += "</tr>";
  }
  return out + "</table></div></section>";
}

Tree track(const std::vector<ReportSample>& samples, bool with_error) {
  Tree t = Tree::list();
  Tree x = Tree::list();
  Tree y = Tree::list();
  Tree yaw = Tree::list();
  Tree storey = Tree::list();
  Tree error = Tree::list();
  Tree lost = Tree::list();
  const auto rounded = [](double v, double unit) { return Tree(std::round(v / unit) * unit); };
  for (const auto& sample : samples) {
    t.push(rounded(sample.t_s, 0.01));
    x.push(rounded(sample.x, 0.001));
    y.push(rounded(sample.y, 0.001));
    yaw.push(rounded(sample.yaw, 0.001));
    storey.push(sample.storey);
    error.push(rounded(sample.error_m, 0.0001));
    lost.push(sample.lost ? 1 : 0);
  }
  Tree out = Tree::map();
  out.set("t", std::move(t))
      .set("x", std::move(x))
      .set("y", std::move(y))
      .set("yaw", std::move(yaw))
      .set("s", std::move(storey));
  if (with_error) out.set("e", std::move(error)).set("lost", std::move(lost));
  return out;
}

/// [[since t, state], ...]
Tree state_changes(const std::vector<ReportState>& states) {
  Tree list = Tree::list();
  std::optional<slam::State> before;
  for (const ReportState& state : states)
    if (std::exchange(before, state.state) != state.state)
      list.push(Tree(Tree::List{Tree(std::round(100.0 * state.t_s) / 100.0), Tree(state_name(state.state))}));
  return list;
}

std::string script_data(const ReportInput& input, double end_s) {
  Tree tracks = Tree::map();
  tracks.set("truth", track(input.truth, false));
  for (const auto& method : input.methods)
    if (!is_truth(method)) tracks.set(method.name, track(method.samples, true));
  Tree plot = Tree::map();
  plot.set("x0", plot_frame.x0).set("x1", plot_frame.x1).set("w", plot_frame.width);
  Tree states = Tree::map();
  for (const auto& method : input.methods)
    if (!method.states.empty()) states.set(method.name, state_changes(method.states));
  Tree data = Tree::map();
  data.set("states", std::move(states));
  data.set("end", end_s).set("plot", std::move(plot)).set("tracks", std::move(tracks));
  std::string json = write_json(data, 0);
  // "</" would end the script element.
  for (std::size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3) json.replace(at, 2, "<\\/");
  return json;
}

/// How many poses are consistent with the scans, over time.
PlotCurve consistent_poses(const ReportInput& input, double end_s) {
  PlotCurve curve{"consistent poses", "#5d6b7c", {}, "truth"};
  const Tree* known = input.results.find("identifiability");
  if (known == nullptr) return curve;
  constexpr double step_s = 0.5;  // a curve with larger gaps would be drawn open
  const Tree::List& places = known->find("places")->as_list();
  if (input.kidnap) end_s = std::min(end_s, input.kidnap->lifted_s);  // it is computed up to there
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double until = i + 1 < places.size() ? places[i + 1].find("t_s")->as_double() : end_s;
    for (double t = places[i].find("t_s")->as_double(); t <= until; t += step_s)
      curve.points.emplace_back(t, 1.0 + places[i].find("twins")->as_double());
  }
  return curve;
}

std::string identifiability_sentence(const Tree& known) {
  std::string text = "the scans never distinguished the true pose from all others.";
  if (const auto at = number_of(&known, "at_s"))
    text = *at <= 0.0 ? "identifiable from the first scan on."
                      : "identifiable after " + svg::number(*at, 1) + " s and " +
                            svg::number(number_of(&known, "at_m").value_or(0.0), 1) + " m.";
  if (const Tree* element = known.find("decided_by"))
    text += " Decided by " + text_of(*element, "element") +
            (element->find("missing")->as_bool() ? ", which would be visible from the last aliased pose and was not."
                                                 : ", which was visible and would not be from the last aliased pose.");
  return text;
}

std::string identifiability_text(const ReportInput& input) {
  const Tree* known = input.results.find("identifiability");
  if (known == nullptr) return "";
  const auto line = [](const std::string& text) { return "<p class=\"facts\">" + svg::escape(text) + "</p>"; };
  const Tree* with_furniture = known->find("with_furniture");
  std::string out = line("By the building alone: " + identifiability_sentence(*known));
  if (with_furniture != nullptr)
    out += line("With the furniture as planned: " + identifiability_sentence(*with_furniture));
  const bool by_furniture = with_furniture != nullptr && number_of(with_furniture, "at_s") && !number_of(known, "at_s");
  return by_furniture ? out + line("Only furniture tells these apart; it may have moved.") : out;
}

std::string plots(const ReportInput& input, double end_s) {
  std::vector<PlotCurve> curves;
  std::vector<PlotCurve> counts;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    if (is_truth(input.methods[i])) continue;
    PlotCurve curve{input.methods[i].name, colour(i), {}}, lost{"", colour(i), {}, input.methods[i].name, true};
    for (const auto& sample : input.methods[i].samples)
      (sample.lost ? lost : curve).points.emplace_back(sample.t_s, 100.0 * sample.error_m);
    curves.push_back(std::move(curve));
    if (!lost.points.empty()) curves.push_back(std::move(lost));
    PlotCurve count{input.methods[i].name, colour(i), {}};
    for (const auto& state : input.methods[i].states) count.points.emplace_back(state.t_s, state.hypotheses);
    if (!count.points.empty()) counts.push_back(std::move(count));
  }
  if (PlotCurve possible = consistent_poses(input, end_s); !counts.empty() && !possible.points.empty())
    counts.push_back(std::move(possible));
  std::string out =
      "<section class=\"card\"><h2>Position error over time</h2>" +
      draw_plot("errors", curves, end_s, {common_marks(input), {}, 0.0, false, "position error, cm"}) +
      "<p class=\"facts\">Point at it for values, click to jump there. Triangles: beyond the scale. Dotted: "
      "the method says that it is lost.</p></section>";
  if (!counts.empty())
    out += "<section class=\"card\"><h2>Hypotheses over time</h2>" +
           draw_plot("hypotheses", counts, end_s, {common_marks(input), {}, 0.0, true, "poses"}) +
           identifiability_text(input) + "</section>";
  return out;
}

}  // namespace

std::string render_report(const ReportInput& input) {
  const MapBox box = bounds(input);
  const double end_s = input.truth.empty() ? 0.0 : input.truth.back().t_s;
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
      svg::escape(text_of(input.results, "scenario")) + " · Plumbline</title><style>";
  page += page_style();
  page += "</style></head>\n<body><main>" + header(input);
  page += "<div class=\"top\"><section class=\"card\">" + draw_maps(input, box) + map_key() +
          "<div class=\"controls\"><button id=\"play\" type=\"button\">Play</button>"
          "<input id=\"time\" type=\"range\" min=\"0\" max=\"1\" step=\"0.1\" aria-label=\"time\">"
          "<span class=\"clock\" id=\"clock\"></span></div></section><aside class=\"card\">" +
          method_cards(input) + "</aside></div>\n";
  page += list_walk(input.results.find("walk")) + "\n";
  page += plots(input, end_s) + "\n" + list_deviations(all_deviations(input)) + "\n" + draw_beliefs(input, box, end_s) +
          "\n" + gates_table(input) + "\n" + numbers_table(input);
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
