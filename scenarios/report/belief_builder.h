// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "scenarios/report/report.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// A place of the robot on a map.
struct ReportPlace {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  int storey = 0;
};

/// What a page knows beside the beliefs of a method.
struct BeliefContext {
  slam::Nanoseconds origin = 0;  ///< time 0 of the page
  std::function<ReportPlace(slam::Nanoseconds)> place;
  /// Which walls matched at a hypothesis are the right ones; without it none is.
  std::function<std::vector<bool>(slam::Nanoseconds, const slam::Hypothesis&)> right;
};

/// States and numbers of hypotheses at every scan, and the particles at the start, half-way to the convergence (or the
/// end) and there.
void add_beliefs(const MethodRecord& method, const BeliefContext& context, ReportMethod& shown);

/// The walls matched half-way to the first convergence (or the end), there, and at the end, where they were kept.
void add_matched_walls(const MethodRecord& method, const bim::Plan& as_planned, const BeliefContext& context,
                       ReportMethod& shown);

}  // namespace plumbline::scenarios
