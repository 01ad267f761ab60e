// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/error_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenarios/report/belief.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/palette.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr double deg = 180.0 / std::numbers::pi;

constexpr std::array<ErrorKind, 6> kinds = {{
    {"errors", "position error, cm", "e", "cm", 100.0, 1, false,
     [](const ReportSample& s) { return std::optional(s.error_m); }},
    {"errors-x", "error along x of the building, cm", "ex", "cm", 100.0, 1, true,
     [](const ReportSample& s) { return std::optional(s.error_W.x()); }},
    {"errors-y", "error along y of the building, cm", "ey", "cm", 100.0, 1, true,
     [](const ReportSample& s) { return std::optional(s.error_W.y()); }},
    {"errors-z", "error of the height, cm", "ez", "cm", 100.0, 1, true,
     [](const ReportSample& s) { return std::optional(s.error_W.z()); }},
    {"errors-heading", "error of the heading, degrees", "eh", "°", deg, 2, true,
     [](const ReportSample& s) { return std::optional(s.yaw_error); }, 180.0},
    {"errors-relative", "error of the motion over the last metre walked, cm", "er", "cm", 100.0, 1, false,
     [](const ReportSample& s) { return s.relative_m; }},
}};

/// How many poses are consistent with the scans, over time.
PlotCurve consistent_poses(const ReportInput& input, double end_s) {
  PlotCurve curve{"consistent poses", "var(--soft)", {}, "truth"};
  const Tree* known = input.results.find("identifiability");
  if (known == nullptr) return curve;
  const double from_s = start_s(input);
  constexpr double step_s = 0.5;  // a curve with larger gaps would be drawn open
  const Tree::List& places = known->find("places")->as_list();
  if (input.kidnap) end_s = std::min(end_s, input.kidnap->lifted_s);  // it is computed up to there
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double until = i + 1 < places.size() ? from_s + places[i + 1].find("t_s")->as_double() : end_s;
    for (double t = from_s + places[i].find("t_s")->as_double(); t <= until; t += step_s)
      curve.points.emplace_back(t, 1.0 + places[i].find("aliases")->as_double());
  }
  return curve;
}

std::string identifiability_sentence(const Tree& known, double start_s) {
  std::string text = "the scans never distinguished the true pose from all others.";
  if (const auto at = number_of(&known, "at_s"))
    text = *at <= 0.0 ? "identifiable from the first scan on."
                      : "identifiable from t = " + svg::number(start_s + *at, 1) + " s on, after " +
                            svg::number(number_of(&known, "at_m").value_or(0.0), 1) + " m walked.";
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
  std::string out = line("By the building alone: " + identifiability_sentence(*known, start_s(input)));
  if (with_furniture != nullptr)
    out += line("With the furniture as planned: " + identifiability_sentence(*with_furniture, start_s(input)));
  const bool by_furniture = with_furniture != nullptr && number_of(with_furniture, "at_s") && !number_of(known, "at_s");
  return by_furniture ? out + line("Only furniture tells these apart; it may have moved.") : out;
}

/// A curve for each method; where it says that it is lost, another one.
std::vector<PlotCurve> error_curves(const ReportInput& input, const ErrorKind& kind) {
  std::vector<PlotCurve> curves;
  for (const ReportMethod& method : input.methods) {
    if (is_truth(method)) continue;
    PlotCurve curve{method.name, method_ink(method.ink), {}}, lost{"", method_ink(method.ink), {}, method.name};
    lost.disclaimed = true;
    curve.jump = lost.jump = kind.jump;
    curve.gap_s = lost.gap_s = method.breaks.gap_s;
    for (const ReportSample& sample : method.samples)
      if (const std::optional<double> value = sample.judged ? kind.value(sample) : std::nullopt)
        (sample.lost ? lost : curve).points.emplace_back(sample.t_s, kind.scale * *value);
    curves.push_back(std::move(curve));
    if (!lost.points.empty()) curves.push_back(std::move(lost));
  }
  return curves;
}

}  // namespace

std::span<const ErrorKind> error_kinds() { return kinds; }

std::string draw_error(const ReportInput& input, const ErrorKind& kind, double end_s, bool small) {
  PlotExtras extras;
  if (!small) extras.marks = common_marks(input);
  extras.title = kind.title;
  extras.both_ways = kind.both_ways;
  extras.small = small;
  return draw_plot(std::string(kind.id), error_curves(input, kind), end_s, extras);
}

std::string draw_errors(const ReportInput& input, double end_s) {
  const std::vector<PlotCurve> curves = error_curves(input, kinds.front());
  if (curves.empty())
    return "<section class=\"card\"><h2>Position error over time</h2><p class=\"facts\">No method was run beside the "
           "truth, which has no error.</p></section>";
  if (std::all_of(curves.begin(), curves.end(), [](const PlotCurve& curve) { return curve.points.empty(); }))
    return "<section class=\"card\"><h2>Position error over time</h2><p class=\"facts\">No method gave one "
           "pose.</p></section>";
  std::string out =
      "<section class=\"card\"><h2>Position error over time</h2>" + draw_error(input, kinds.front(), end_s, false) +
      "<p class=\"facts\">Point at it for values, click to jump there; the legend gives the values at the "
      "time shown. The scale ends at four times what the median method reaches, so that good ones can be compared; "
      "triangles: beyond it. Dotted: the method says that it is lost.</p>"
      "<details class=\"fold\" open><summary>By axis, heading, and over the last metre</summary><div class=\"pair\">";
  for (const ErrorKind& kind : std::span(kinds).subspan(1)) out += draw_error(input, kind, end_s, true);
  return out + "</div></details></section>";
}

std::vector<PlotCurve> hypothesis_counts(const ReportInput& input, double end_s) {
  std::vector<PlotCurve> counts;
  for (const ReportMethod& method : input.methods) {
    if (is_truth(method)) continue;
    PlotCurve count{method.name, method_ink(method.ink), {}};
    for (const auto& state : method.states) count.points.emplace_back(state.t_s, state.hypotheses);
    if (!count.points.empty()) counts.push_back(std::move(count));
  }
  if (counts.empty()) return counts;
  if (PlotCurve possible = consistent_poses(input, end_s); !possible.points.empty())
    counts.push_back(std::move(possible));
  return counts;
}

std::string draw_hypothesis_counts(const ReportInput& input, double end_s) {
  const std::vector<PlotCurve> counts = hypothesis_counts(input, end_s);
  if (counts.empty()) return "";
  PlotExtras extras;
  extras.marks = common_marks(input);
  extras.counts = true;
  extras.title = "poses";
  return "<section class=\"card\"><h2>Hypotheses over time</h2>" + draw_plot("hypotheses", counts, end_s, extras) +
         identifiability_text(input) + "</section>";
}

}  // namespace plumbline::scenarios
