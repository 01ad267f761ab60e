// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace plumbline::scenarios {

/// Geometry of a plot in its own units: the drawing area between (x0, y0) and (x1, y1), where it has neither marks nor
/// bands.
struct PlotFrame {
  double width = 1200.0;
  double height = 240.0;
  double x0 = 64.0;
  double x1 = 1012.0;
  double y0 = 10.0;
  double y1 = 214.0;
};
inline constexpr PlotFrame plot_frame;

struct PlotCurve {
  std::string name;
  std::string colour;
  std::vector<Eigen::Vector2d> points;  ///< (time in s, value)
  std::string layer = {};               ///< method with which it is shown and hidden; its name where empty
  bool disclaimed = false;              ///< the method said that it is lost: dotted, and the scale does not heed it
};

/// Something that happened, as an upright line with its label above the drawing area.
struct PlotMark {
  double t_s = 0.0;
  std::string label;
};

/// A time with one colour, below the ticks.
struct PlotBand {
  double from_s = 0.0;
  double to_s = 0.0;
  std::string label;
  std::string colour;
};

/// What a plot may hold beside its curves.
struct PlotExtras {
  std::vector<PlotMark> marks;  ///< by time
  std::vector<PlotBand> bands;
  double max = 0.0;        ///< of the values shown; 0: by the curves
  bool counts = false;     ///< the values are whole numbers
  std::string title = {};  ///< of the values, with their unit: "position error, cm"
};

/// Two points of a path further apart than this in time, or further in space, are not joined: the robot was carried, or
/// the method changed its answer.
inline constexpr double path_gap_s = 1.0;
inline constexpr double path_jump_m = 1.0;

/// Line plot over time from 0 to end_s with round ticks; gaps over path_gap_s in a curve stay open.
[[nodiscard]] std::string draw_plot(const std::string& id, const std::vector<PlotCurve>& curves, double end_s,
                                    const PlotExtras& extras = {});

/// A step of 1, 2 or 5 times a power of ten that divides `span` into at most `count` parts.
[[nodiscard]] double round_step(double span, int count);

}  // namespace plumbline::scenarios
