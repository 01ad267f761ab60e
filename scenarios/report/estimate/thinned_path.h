// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// Of a long path one sample in so many is drawn; 1 of one with at most 5000.
[[nodiscard]] std::size_t drawn_one_in(std::size_t samples);

/// One in `every`, the first and the last, and those on both sides of where a storey or a time of being lost begins or
/// ends, up to 5000 of these.
[[nodiscard]] std::vector<ReportSample> thinned_path(const std::vector<ReportSample>& samples, std::size_t every);

/// Where a path is not joined once it is thinned to one in `every`: what several of its usual steps do not reach, in
/// time or in space, so that paths of fast, slow and sparse sources stay whole.
[[nodiscard]] PathBreaks breaks_of(const std::vector<ReportSample>& samples, std::size_t every);

}  // namespace plumbline::scenarios
