// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/report/page.h"
#include "scenarios/report/plot.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

// Colours that stay apart for colour-blind readers (Okabe and Ito), in the order of the methods.
constexpr std::array<std::string_view, 6> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b58900", "#56b4e9"};

std::string colour(std::size_t method) { return std::string(colours[method % colours.size()]); }

std::string text_of(const Tree& map, std::string_view key) {
  const Tree* value = map.find(key);
  return value == nullptr ? "" : value->as_string();
}

std::optional<double> number_of(const Tree* map, std::string_view key) {
  const Tree* value = map == nullptr ? nullptr : map->find(key);
  if (value == nullptr || !value->is_scalar()) return std::nullopt;
  return value->as_double();
}

const Tree* results_of(const ReportInput& input, const std::string& method) {
  const Tree* methods = input.results.find("methods");
  return methods == nullptr ? nullptr : methods->find(method);
}

std::string centimetres(double metres) { return svg::number(100.0 * metres, 1) + " cm"; }

/// The row that checks the scorer; it would lie under everything it is compared with.
bool is_truth(const ReportMethod& method) { return method.name == "truth"; }

bool is_good(const std::string& verdict) {
  return verdict == "ok" || verdict == "success" || verdict == "honest_ambiguity";
}

/// What happened, in one sentence that needs no glossary.
std::string sentence(const ReportMethod& method, const Tree* results) {
  const std::string verdict = results == nullptr ? "" : text_of(*results, "verdict");
  if (verdict == "crashed") return "The method stopped with an error.";
  if (method.localization) {
    const Tree* where = results == nullptr ? nullptr : results->find("localization");
    const auto time = number_of(where, "converged_at_s");
    const auto error = number_of(where, "ape_rmse_m");
    const auto places = number_of(where, "hypotheses");
    if (verdict == "honest_ambiguity" && places)
      return "Kept " + svg::number(*places, 0) + " places in mind, rightly: what was seen does not tell them apart.";
    if (verdict == "overconfident") return "Settled on one place though what was seen fits several.";
    if (!time) return "Never settled on one place in the building.";
    if (verdict == "lucky") return "Settled on the right place before anything seen could tell it from another.";
    if (verdict == "false_convergence") return "Settled on a wrong place.";
    std::string text = "Knew its place in the building after " + svg::number(*time, 1) + " s";
    if (error) text += " and was " + centimetres(*error) + " off from then on (rms)";
    return text + ".";
  }
  const auto error = number_of(results, "ate_aligned_rmse_m");
  if (!error) return "No trajectory that could be scored.";
  std::string text = "Its path is " + centimetres(*error) + " off the true one (rms, after alignment)";
  const Tree* rooms = results->find("rooms");
  const auto visited = number_of(rooms, "visited");
  const auto matched = number_of(rooms, "matched");
  if (visited && matched)
    text += "; recognised " + svg::number(*matched, 0) + " of " + svg::number(*visited, 0) + " rooms";
  return text + ".";
}

/// Wall segments of a face without its openings, as strokes.
std::string face_strokes(const bim::PlanFace& face) {
  const double length = (face.p1 - face.p0).norm();
  if (length <= 0.0) return "";
  const Eigen::Vector2d e = (face.p1 - face.p0) / length;
  std::vector<std::pair<double, double>> gaps;
  for (const auto& hole : face.holes)
    if (hole.z0 < face.z0 + 0.3) gaps.emplace_back(hole.s0, hole.s1);
  std::sort(gaps.begin(), gaps.end());
  std::string out;
  double s = 0.0;
  const auto stroke = [&](double s0, double s1) {
    if (s1 > s0) out += svg::line(face.p0 + s0 * e, face.p0 + s1 * e, "class=\"wall\"");
  };
  for (const auto& [s0, s1] : gaps) {
    stroke(s, s0);
    s = std::max(s, s1);
  }
  stroke(s, length);
  return out;
}

struct Box {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d max = Eigen::Vector2d::Constant(-1e9);
  void add(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

Box bounds(const ReportInput& input) {
  Box box;
  for (const auto& face : input.plan.faces) {
    if (face.storey != input.storey) continue;
    box.add(face.p0);
    box.add(face.p1);
  }
  for (const auto& sample : input.truth) box.add({sample.x, sample.y});
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.5);
  return {box.min - margin, box.max + margin};
}

std::string open_map(const Box& box, const std::string& label) {
  const Eigen::Vector2d size = box.max - box.min;
  return "<svg class=\"map\" role=\"img\" aria-label=\"" + svg::escape(label) + "\" viewBox=\"" +
         svg::number(box.min.x()) + " " + svg::number(-box.max.y()) + " " + svg::number(size.x()) + " " +
         svg::number(size.y()) + "\">";
}

std::string draw_plan(const ReportInput& input) {
  std::string out;
  for (const auto& room : input.plan.rooms)
    if (room.storey == input.storey) out += svg::polygon(room.polygon, "class=\"room\"");
  for (const auto& face : input.plan.faces)
    if (face.storey == input.storey) out += face_strokes(face);
  return out;
}

/// Names stand in the upper left corner of their rooms, away from most paths.
std::string room_names(const ReportInput& input) {
  std::string out;
  for (const auto& room : input.plan.rooms) {
    if (room.storey != input.storey || room.name.size() > 18) continue;
    Eigen::Vector2d corner(1e9, -1e9);
    for (const auto& p : room.polygon) corner = {std::min(corner.x(), p.x()), std::max(corner.y(), p.y())};
    out += svg::text(corner + Eigen::Vector2d(0.3, -0.6), room.name, "");
  }
  return out;
}

std::vector<Eigen::Vector2d> path_of(const std::vector<ReportSample>& samples) {
  std::vector<Eigen::Vector2d> path;
  for (const auto& sample : samples) path.emplace_back(sample.x, sample.y);
  return path;
}

std::string robot_mark(const std::string& name, const std::string& fill) {
  return "<path id=\"robot-" + svg::escape(name) + "\" d=\"M.36 0L-.22 -.2L-.12 0L-.22 .2Z\" fill=\"" + fill +
         "\" stroke=\"#fff\" stroke-width=\".04\"/>";
}

std::string draw_structure(const ReportMethod& method, const std::string& c) {
  std::string out;
  for (const auto& room : method.rooms)
    out += svg::polygon(room.polygon_W, room.matched ? "class=\"foundroom\" fill=\"" + c + "\" stroke=\"" + c + "\""
                                                     : std::string("class=\"foundroom invented\""));
  for (const auto& wall : method.walls) out += svg::line(wall.p0, wall.p1, "class=\"found\" stroke=\"" + c + "\"");
  return out;
}

std::string draw_method(const ReportMethod& method, std::size_t index) {
  const std::string c = colour(index);
  std::string out = "<g class=\"layer-" + svg::escape(method.name) + "\">";
  // What a localization finds are the plan's own walls and rooms, which are drawn already.
  if (!method.localization) out += draw_structure(method, c);
  out += svg::polyline(path_of(method.samples), "class=\"path\" stroke=\"" + c + "\"");
  return out + robot_mark(method.name, c) + "</g>";
}

std::string draw_map(const ReportInput& input, const Box& box) {
  std::string out = open_map(box, "floor plan with the true and the estimated paths") + draw_plan(input) +
                    draw_deviations(input.deviations);
  for (std::size_t i = 0; i < input.methods.size(); ++i)
    if (!is_truth(input.methods[i])) out += draw_method(input.methods[i], i);
  out += room_names(input) + svg::polyline(path_of(input.truth), "class=\"truth\"") + robot_mark("truth", "#111");
  return out + "</svg>";
}

std::string map_key() {
  const auto item = [](const std::string& stroke, const std::string& label) {
    return "<span><svg viewBox=\"0 0 34 10\"><line x1=\"1\" y1=\"5\" x2=\"33\" y2=\"5\" " + stroke + "/></svg>" +
           label + "</span>";
  };
  return "<div class=\"key\">" + item("stroke=\"#39424e\" stroke-width=\"3\"", "wall of the building") +
         item("stroke=\"#111\" stroke-width=\"2\" stroke-dasharray=\"5 4\"", "where the robot truly walked") +
         item("stroke=\"#0072b2\" stroke-width=\"2\"", "where a method says it walked (its colour)") +
         item("stroke=\"#0072b2\" stroke-width=\"4\" stroke-opacity=\".8\"", "wall a method found") +
         "<span>tinted area: room a method found (red: there is none)</span></div>";
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
           "</label> <span class=\"verdict " + (is_good(verdict) ? "good" : "bad") + "\">" + svg::escape(verdict) +
           "</span></h3><p>" + svg::escape(sentence(method, results)) + "</p><p id=\"now-" + name + "\"></p></div>";
  }
  return out;
}

std::string header(const ReportInput& input) {
  const Tree* gates = input.results.find("gates");
  std::size_t failed = 0;
  std::size_t count = 0;
  if (gates != nullptr)
    for (const Tree& gate : gates->as_list()) {
      ++count;
      failed += gate.find("passed")->as_bool() ? 0U : 1U;
    }
  std::string badge = "<span class=\"badge\">no gates</span>";
  if (count > 0 && failed == 0) badge = "<span class=\"badge good\">PASS</span>";
  if (failed > 0)
    badge = "<span class=\"badge bad\">FAIL</span> <span>" + std::to_string(failed) + " of " + std::to_string(count) +
            " gates failed</span>";
  const Tree* results = &input.results;
  std::string facts = "seed " + svg::escape(text_of(input.results, "seed"));
  if (const auto d = number_of(results, "duration_s")) facts += " · " + svg::number(*d, 1) + " s";
  if (const auto d = number_of(results, "distance_m")) facts += " · " + svg::number(*d, 1) + " m walked";
  return "<header><h1>" + svg::escape(text_of(input.results, "scenario")) + "</h1>" + badge + "<span class=\"facts\">" +
         facts + "</span></header>";
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
           "</td><td class=\"num\">" + (value ? svg::number(*value, 4) : "absent") + "</td><td class=\"num\">" +
           svg::escape(text_of(gate, "op")) + " " + svg::number(number_of(&gate, "limit").value_or(0.0), 4) +
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

std::string beliefs(const ReportInput& input, const Box& box) {
  std::string out;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    const ReportMethod& method = input.methods[i];
    if (method.beliefs.empty()) continue;
    out += "<section class=\"card\"><h2>Where " + svg::escape(method.name) +
           " thought the robot could be</h2><div class=\"beliefs\">";
    for (const auto& belief : method.beliefs) {
      out += "<div><p>" + svg::escape(belief.label) + ", " + svg::number(belief.t_s, 1) + " s</p>" +
             open_map(box, "particles at " + belief.label) + draw_plan(input);
      for (const auto& particle : belief.particles)
        out += svg::circle({particle.x, particle.y}, 0.09, "fill=\"" + colour(i) + "\" fill-opacity=\".55\"");
      out += svg::circle(belief.truth, 0.28, "fill=\"none\" stroke=\"#111\" stroke-width=\".08\"") + "</svg></div>";
    }
    out +=
        "</div><p class=\"facts\">Each dot is a place still thought possible; the ring is where the robot truly "
        "was.</p></section>";
  }
  return out;
}

Tree track(const std::vector<ReportSample>& samples, bool with_error) {
  Tree t = Tree::list();
  Tree x = Tree::list();
  Tree y = Tree::list();
  Tree yaw = Tree::list();
  Tree error = Tree::list();
  const auto rounded = [](double v, double unit) { return Tree(std::round(v / unit) * unit); };
  for (const auto& sample : samples) {
    t.push(rounded(sample.t_s, 0.01));
    x.push(rounded(sample.x, 0.001));
    y.push(rounded(sample.y, 0.001));
    yaw.push(rounded(sample.yaw, 0.001));
    error.push(rounded(sample.error_m, 0.0001));
  }
  Tree out = Tree::map();
  out.set("t", std::move(t)).set("x", std::move(x)).set("y", std::move(y)).set("yaw", std::move(yaw));
  if (with_error) out.set("e", std::move(error));
  return out;
}

std::string script_data(const ReportInput& input, double end_s) {
  Tree tracks = Tree::map();
  tracks.set("truth", track(input.truth, false));
  for (const auto& method : input.methods)
    if (!is_truth(method)) tracks.set(method.name, track(method.samples, true));
  Tree plot = Tree::map();
  plot.set("x0", plot_frame.x0).set("x1", plot_frame.x1).set("w", plot_frame.width);
  Tree data = Tree::map();
  data.set("end", end_s).set("plot", std::move(plot)).set("tracks", std::move(tracks));
  std::string json = write_json(data, 0);
  // "</" would end the script element.
  for (std::size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3) json.replace(at, 2, "<\\/");
  return json;
}

std::string plots(const ReportInput& input, double end_s) {
  std::vector<PlotCurve> curves;
  std::vector<PlotCurve> counts;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    if (is_truth(input.methods[i])) continue;
    PlotCurve curve{input.methods[i].name, colour(i), {}};
    for (const auto& sample : input.methods[i].samples) curve.points.emplace_back(sample.t_s, 100.0 * sample.error_m);
    curves.push_back(std::move(curve));
    PlotCurve count{input.methods[i].name, colour(i), {}};
    for (const auto& state : input.methods[i].states) count.points.emplace_back(state.t_s, state.hypotheses);
    if (!count.points.empty()) counts.push_back(std::move(count));
  }
  std::string out = "<section class=\"card\"><h2>Position error over time, cm (click to jump)</h2>" +
                    draw_plot("errors", curves, end_s) + "</section>";
  if (!counts.empty())
    out += "<section class=\"card\"><h2>Places still thought possible, over time</h2>" +
           draw_plot("hypotheses", counts, end_s) + "</section>";
  return out;
}

}  // namespace

std::string render_report(const ReportInput& input) {
  const Box box = bounds(input);
  const double end_s = input.truth.empty() ? 0.0 : input.truth.back().t_s;
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
      svg::escape(text_of(input.results, "scenario")) + " · Plumbline</title><style>";
  page += page_style();
  page += "</style></head>\n<body><main>" + header(input);
  page += "<div class=\"top\"><section class=\"card\">" + draw_map(input, box) + map_key() +
          "<div class=\"controls\"><button id=\"play\" type=\"button\">Play</button>"
          "<input id=\"time\" type=\"range\" min=\"0\" max=\"1\" step=\"0.1\" aria-label=\"time\">"
          "<span class=\"clock\" id=\"clock\"></span></div></section><aside class=\"card\">" +
          method_cards(input) + "</aside></div>\n";
  page += plots(input, end_s) + "\n" + list_deviations(input.deviations) + "\n" + beliefs(input, box) + "\n" +
          gates_table(input) + "\n" + numbers_table(input);
  page += "<details class=\"card\"><summary>What was simulated</summary><pre><code>" +
          svg::escape(input.results.find("sensors") == nullptr ? "" : write_yaml(*input.results.find("sensors"))) +
          "digest: " + svg::escape(text_of(input.results, "digest")) + "\n</code></pre></details></main>\n";
  page += "<script type=\"application/json\" id=\"data\">" + script_data(input, end_s) + "</script>\n<script>";
  page += page_script();
  return page + "</script></body></html>\n";
}

}  // namespace plumbline::scenarios
