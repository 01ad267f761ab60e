// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/plot.h"

#include <algorithm>
#include <cmath>

#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr double mark_row = 15.0;   // height of a label above the drawing area
constexpr double band_room = 24.0;  // and of the bands below

/// Curves are cut off above this quantile of all values, so that one outlier does not flatten the rest.
constexpr double shown_quantile = 0.995;

double shown_max(const std::vector<PlotCurve>& curves) {
  std::vector<double> values;
  for (const auto& curve : curves)
    for (const auto& p : curve.points)
      if (!curve.disclaimed) values.push_back(p.y());
  if (values.empty()) return 1.0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return std::max(1e-3, 1.05 * values[static_cast<std::size_t>(shown_quantile * last)]);
}

struct Scale {
  double end_s;
  double max;
  double y0;  ///< upper and lower end of the drawing area
  double y1;
  [[nodiscard]] double x(double t) const {
    return plot_frame.x0 + (plot_frame.x1 - plot_frame.x0) * (end_s > 0.0 ? t / end_s : 0.0);
  }
  [[nodiscard]] double y(double v) const { return y1 - (y1 - y0) * std::min(v / max, 1.0); }
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

std::string axes(const Scale& scale, const PlotExtras& extras) {
  std::string out;
  const double v_step = std::max(round_step(scale.max, 5), extras.counts ? 1.0 : 0.0);
  for (int i = 0; i * v_step <= scale.max; ++i) {
    const double y = scale.y(i * v_step);
    out += segment(plot_frame.x0, y, plot_frame.x1, y, "class=\"grid\"");
    out += label(plot_frame.x0 - 8.0, y + 4.0, svg::number(i * v_step, 4), "end");
  }
  const double t_step = round_step(scale.end_s, 10);
  for (int i = 0; i * t_step <= scale.end_s && scale.end_s > 0.0; ++i)
    out += label(scale.x(i * t_step), scale.y1 + 18.0, svg::number(i * t_step, 2) + " s", "middle");
  const double middle = 0.5 * (scale.y0 + scale.y1);
  out += label(12.0, middle, extras.title, "middle", " transform=\"rotate(-90 12 " + svg::number(middle, 1) + ")\"");
  return out + label(plot_frame.x1 + 8.0, scale.y1 + 18.0, "time", "start");
}

std::string path(const PlotCurve& curve, const Scale& scale) {
  std::string d;
  double last_t = -1e9;
  for (const auto& p : curve.points) {
    d += p.x() - last_t > path_gap_s ? "M" : "L";
    d += svg::number(scale.x(p.x()), 1) + " " + svg::number(scale.y(p.y()), 1);
    last_t = p.x();
  }
  return "<path class=\"curve " + std::string(curve.disclaimed ? "disclaimed " : "") + "layer-" +
         svg::escape(curve.layer.empty() ? curve.name : curve.layer) + "\" stroke=\"" + curve.colour + "\" d=\"" + d +
         "\"/>";
}

/// Where a curve leaves the scale, as small triangles at its upper end.
std::string above_scale(const PlotCurve& curve, const Scale& scale) {
  constexpr double apart = 10.0;
  std::string out;
  double last = -1e9;
  for (const Eigen::Vector2d& p : curve.points) {
    const double x = scale.x(p.x());
    if (p.y() <= scale.max || x - last < apart) continue;
    out += "<path class=\"above layer-" + svg::escape(curve.layer.empty() ? curve.name : curve.layer) + "\" fill=\"" +
           curve.colour + "\" d=\"M" + svg::number(x - 4.0, 1) + " " + svg::number(scale.y0 + 6.0, 1) + "h8l-4 -6z\"/>";
    last = x;
  }
  return out;
}

/// Labels stand in rows of their own, so that marks of about the same time stay legible.
std::string draw_marks(const std::vector<PlotMark>& marks, const Scale& scale) {
  std::string out;
  double y = plot_frame.y0;
  for (const PlotMark& mark : marks) {
    const double x = scale.x(mark.t_s);
    const bool left = x > 0.5 * (plot_frame.x0 + plot_frame.x1);
    out += segment(x, y, x, scale.y1, "class=\"mark\"");
    out += label(left ? x - 5.0 : x + 5.0, y + 10.0, mark.label, left ? "end" : "start", " class=\"marked\"");
    y += mark_row;
  }
  return out;
}

std::string draw_bands(const std::vector<PlotBand>& bands, const Scale& scale) {
  constexpr double height = 16.0, letter = 8.6;  // what a capital takes at most, bold, 11 px
  std::string out;
  for (const PlotBand& band : bands) {
    const double x = scale.x(band.from_s), width = scale.x(band.to_s) - x, y = scale.y1 + band_room;
    out += "<rect x=\"" + svg::number(x, 1) + "\" y=\"" + svg::number(y, 1) + "\" width=\"" + svg::number(width, 1) +
           "\" height=\"" + svg::number(height, 0) + "\" fill=\"" + band.colour + "\"><title>" +
           svg::escape(band.label) + ", " + svg::number(band.from_s, 1) + " to " + svg::number(band.to_s, 1) +
           " s</title></rect>";
    if (letter * static_cast<double>(band.label.size()) < width)
      out += label(x + 0.5 * width, y + 12.0, band.label, "middle", " class=\"inband\"");
  }
  return out;
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

std::string draw_plot(const std::string& id, const std::vector<PlotCurve>& curves, double end_s,
                      const PlotExtras& extras) {
  const double lower = mark_row * static_cast<double>(extras.marks.size());
  const Scale scale{end_s, extras.max > 0.0 ? extras.max : shown_max(curves), plot_frame.y0 + lower,
                    plot_frame.y1 + lower};
  const double height = plot_frame.height + lower + (extras.bands.empty() ? 0.0 : band_room);
  std::string out = "<div class=\"plotbox\"><svg class=\"plot\" id=\"" + id + "\" viewBox=\"0 0 " +
                    svg::number(plot_frame.width, 0) + " " + svg::number(height, 0) + "\">" + axes(scale, extras) +
                    draw_bands(extras.bands, scale) + draw_marks(extras.marks, scale);
  double label_y = scale.y0 + 12.0;
  for (const auto& curve : curves) {
    if (!curve.points.empty()) out += path(curve, scale) + above_scale(curve, scale);
    if (curve.name.empty()) continue;  // another stretch of one that has its name already
    out += segment(plot_frame.x1 + 8.0, label_y - 4.0, plot_frame.x1 + 24.0, label_y - 4.0,
                   "stroke-width=\"3\" stroke=\"" + curve.colour + "\"") +
           label(plot_frame.x1 + 29.0, label_y, curve.name, "start");
    label_y += 16.0;
  }
  return out + segment(plot_frame.x0, scale.y0, plot_frame.x0, scale.y1, "class=\"cursor\"") + "</svg></div>";
}

}  // namespace plumbline::scenarios
