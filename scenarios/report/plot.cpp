// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/plot.h"

#include <algorithm>
#include <cmath>

#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr double max_gap_s = 1.0;

/// Curves are cut off above this quantile of all values, so that one outlier does not flatten the rest.
constexpr double shown_quantile = 0.995;

double shown_max(const std::vector<PlotCurve>& curves) {
  std::vector<double> values;
  for (const auto& curve : curves)
    for (const auto& p : curve.points) values.push_back(p.y());
  if (values.empty()) return 1.0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return std::max(1e-3, 1.05 * values[static_cast<std::size_t>(shown_quantile * last)]);
}

struct Scale {
  double end_s;
  double max;
  [[nodiscard]] double x(double t) const {
    return plot_frame.x0 + (plot_frame.x1 - plot_frame.x0) * (end_s > 0.0 ? t / end_s : 0.0);
  }
  [[nodiscard]] double y(double v) const {
    return plot_frame.y1 - (plot_frame.y1 - plot_frame.y0) * std::min(v / max, 1.0);
  }
};

std::string segment(double x1, double y1, double x2, double y2, const std::string& attributes) {
  return "<line x1=\"" + svg::number(x1, 1) + "\" y1=\"" + svg::number(y1, 1) + "\" x2=\"" + svg::number(x2, 1) +
         "\" y2=\"" + svg::number(y2, 1) + "\" " + attributes + "/>";
}

std::string label(double x, double y, const std::string& text, const std::string& anchor,
                  const std::string& more = "") {
  return "<text x=\"" + svg::number(x, 1) + "\" y=\"" + svg::number(y, 1) + "\" text-anchor=\"" + anchor + "\"" + more +
         ">" + svg::escape(text) + "</text>";
}

std::string axes(const Scale& scale) {
  std::string out;
  const double v_step = round_step(scale.max, 5);
  for (int i = 0; i * v_step <= scale.max; ++i) {
    const double y = scale.y(i * v_step);
    out += segment(plot_frame.x0, y, plot_frame.x1, y, "class=\"grid\"");
    out += label(plot_frame.x0 - 8.0, y + 4.0, svg::number(i * v_step, 4), "end");
  }
  const double t_step = round_step(scale.end_s, 10);
  for (int i = 0; i * t_step <= scale.end_s && scale.end_s > 0.0; ++i)
    out += label(scale.x(i * t_step), plot_frame.y1 + 18.0, svg::number(i * t_step, 2) + " s", "middle");
  return out;
}

std::string path(const PlotCurve& curve, const Scale& scale) {
  std::string d;
  double last_t = -1e9;
  for (const auto& p : curve.points) {
    d += p.x() - last_t > max_gap_s ? "M" : "L";
    d += svg::number(scale.x(p.x()), 1) + " " + svg::number(scale.y(p.y()), 1);
    last_t = p.x();
  }
  return "<path class=\"curve layer-" + svg::escape(curve.name) + "\" stroke=\"" + curve.colour + "\" d=\"" + d +
         "\"/>";
}

}  // namespace

double round_step(double span, int count) {
  if (!(span > 0.0)) return 1.0;
  const double raw = span / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1.0 - 1e-9)) return factor * power;
  return 10.0 * power;
}

std::string draw_plot(const std::string& id, const std::vector<PlotCurve>& curves, double end_s) {
  const Scale scale{end_s, shown_max(curves)};
  std::string out = "<svg class=\"plot\" id=\"" + id + "\" viewBox=\"0 0 " + svg::number(plot_frame.width, 0) + " " +
                    svg::number(plot_frame.height, 0) + "\">" + axes(scale);
  double label_y = plot_frame.y0 + 12.0;
  for (const auto& curve : curves) {
    if (!curve.points.empty()) out += path(curve, scale);
    out += label(plot_frame.x1 + 10.0, label_y, curve.name, "start", " style=\"fill:" + curve.colour + "\"");
    label_y += 16.0;
  }
  return out + segment(plot_frame.x0, plot_frame.y0, plot_frame.x0, plot_frame.y1, "class=\"cursor\"") + "</svg>";
}

}  // namespace plumbline::scenarios
