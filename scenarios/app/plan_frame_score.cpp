// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/plan_frame_score.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "bim/errors.h"
#include "bim/median.h"
#include "scenarios/report/svg.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

namespace {

using Poses = std::vector<slam::StampedPose>;

/// Whether a time lies between two poses of the reference that follow one another without a pause.
class Covers {
 public:
  explicit Covers(const Poses& reference) : reference_(reference) {
    constexpr slam::Nanoseconds intervals = 3;  // as score_by_reference()
    std::vector<slam::Nanoseconds> steps;
    for (std::size_t i = 1; i < reference.size(); ++i) steps.push_back(reference[i].stamp - reference[i - 1].stamp);
    longest_ = steps.empty() ? 0 : intervals * upper_median(steps);
  }
  [[nodiscard]] bool operator()(slam::Nanoseconds stamp) const {
    const auto next =
        std::lower_bound(reference_.begin(), reference_.end(), stamp,
                         [](const slam::StampedPose& pose, slam::Nanoseconds t) { return pose.stamp < t; });
    if (next == reference_.end()) return false;
    if (next->stamp == stamp) return true;
    return next != reference_.begin() && next->stamp - std::prev(next)->stamp <= longest_;
  }

 private:
  const Poses& reference_;
  slam::Nanoseconds longest_ = 0;
};

}  // namespace

PlanFrameScore score_in_plan_frame(const MethodRecord& method, const std::vector<slam::StampedPose>& reference_W,
                                   bool positions_alone, const std::string& file) {
  score::Truth truth;
  truth.poses_W = reference_W;
  std::vector<score::Belief> beliefs = score::beliefs_of(method, truth);
  const double scans = static_cast<double>(beliefs.size());
  const Covers covers(reference_W);
  std::erase_if(beliefs, [&](const score::Belief& belief) { return !covers(belief.stamp); });
  if (beliefs.empty()) throw InputError({file, 0, 0}, "covers none of the scans");
  for (const score::Belief& belief : beliefs) truth.scans.push_back(belief.stamp);
  score::LocalizationRules rules;
  if (positions_alone) rules.yaw_deg = 180.0;
  score::MethodScore score;
  score.name = method.name;
  score.localization = score::score_localization(truth, beliefs, {}, rules);
  if (positions_alone) score.localization->yaw_rmse_deg = score.localization->nees = {};
  score.verdict = to_string(score.localization->verdict);
  return {std::move(score), static_cast<double>(beliefs.size()) / scans};
}

std::string words_of(const PlanFrameScore& in_plan_frame) {
  const score::LocalizationScore& score = *in_plan_frame.score.localization;
  std::string text = "in the plan's frame, not aligned: " + in_plan_frame.score.verdict;
  if (!score.converged_at_s) return text + "; never CONVERGED";
  text += "; CONVERGED after " + svg::number(*score.converged_at_s, 1) + " s and " +
          svg::number(*score.converged_at_m, 1) + " m, error from then on " + svg::number(*score.ape_rmse_m, 3) + " m";
  if (score.yaw_rmse_deg) text += " and " + svg::number(*score.yaw_rmse_deg, 2) + " deg";
  text += " rms";
  if (in_plan_frame.judged_share < 1.0)
    text +=
        "; the reference covers " + std::to_string(std::lround(100.0 * in_plan_frame.judged_share)) + " % of the scans";
  return text;
}

}  // namespace plumbline::scenarios
