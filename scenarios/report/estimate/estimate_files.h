// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/report/estimate/estimate_facts.h"
#include "scenarios/report/estimate/plan_drawing.h"
#include "scenarios/report/estimate/reference_errors.h"
#include "scenarios/report/estimate/score_file.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// What a directory of `plumbline estimate` holds.
struct EstimateFiles {
  MethodRecord method;
  EstimateFacts facts;
  std::vector<slam::Nanoseconds> scans;  ///< on the recording's clock
  std::optional<PlanDrawing> plan;
  std::optional<EstimateScores> scores;
  std::vector<slam::StampedPose> reference;
  ReferenceKind reference_kind;
};

/// Throws InputError at the file that is missing or damaged. What an earlier version did not write is empty. fresh: in
/// place of the files of a score.
[[nodiscard]] EstimateFiles read_estimate_files(const std::string& dir, const std::optional<NewScore>& fresh = {});

/// What the reference of a score says of the method, by score.json, in sentences, and what it cannot say. Empty without
/// a reference.
[[nodiscard]] std::string reference_sentence(const EstimateFiles& files);

}  // namespace plumbline::scenarios
