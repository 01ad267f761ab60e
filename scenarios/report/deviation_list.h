// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/load/load.h"

namespace plumbline::scenarios {

/// One element built otherwise than planned, seen from above.
struct ReportDeviation {
  std::string op;
  std::string element;
  Polygon2 planned_W;  ///< where the plan has it, empty when it does not
  Polygon2 built_W;    ///< where it stands, empty when it does not
};

/// What differs on a storey, in the order of the site. Rooms have no outlines here.
[[nodiscard]] std::vector<ReportDeviation> report_deviations(const bim::PlannedAndBuilt& site, int storey);

/// What differs, how far and which way: "move wall w3: 0.2 m towards +x".
[[nodiscard]] std::string describe(const ReportDeviation& deviation);

/// Outlines over the plan: dashed where something was planned, filled where it was built.
[[nodiscard]] std::string draw_deviations(const std::vector<ReportDeviation>& deviations);
/// What the outlines mean, and all differences in words; empty when there are none.
[[nodiscard]] std::string list_deviations(const std::vector<ReportDeviation>& deviations);

}  // namespace plumbline::scenarios
