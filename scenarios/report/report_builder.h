// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenarios/report/report.h"
#include "scenarios/run/finished_run.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

/// What the page shows of a scored run: everything in W, SLAM methods placed by their alignment to the truth.
[[nodiscard]] ReportInput report_input(const FinishedRun& run, const score::RunScore& score);

}  // namespace plumbline::scenarios
