// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/plan_frame_score.h"

#include <utility>

#include "bim/errors.h"
#include "scenarios/report/svg.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

score::MethodScore score_in_plan_frame(const MethodRecord& method, const std::vector<slam::StampedPose>& reference_W,
                                       bool positions_alone, const std::string& file) {
  score::Truth truth;
  truth.poses_W = reference_W;
  std::vector<score::Belief> beliefs = score::beliefs_of(method, truth);
  std::erase_if(beliefs, [&](const score::Belief& belief) {
    return belief.stamp < reference_W.front().stamp || belief.stamp > reference_W.back().stamp;
  });
  if (beliefs.empty()) throw InputError({file, 0, 0}, "covers none of the scans");
  for (const score::Belief& belief : beliefs) truth.scans.push_back(belief.stamp);
  score::LocalizationRules rules;
  if (positions_alone) rules.yaw_deg = 180.0;
  score::MethodScore score;
  score.name = method.name;
  score.localization = score::score_localization(truth, beliefs, {}, rules);
  if (positions_alone) score.localization->yaw_rmse_deg = score.localization->nees = {};
  score.verdict = to_string(score.localization->verdict);
  return score;
}

std::string words_of(const score::MethodScore& in_plan_frame) {
  const score::LocalizationScore& score = *in_plan_frame.localization;
  std::string text = "in the plan's frame, not aligned: " + in_plan_frame.verdict;
  if (!score.converged_at_s) return text + "; never CONVERGED";
  text += "; CONVERGED after " + svg::number(*score.converged_at_s, 1) + " s and " +
          svg::number(*score.converged_at_m, 1) + " m, error from then on " + svg::number(*score.ape_rmse_m, 3) + " m";
  if (score.yaw_rmse_deg) text += " and " + svg::number(*score.yaw_rmse_deg, 2) + " deg";
  return text + " rms";
}

}  // namespace plumbline::scenarios
