// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenarios/report/report.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// What a reference can say.
struct ReferenceKind {
  bool in_plan_frame = false;    ///< its poses are in the plan's frame and stay there; else they are aligned
  bool positions_alone = false;  ///< its poses have one orientation throughout
};

/// Stamps of the first scan and the last one.
struct ScanRange {
  slam::Nanoseconds first = 0, last = 0;
};

/// Lays a reference beside the causal path of an estimate, in the estimate's frame: aligned over all of it
/// [umeyama1991] or, in the plan's frame, as it stands. Samples get their errors where the reference has poses around
/// them, by positions alone none over the last metre; `samples` has one for each of the causal poses. Returns the
/// reference during the scans; times count from the first. Nothing happens, and it is empty, where fewer poses match
/// than an alignment wants.
[[nodiscard]] std::vector<ReportSample> lay_reference(const std::vector<slam::StampedPose>& reference,
                                                      const MethodRecord& method, const ReferenceKind& kind,
                                                      const ScanRange& scans, std::vector<ReportSample>& samples);

}  // namespace plumbline::scenarios
