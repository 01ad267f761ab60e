// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/page_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenarios/metrics/state_names.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/error_plots.h"
#include "scenarios/report/map_drawing.h"

namespace plumbline::scenarios {

namespace {

/// To 1 / `parts`, as the nearest number, which has the shortest text.
double rounded(double value, double parts) { return std::round(value * parts) / parts; }

/// Times, places, headings and storeys; of a method its errors too, null where there is none, left out where there is
/// none at all.
Tree track(const std::vector<ReportSample>& samples, bool with_error) {
  const auto column = [&](const auto& value) {
    Tree list = Tree::list();
    for (const ReportSample& sample : samples) list.push(value(sample));
    return list;
  };
  Tree out = Tree::map();
  out.set("t", column([](const ReportSample& s) { return Tree(rounded(s.t_s, 100.0)); }))
      .set("x", column([](const ReportSample& s) { return Tree(rounded(s.x, 1000.0)); }))
      .set("y", column([](const ReportSample& s) { return Tree(rounded(s.y, 1000.0)); }))
      .set("yaw", column([](const ReportSample& s) { return Tree(rounded(s.yaw, 1000.0)); }))
      .set("s", column([](const ReportSample& s) { return Tree(s.storey); }));
  if (!with_error) return out;
  out.set("lost", column([](const ReportSample& s) { return Tree(s.lost ? 1 : 0); }));
  const auto is_judged = [](const ReportSample& sample) { return sample.judged; };
  if (!samples.empty() && std::none_of(samples.begin(), samples.end(), is_judged)) return out;
  for (const ErrorKind& kind : error_kinds())
    out.set(std::string(kind.column), column([&](const ReportSample& s) {
              const std::optional<double> value = s.judged ? kind.value(s) : std::nullopt;
              return value ? Tree(rounded(*value, 10000.0)) : Tree();
            }));
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

/// What a curve of counts or shares is, as [[since t, value], ...], nothing where it is drawn open; stretches without a
/// name belong to the one before.
Tree steps(const std::vector<PlotCurve>& curves, std::size_t first) {
  Tree list = Tree::list();
  for (std::size_t i = first; i < curves.size() && (i == first || curves[i].name.empty()); ++i) {
    const PlotCurve& curve = curves[i];
    std::optional<double> before;
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      const double t_s = curve.points[k].x(), value = std::round(curve.points[k].y());
      if (std::exchange(before, value) != value) list.push(Tree(Tree::List{Tree(rounded(t_s, 100.0)), Tree(value)}));
      if (k + 1 < curve.points.size() && curve.points[k + 1].x() - t_s <= curve.gap_s) continue;
      list.push(Tree(Tree::List{Tree(rounded(t_s + curve.gap_s, 100.0)), Tree()}));
      before.reset();
    }
  }
  return list;
}

Tree plot_of(std::string_view unit, int decimals, double scale) {
  return Tree::map().set("unit", std::string(unit)).set("decimals", decimals).set("scale", scale);
}

Tree plot_of_curves(std::string_view unit, const std::vector<PlotCurve>& curves) {
  Tree series = Tree::list();
  for (std::size_t i = 0; i < curves.size(); ++i)
    if (!curves[i].name.empty()) series.push(Tree::map().set("name", curves[i].name).set("steps", steps(curves, i)));
  return plot_of(unit, 0, 1.0).set("series", std::move(series));
}

/// By plot: unit, decimals, and in the order of its legend what the curves are.
Tree plots(const ReportInput& input, double end_s) {
  Tree out = Tree::map();
  for (const ErrorKind& kind : error_kinds()) {
    Tree series = Tree::list();
    for (const ReportMethod& method : input.methods)
      if (!is_truth(method)) series.push(Tree::map().set("name", method.name).set("column", std::string(kind.column)));
    out.set(std::string(kind.id), plot_of(kind.unit, kind.decimals, kind.scale).set("series", std::move(series)));
  }
  if (const auto counts = hypothesis_counts(input, end_s); !counts.empty())
    out.set("hypotheses", plot_of_curves("", counts));
  for (const ReportMethod& method : input.methods)
    if (!method.histories.empty()) out.set("belief-" + method.name, plot_of_curves("%", belief_curves(method)));
  return out;
}

}  // namespace

std::string script_data(const ReportInput& input, double end_s) {
  Tree tracks = Tree::map();
  // Without a truth the maps follow the estimate.
  const bool has_truth = !input.truth.empty() || input.methods.empty();
  tracks.set("truth", track(has_truth ? input.truth : input.methods.front().samples, false));
  for (const auto& method : input.methods)
    if (!is_truth(method))
      tracks.set(method.name, track(method.samples, true).set("gap", rounded(method.breaks.gap_s, 100.0)));
  Tree states = Tree::map();
  for (const auto& method : input.methods)
    if (!method.states.empty()) states.set(method.name, state_changes(method.states));
  Tree data = Tree::map();
  data.set("states", std::move(states)).set("plots", plots(input, end_s));
  data.set("end", end_s).set("tracks", std::move(tracks));
  // A "<" of a name could end the script element, or keep its end from being seen.
  std::string json;
  for (const char c : write_json(data, 0)) json += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return json;
}

}  // namespace plumbline::scenarios
