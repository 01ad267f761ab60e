// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/report/plot.h"
#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// One error over time: how its plot is drawn, and under which key the page's data hold it.
struct ErrorKind {
  std::string_view id;      ///< of the plot
  std::string_view title;   ///< with its unit
  std::string_view column;  ///< of a track, in metres or radians
  std::string_view unit;
  double scale;  ///< from metres or radians to the unit
  int decimals;
  bool both_ways;  ///< it has a sign
  std::optional<double> (*value)(const ReportSample& sample);
  double jump = 0.0;  ///< of its unit: further apart a curve is not joined; 0: always
};

/// The position error first, then the others.
[[nodiscard]] std::span<const ErrorKind> error_kinds();

/// Errors of all methods over time, a plot for each kind.
[[nodiscard]] std::string draw_errors(const ReportInput& input, double end_s);

/// One kind of error of all methods over time, alone; `small`: as one of several.
[[nodiscard]] std::string draw_error(const ReportInput& input, const ErrorKind& kind, double end_s, bool small);

/// How many poses are left to each plan localization, and how many the scans admit; empty where none has hypotheses.
[[nodiscard]] std::string draw_hypothesis_counts(const ReportInput& input, double end_s);

/// Curves of that plot.
[[nodiscard]] std::vector<PlotCurve> hypothesis_counts(const ReportInput& input, double end_s);

}  // namespace plumbline::scenarios
