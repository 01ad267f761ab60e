// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/report/estimate/estimate_facts.h"
#include "scenarios/report/estimate/reference_errors.h"
#include "scenarios/report/estimate/state_spans.h"
#include "scenarios/report/report.h"

namespace plumbline::scenarios {

inline constexpr std::string_view estimate_page_name = "report.html";
inline constexpr std::string_view scores_name = "score.json";
/// A reference that score was given, as it was compared.
inline constexpr std::string_view reference_name = "reference.tum";

/// Everything the page of an estimate shows.
struct EstimatePage {
  ReportInput input;  ///< its maps and plots: one method; a reference, where there is one, as the truth
  EstimateFacts facts;
  std::string state;         ///< in which it ended, as final_state()
  std::string answer;        ///< as answer_sentence()
  std::string by_reference;  ///< what the reference says of it, sentences, or empty
  ReferenceKind reference = {};
  std::vector<StateSpan> spans;      ///< of SLAM; a localization has its own in `input`
  std::vector<double> scans_s = {};  ///< times of the scans since the first
  std::vector<ScanPause> pauses;
  slam::Nanoseconds first_scan = 0;  ///< on the recording's clock
  std::vector<std::string> altered;  ///< files of the estimate that are not as they were written
  bool has_map = false;              ///< points of its map lie under the path
  bool has_numbers = true;           ///< `input` has results of the method
  bool has_marks = false;            ///< hypotheses at the end are marked on the map
  std::size_t thinned = 1;           ///< one in so many poses is drawn
};

/// One self-contained HTML page, as that of a run: what the method answered, its path on the plan or on its own map,
/// the recording's scans, states and hypotheses over time, errors where there is a reference, what it was made of. The
/// same input gives the same bytes.
[[nodiscard]] std::string render_estimate(const EstimatePage& page);

}  // namespace plumbline::scenarios
