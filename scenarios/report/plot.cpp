// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/plot.h"

#include <algorithm>
#include <cmath>

#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr double wide = 1000.0, high = 200.0;  // of the drawing area, in its own units
constexpr double mark_row_px = 15.0;           // height of a label above the drawing area

/// Curves are cut off above this quantile of all values, so that one outlier does not flatten the rest.
constexpr double shown_quantile = 0.995;

/// A scale by the worst curve flattens the good ones. By this, the curve of the median method takes at least a quarter
/// of the height; those beyond are marked where they leave the scale.
constexpr double times_median = 4.0;

/// Of each curve that is an answer, what it exceeds hardly ever; in order.
std::vector<double> extents_of(const std::vector<PlotCurve>& curves) {
  std::vector<double> extents;
  for (const auto& curve : curves) {
    if (curve.disclaimed || curve.points.empty()) continue;
    std::vector<double> values;
    for (const auto& p : curve.points) values.push_back(std::abs(p.y()));
    std::sort(values.begin(), values.end());
    const auto last = static_cast<double>(values.size() - 1);
    extents.push_back(values[static_cast<std::size_t>(shown_quantile * last)]);
  }
  std::sort(extents.begin(), extents.end());
  return extents;
}

double shown_max(const std::vector<PlotCurve>& curves, bool counts) {
  constexpr double least = 1e-3;
  const std::vector<double> extents = extents_of(curves);
  if (extents.empty()) return 1.0;
  const double median = extents[(extents.size() - 1) / 2];  // of two in the middle the smaller
  const bool by_median = !counts && median > least;
  return std::max(least, 1.05 * (by_median ? std::min(extents.back(), times_median * median) : extents.back()));
}

struct Scale {
  double end_s;
  double min, max;
  [[nodiscard]] double share(double t) const { return end_s > 0.0 ? t / end_s : 0.0; }
  [[nodiscard]] double x(double t) const { return wide * share(t); }
  [[nodiscard]] double y(double v) const { return high * (max - std::clamp(v, min, max)) / (max - min); }
};

std::string segment(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line class=\"" + kind + "\" x1=\"" + svg::number(x1, 1) + "\" y1=\"" + svg::number(y1, 1) + "\" x2=\"" +
         svg::number(x2, 1) + "\" y2=\"" + svg::number(y2, 1) + "\"/>";
}

std::string share_of_width(double share) { return svg::number(100.0 * share, 2) + "%"; }

std::string layer_of(const PlotCurve& curve) {
  return "layer-" + svg::escape(curve.layer.empty() ? curve.name : curve.layer);
}

/// Lines across the drawing area, and the numbers at its left.
struct Values {
  std::string lines, numbers;
};

Values values_of(const Scale& scale, const PlotExtras& extras) {
  Values out;
  const double step = std::max(round_step(scale.max - scale.min, 5), extras.counts ? 1.0 : 0.0);
  const int first = static_cast<int>(std::ceil(scale.min / step - 1e-9));
  for (int i = first; i * step <= scale.max; ++i) {
    const double y = scale.y(i * step);
    out.lines += segment(0.0, y, wide, y, i == 0 ? "grid zero" : "grid");
    out.numbers +=
        "<span class=\"y\" style=\"top:" + share_of_width(y / high) + "\">" + svg::number(i * step, 4) + "</span>";
  }
  return out;
}

std::string times(const Scale& scale) {
  std::string out = "<div class=\"ticks\">";
  const double step = round_step(scale.end_s, 10);
  for (int i = 0; i * step <= scale.end_s && scale.end_s > 0.0; ++i)
    out += std::string("<span") + (i % 2 == 1 ? " class=\"odd\"" : "") +
           " style=\"left:" + share_of_width(scale.share(i * step)) + "\">" + svg::number(i * step, 2) + " s</span>";
  return out + "</div>";
}

std::string path(const PlotCurve& curve, const Scale& scale) {
  std::string d;
  Eigen::Vector2d last(-1e9, 0.0);
  for (const auto& p : curve.points) {
    const bool jumps = curve.jump > 0.0 && std::abs(p.y() - last.y()) > curve.jump;
    d += jumps || p.x() - last.x() > curve.gap_s ? "M" : "L";
    const double y = curve.lowered > 0.0 ? std::max(scale.min, p.y() - curve.lowered) : p.y();
    d += svg::number(scale.x(p.x()), 1) + " " + svg::number(scale.y(y), 1);
    last = p;
  }
  return "<path class=\"curve " + std::string(curve.disclaimed ? "disclaimed " : "") + layer_of(curve) +
         "\" stroke=\"" + curve.colour + "\" d=\"" + d + "\"/>";
}

/// Where a curve leaves the scale, as small triangles at its edge.
std::string beyond_scale(const PlotCurve& curve, const Scale& scale) {
  constexpr double apart = 10.0;
  std::string out;
  double last = -1e9;
  for (const Eigen::Vector2d& p : curve.points) {
    const double x = scale.x(p.x());
    const bool below = p.y() < scale.min;
    if ((p.y() <= scale.max && !below) || x - last < apart) continue;
    out += "<span class=\"over " + layer_of(curve) + "\" style=\"left:" + share_of_width(x / wide) +
           (below ? ";top:auto;bottom:-4px" : "") + ";color:" + curve.colour + "\">" + (below ? "▼" : "▲") + "</span>";
    last = x;
  }
  return out;
}

/// Labels stand in rows of their own, so that marks of about the same time stay legible; on the side with more room.
std::string mark_labels(const std::vector<PlotMark>& marks, const Scale& scale) {
  if (marks.empty()) return "";
  const double height = mark_row_px * static_cast<double>(marks.size());
  std::string out = "<div class=\"rows\" style=\"height:" + svg::number(height, 0) + "px\">";
  double top = 0.0;
  for (const PlotMark& mark : marks) {
    const double share = std::clamp(scale.share(mark.t_s), 0.0, 1.0);
    const bool left = share > 0.5;
    out += std::string("<span") + (left ? " class=\"left\"" : "") + " style=\"" + (left ? "right:" : "left:") +
           share_of_width(left ? 1.0 - share : share) + ";max-width:" + share_of_width(left ? share : 1.0 - share) +
           ";top:" + svg::number(top, 0) + "px;height:" + svg::number(height - top, 0) + "px\" title=\"" +
           svg::escape(mark.label) + ", " + svg::number(mark.t_s, 1) + " s\">" + svg::escape(mark.label) + "</span>";
    top += mark_row_px;
  }
  return out + "</div>";
}

std::string draw_bands(const std::vector<PlotBand>& bands, const Scale& scale) {
  if (bands.empty()) return "";
  constexpr double letter = 0.011;  // of the width of a page, what a letter takes
  std::string out = "<div class=\"band\">";
  for (const PlotBand& band : bands) {
    const double width = scale.share(band.to_s) - scale.share(band.from_s);
    out += "<span style=\"left:" + share_of_width(scale.share(band.from_s)) + ";width:" + share_of_width(width) +
           ";background:" + band.colour + "\" title=\"" + svg::escape(band.label) + ", " + svg::number(band.from_s, 1) +
           " to " + svg::number(band.to_s, 1) + " s\">" +
           (letter * static_cast<double>(band.label.size()) < width ? svg::escape(band.label) : "") + "</span>";
  }
  return out + "</div>";
}

std::string legend(const std::vector<PlotCurve>& curves) {
  std::string out = "<div class=\"legend\">";
  std::size_t series = 0;  // by which the script finds the value of now
  for (const PlotCurve& curve : curves) {
    if (curve.name.empty()) continue;
    out += "<span class=\"" + layer_of(curve) + "\"><i class=\"swatch\" style=\"background:" + curve.colour +
           "\"></i>" + svg::escape(curve.name) + " <b data-series=\"" + std::to_string(series++) + "\"></b></span>";
  }
  return out + "</div>";
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
  const double max = extras.max > 0.0 ? extras.max : shown_max(curves, extras.counts);
  const Scale scale{end_s, extras.both_ways ? -max : 0.0, max};
  const Values values = values_of(scale, extras);
  std::string lines = values.lines, over = values.numbers;
  for (const PlotMark& mark : extras.marks) lines += segment(scale.x(mark.t_s), 0.0, scale.x(mark.t_s), high, "mark");
  for (const PlotCurve& curve : curves) {
    if (curve.points.empty()) continue;
    lines += path(curve, scale);
    over += beyond_scale(curve, scale);
  }
  return "<figure class=\"plot" + std::string(extras.small ? " small" : "") + "\" id=\"" + id +
         "\"><p class=\"axis\">" + svg::escape(extras.title) + "</p>" + mark_labels(extras.marks, scale) +
         "<div class=\"frame\"><svg viewBox=\"0 0 1000 200\" preserveAspectRatio=\"none\" aria-hidden=\"true\">" +
         lines + segment(0.0, 0.0, 0.0, high, "cursor") + "</svg>" + over + "</div>" + times(scale) +
         draw_bands(extras.bands, scale) + legend(curves) + "</figure>";
}

}  // namespace plumbline::scenarios
