// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/report/estimate/estimate_facts.h"
#include "scenarios/report/estimate/plan_drawing.h"
#include "scenarios/report/estimate/reference_errors.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// What a directory of `plumbline estimate` holds.
struct EstimateFiles {
  MethodRecord method;
  EstimateFacts facts;
  std::vector<slam::Nanoseconds> scans;  ///< on the recording's clock
  std::optional<PlanDrawing> plan;
  Tree scores;  ///< score.json; null where there is none
  std::vector<slam::StampedPose> reference;
  ReferenceKind reference_kind;
};

/// Throws InputError at the file that is missing or damaged. What an earlier version did not write is empty.
[[nodiscard]] EstimateFiles read_estimate_files(const std::string& dir);

/// What the reference of a score says of the method, by score.json, in sentences, and what it cannot say. Empty without
/// a reference.
[[nodiscard]] std::string reference_sentence(const EstimateFiles& files);

}  // namespace plumbline::scenarios
