// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/report/map_drawing.h"
#include "scenarios/report/plot.h"
#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// When the robot was kidnapped, and when its scans left a single pose: the same for every method.
[[nodiscard]] std::vector<PlotMark> common_marks(const ReportInput& input);

/// Shares of its hypotheses over time, %.
[[nodiscard]] std::vector<PlotCurve> belief_curves(const ReportMethod& method);

/// An arrow at a hypothesis with its share, in [0, 1], beside it.
[[nodiscard]] std::string draw_hypothesis_mark(const Pose& X_WR, double mass);

/// Of each plan localization: the share of every pose hypothesis over time, its state, the walls it
/// recognised and its particles.
[[nodiscard]] std::string draw_beliefs(const ReportInput& input, const MapBox& box, double end_s);

}  // namespace plumbline::scenarios
