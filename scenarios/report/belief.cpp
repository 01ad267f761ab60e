// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/belief.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "scenarios/metrics/state_names.h"
#include "scenarios/report/palette.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

/// By slam::State.
constexpr std::array<std::string_view, 4> state_colours = {"var(--searching)", "var(--ambiguous)", "var(--converged)",
                                                           "var(--lost)"};

constexpr std::string_view right_colour = "var(--right)", wrong_colour = "var(--wrong)", unjudged_colour = "var(--m0)";
// Of places that are not the true one, apart from the colours of states and of right and wrong.
constexpr std::array<std::string_view, 5> other_colours = {"var(--o0)", "var(--o1)", "var(--o2)", "var(--o3)",
                                                           "var(--o4)"};

std::vector<PlotBand> state_bands(const std::vector<ReportState>& states, double end_s) {
  std::vector<PlotBand> bands;
  for (const ReportState& state : states) {
    const std::string name(state_name(state.state));
    if (!bands.empty() && bands.back().label == name) continue;
    if (!bands.empty()) bands.back().to_s = state.t_s;
    const std::string_view colour = state_colours[static_cast<std::size_t>(state.state)];
    bands.push_back({state.t_s, end_s, name, std::string(colour)});
  }
  return bands;
}

std::string swatch(std::string_view colour, const std::string& label) {
  return "<span><i class=\"swatch\" style=\"background:" + std::string(colour) + "\"></i>" + label + "</span>";
}

std::string state_key() {
  std::string out = "<div class=\"key\">";
  for (std::size_t i = 0; i < state_colours.size(); ++i)
    out += swatch(state_colours[i], std::string(state_names[i]) + ": " + std::string(state_meanings[i]));
  return out + "</div>";
}

/// Which hypotheses have no line of their own.
std::string left_out(const ReportMethod& method) {
  if (method.hypotheses_left_out == 0) return "";
  return std::string("Lines of their own have ") + (method.judged ? "the true pose and " : "") +
         "those with the largest share over the run; the other " + std::to_string(method.hypotheses_left_out) +
         " are one grey line together. ";
}

std::string chart(const ReportInput& input, const ReportMethod& method, double end_s) {
  if (method.histories.empty() && method.states.empty()) return "";
  PlotExtras extras;
  extras.marks = common_marks(input);
  extras.bands = state_bands(method.states, end_s);
  extras.max = 104.0;  // %, so that a curve along 100 stays whole
  extras.title = "share of the belief, %";
  const Tree* results = results_of(input, method.name);
  const Tree* localization = results == nullptr ? nullptr : results->find("localization");
  if (method.converged_s)
    extras.marks.push_back({*method.converged_s, "converged"});
  else if (const auto at = number_of(localization, "converged_at_s"))
    extras.marks.push_back({start_s(input) + *at, "converged"});
  std::stable_sort(extras.marks.begin(), extras.marks.end(),
                   [](const PlotMark& a, const PlotMark& b) { return a.t_s < b.t_s; });
  const std::string name = svg::escape(method.name);
  return "<section class=\"card\"><h2>Hypotheses of " + name + " over time</h2>" +
         draw_plot("belief-" + name, belief_curves(method), end_s, extras) + state_key() +
         "<p class=\"facts\">Each line is one hypothesis, moved along with the robot. " +
         (method.judged ? "It is green while it is the true pose (0.5 m, 10°); others bear the name of the room they "
                          "came up in. "
                        : "It bears the name of the room it came up in. ") +
         left_out(method) +
         "Equal lines are drawn 1 % apart. The bar shows the state that the method reports.</p></section>";
}

std::string place_mark(const Eigen::Vector2d& at, double yaw, double mass) {
  const double deg = yaw * 180.0 / std::numbers::pi;
  return "<path class=\"heldplace\" d=\"M.5 0L-.3 -.28L-.16 0L-.3 .28Z\" transform=\"translate(" + svg::number(at.x()) +
         " " + svg::number(-at.y()) + ") rotate(" + svg::number(-deg, 1) + ")\"><title>share " +
         svg::number(100.0 * mass, 0) + " %</title></path>";
}

std::string draw_hypothesis(const ReportHypothesis& hypothesis, bool judged) {
  std::string out;
  for (const ReportMatch& match : hypothesis.walls) {
    const std::string_view colour = !judged ? unjudged_colour : match.right ? right_colour : wrong_colour;
    const std::string stroke = "stroke=\"" + std::string(colour) + "\"";
    for (const ReportWall& face : match.faces) out += svg::line(face.p0, face.p1, "class=\"plannedwall\" " + stroke);
    out += svg::line(match.patch.p0, match.patch.p1, "class=\"seenwall\" " + stroke);
  }
  return out + place_mark(hypothesis.at, hypothesis.yaw, hypothesis.mass);
}

std::string ring(const Eigen::Vector2d& at) {
  return svg::circle(at, 0.6, "fill=\"none\" stroke=\"var(--truth)\" stroke-width=\".08\"");
}

std::string counted(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// "at the end, 30 s: hypothesis 2 of 3, 33 %: 4 of 7 walls right"
std::string caption(const ReportWalls& walls, std::size_t index, bool judged) {
  const ReportHypothesis& hypothesis = walls.hypotheses[index];
  const auto right = std::count_if(hypothesis.walls.begin(), hypothesis.walls.end(),
                                   [](const ReportMatch& match) { return match.right; });
  std::string text = walls.label + ", " + svg::number(walls.t_s, 1) + " s: ";
  if (walls.hypotheses.size() > 1)
    text += "hypothesis " + std::to_string(index + 1) + " of " + std::to_string(walls.hypotheses.size()) + ", " +
            svg::number(100.0 * hypothesis.mass, 0) + " %: ";
  if (!judged) return text + counted(hypothesis.walls.size(), "wall");
  return text + std::to_string(right) + " of " + counted(hypothesis.walls.size(), "wall") + " right";
}

std::string recognised(const ReportInput& input, const ReportMethod& method, const MapBox& box) {
  constexpr std::size_t most = 3;  // hypotheses at one time, a map each
  if (method.recognised.empty()) return "";
  std::string out = "<details class=\"card fold\" open><summary>Walls matched by " + svg::escape(method.name) +
                    "</summary><div class=\"beliefs\">";
  for (const ReportWalls& walls : method.recognised)
    for (std::size_t i = 0; i < std::min(most, walls.hypotheses.size()); ++i)
      out += "<div><p>" + svg::escape(caption(walls, i, method.judged)) + "</p>" +
             open_map(box, "walls matched " + walls.label) + draw_plan(input, walls.storey) +
             draw_hypothesis(walls.hypotheses[i], method.judged) + (method.judged ? ring(walls.truth) : "") +
             "</svg></div>";
  if (!method.judged)
    return out + "</div><div class=\"key\">" +
           swatch(unjudged_colour, "observed wall (dark) and the wall of the plan it was matched with (light)") +
           "<span>arrow: pose of the hypothesis</span></div></details>";
  return out + "</div><div class=\"key\">" +
         swatch(right_colour, "observed wall (dark) and the wall of the plan it was matched with (light), right") +
         swatch(wrong_colour, "wrong: it was another wall, or none") +
         "<span>arrow: pose of the hypothesis, ring: true position</span></div></details>";
}

std::string particles(const ReportInput& input, std::size_t index, const MapBox& box) {
  const ReportMethod& method = input.methods[index];
  if (method.beliefs.empty()) return "";
  std::string out = "<details class=\"card fold\" open><summary>Particles of " + svg::escape(method.name) +
                    "</summary><div class=\"beliefs\">";
  for (const auto& belief : method.beliefs) {
    out += "<div><p>" + svg::escape(belief.label) + ", " + svg::number(belief.t_s, 1) + " s</p>" +
           open_map(box, "particles at " + belief.label) + draw_plan(input, belief.storey);
    for (const auto& particle : belief.particles)
      out +=
          svg::circle({particle.x, particle.y}, 0.09, "fill=\"" + method_ink(method.ink) + "\" fill-opacity=\".55\"");
    out += (method.judged ? ring(belief.truth) : "") + "</svg></div>";
  }
  return out + "</div><p class=\"facts\">Each dot is a particle" +
         (method.judged ? "; the ring is the true position" : "") + ".</p></details>";
}

/// First time from which on every other hypothesis left is marginal, where that is so at the end.
std::optional<double> marginal_since(const ReportInput& input) {
  const Tree* known = input.results.find("identifiability");
  const Tree* places = known == nullptr ? nullptr : known->find("places");
  std::optional<double> since;
  if (places == nullptr) return since;
  for (const Tree& left : places->as_list()) {
    const bool marginal = number_of(&left, "aliases") == number_of(&left, "weak");
    if (!marginal) since.reset();
    if (marginal && !since) since = number_of(&left, "t_s");
  }
  return since;
}

}  // namespace

std::string draw_hypothesis_mark(const Pose& X_WR, double mass) {
  const Eigen::Vector2d at = X_WR.t.head<2>();
  return place_mark(at, X_WR.yaw(), mass) +
         svg::text(at + Eigen::Vector2d(0.6, 0.2), svg::number(100.0 * mass, 0) + " %", "class=\"event\"");
}

std::vector<PlotCurve> belief_curves(const ReportMethod& method) {
  const std::size_t longest = method.judged ? 12 : 24;  // of a room's name beside the plot
  std::vector<PlotCurve> curves;
  bool true_is_named = false;
  int named = -1;  // the last hypothesis with a name beside the plot
  // A stretch without a name counts to the one before: those of the true pose stand together.
  std::vector<HypothesisHistory> histories = method.histories;
  const auto others = std::stable_partition(histories.begin(), histories.end(),
                                            [](const HypothesisHistory& history) { return history.is_true; });
  const auto start = [](const HypothesisHistory& history) {
    return history.points.empty() ? 0.0 : history.points.front().x();
  };
  std::stable_sort(histories.begin(), others,
                   [&](const HypothesisHistory& a, const HypothesisHistory& b) { return start(a) < start(b); });
  for (const HypothesisHistory& history : histories) {
    const auto other = static_cast<std::size_t>(history.hypothesis) % other_colours.size();
    PlotCurve curve;
    curve.layer = method.name;
    curve.colour = history.is_true ? right_colour : other_colours[other];
    if (history.is_true && !std::exchange(true_is_named, true)) curve.name = "true pose";
    if (!history.is_true && std::exchange(named, history.hypothesis) != history.hypothesis) {
      curve.name = method.judged ? "other" : "hypothesis " + std::to_string(history.hypothesis + 1);
      if (!history.room.empty() && history.room.size() <= longest) curve.name += ": " + history.room;
    }
    curve.lowered = history.hypothesis;  // % each
    curve.gap_s = method.breaks.gap_s;
    for (const Eigen::Vector2d& p : history.points) curve.points.emplace_back(p.x(), 100.0 * p.y());
    curves.push_back(std::move(curve));
  }
  if (method.other_hypotheses.empty()) return curves;
  PlotCurve rest{"all others together", "var(--soft)", {}, method.name};
  rest.gap_s = method.breaks.gap_s;
  for (const Eigen::Vector2d& p : method.other_hypotheses) rest.points.emplace_back(p.x(), 100.0 * p.y());
  curves.push_back(std::move(rest));
  return curves;
}

std::vector<PlotMark> common_marks(const ReportInput& input) {
  std::vector<PlotMark> marks;
  const auto identifiable = number_of(input.results.find("identifiability"), "at_s");
  const auto marginal = marginal_since(input);
  const double from_s = start_s(input);
  // What holds from the first scan on is no event.
  if (identifiable && *identifiable > 0.0)
    marks.push_back({from_s + *identifiable, "identifiable from here on"});
  else if (!identifiable && marginal && *marginal > 0.0)
    marks.push_back({from_s + *marginal, "marginally identifiable from here on"});
  if (input.kidnap) {
    marks.push_back({input.kidnap->lifted_s, "kidnapped"});
    marks.push_back({input.kidnap->set_down_s, "set down elsewhere"});
  }
  std::stable_sort(marks.begin(), marks.end(), [](const PlotMark& a, const PlotMark& b) { return a.t_s < b.t_s; });
  return marks;
}

std::string draw_beliefs(const ReportInput& input, const MapBox& box, double end_s) {
  std::string out;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    const ReportMethod& method = input.methods[i];
    if (is_truth(method)) continue;
    out += chart(input, method, end_s) + recognised(input, method, box) + particles(input, i, box);
  }
  return out;
}

}  // namespace plumbline::scenarios
