// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace plumbline::scenarios {

/// Two points of a curve further apart than this in time are not joined, where nothing else is said.
inline constexpr double path_gap_s = 1.0;

struct PlotCurve {
  std::string name;                     ///< in the legend; empty for another stretch of a curve that stands there
  std::string colour;                   ///< as CSS has it
  std::vector<Eigen::Vector2d> points;  ///< (time in s, value)
  std::string layer = {};               ///< method with which it is shown and hidden; its name where empty
  double lowered = 0.0;                 ///< drawn so far below its values: equal curves would hide each other
  double jump = 0.0;                    ///< values further apart than this are not joined; 0: all are
  double gap_s = path_gap_s;            ///< points further apart in time than this are not joined
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
  bool both_ways = false;  ///< values below zero too: the scale goes from -max to max
  bool small = false;      ///< one of several
};

/// Line plot over time from 0 to end_s with round ticks and a legend; gaps in a curve stay open, what
/// is beyond the scale is marked at its edge. As wide as the page lets it be: curves stretch, text does not. The script
/// fills in the legend's values.
[[nodiscard]] std::string draw_plot(const std::string& id, const std::vector<PlotCurve>& curves, double end_s,
                                    const PlotExtras& extras = {});

/// A step of 1, 2 or 5 times a power of ten that divides `span` into at most `count` parts.
[[nodiscard]] double round_step(double span, int count);

}  // namespace plumbline::scenarios
