// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/load/load.h"

namespace plumbline::scenarios {

/// One element built otherwise than planned, seen from above.
struct ReportDeviation {
  std::string op;
  std::string element;
  Polygon2 planned_W;                    ///< where the plan has it, empty when it does not
  Polygon2 built_W;                      ///< where it stands, empty when it does not
  bool judged = false;                   ///< whether it was in sight on the walk is known
  std::optional<double> seen_at_s = {};  ///< since when, where it was
};

/// An element of one building seen from above; the storey it stands on, -1 when the building does not have it.
struct ElementOutline {
  int storey = -1;
  Polygon2 polygon_W;
};
[[nodiscard]] ElementOutline outline_in(const bim::Building& building, const std::string& id);

/// What differs on a storey, in the order of the site. Rooms have no outlines here.
[[nodiscard]] std::vector<ReportDeviation> report_deviations(const bim::PlannedAndBuilt& site, int storey);

/// What differs, how far and which way, and since when it was in sight: "wall w3 moved: 0.2 m towards +x; in sight from
/// 3.5 s on".
[[nodiscard]] std::string describe(const ReportDeviation& deviation);

/// Outlines over the plan: dashed where something was planned, filled where it was built.
[[nodiscard]] std::string draw_deviations(const std::vector<ReportDeviation>& deviations);
/// What the outlines mean, and all differences in words; empty when there are none.
[[nodiscard]] std::string list_deviations(const std::vector<ReportDeviation>& deviations);

}  // namespace plumbline::scenarios
