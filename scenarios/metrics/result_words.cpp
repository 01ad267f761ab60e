// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/result_words.h"

#include <vector>

#include "scenarios/metrics/localization_score.h"

namespace plumbline::scenarios::score {

std::span<const ResultWord> result_words() {
  using V = LocalizationVerdict;
  using F = Failure;
  constexpr std::string_view slam = "verdict of SLAM", place = "verdict of localization",
                             evidence = "localization.evidence", failure = "localization.failure";
  static const std::vector<ResultWord> words = {
      {slam, "complete", "at least 95 % of the scans have a pose, however wrong: gates judge the error"},
      {slam, "lost", "fewer than 95 % of the scans have a pose"},
      {slam, "crashed", "the method stopped with an error, which `error` gives; a localization may, too"},
      {place, to_string(V::success),
       "one answer at the end, and every pose right since the first one, for at least 5 s and 1 m"},
      {place, to_string(V::honest_ambiguity),
       "several poses explain the scans, and the hypotheses are these poses and no others"},
      {place, to_string(V::false_convergence), "a wrong pose was CONVERGED"},
      {place, to_string(V::overconfident),
       "several poses explain the scans, and the method gave one answer that was wrong or was not held"},
      {place, to_string(V::lucky),
       "one right answer, held to the end, although the scans had not yet excluded the other poses; never a success"},
      {place, to_string(V::late), "no answer, or one held for less than 5 s or 1 m"},
      {place, to_string(V::lost),
       "the right answer was given and lost or given up, or the method reports LOST at the end"},
      {evidence, to_string(Evidence::unique), "the pose is determined at least 5 s and 1 m before the end"},
      {evidence, to_string(Evidence::marginal),
       "the alternatives are nearly excluded, or too late for an answer of 5 s and 1 m; one right answer and an honest "
       "ambiguity are both right"},
      {evidence, to_string(Evidence::ambiguous),
       "another pose explains the scans as well as the true one, by the building alone, furniture left out"},
      {failure, to_string(F::never_sampled), "the true pose was never among hypotheses and kept particles"},
      {failure, to_string(F::depleted), "the true pose was among hypotheses and kept particles and was dropped"},
      {failure, to_string(F::alias_preferred), "a pose that looked like the true one at the start was chosen"},
      {failure, to_string(F::wrong_model), "a pose that looks different was chosen"},
      {failure, to_string(F::tracking_lost), "the right answer was given and lost"},
      {failure, to_string(F::undecided), "the true pose was present to the end and never chosen"},
  };
  return words;
}

}  // namespace plumbline::scenarios::score
