// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace plumbline::scenarios {

/// Geometry of a plot in its own units: the drawing area between (x0, y0) and (x1, y1).
struct PlotFrame {
  double width = 1200.0;
  double height = 240.0;
  double x0 = 52.0;
  double x1 = 1060.0;
  double y0 = 10.0;
  double y1 = 214.0;
};
inline constexpr PlotFrame plot_frame;

struct PlotCurve {
  std::string name;
  std::string colour;
  std::vector<Eigen::Vector2d> points;  ///< (time in s, value)
};

/// Line plot over time from 0 to end_s with round ticks; gaps over 1 s in a curve stay open.
[[nodiscard]] std::string draw_plot(const std::string& id, const std::vector<PlotCurve>& curves, double end_s);

/// A step of 1, 2 or 5 times a power of ten that divides `span` into at most `count` parts.
[[nodiscard]] double round_step(double span, int count);

}  // namespace plumbline::scenarios
