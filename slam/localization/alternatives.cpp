// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/alternatives.h"

#include <algorithm>

namespace plumbline::slam {

namespace {

HypothesisSet monitored(const LocalizationConfig& config) {
  HypothesisConfig hypotheses = config.search.hypotheses;
  hypotheses.history = config.monitor.scans;
  hypotheses.drop_ratio = config.monitor.drop_ratio;
  return {hypotheses, config.search.refine, config.search.likelihood, config.search.comparison};
}

}  // namespace

Alternatives::Alternatives(const LocalizationConfig& config)
    : config_(config.monitor), search_(config.search), hypotheses_(monitored(config)) {}

void Alternatives::clear() {
  hypotheses_.clear();
  since_check_m_ = 0.0;
}

bool Alternatives::is_same(const PoseHypothesis& hypothesis, const StoreyPose& tracked) const {
  return hypothesis.storey == tracked.storey &&
         is_near(hypothesis.X_IH, tracked.X_IH, search_.hypotheses.merge_m, search_.hypotheses.merge_rad);
}

void Alternatives::find(const PlanIndex& index, const StoreyPose& tracked, const LocalizationScan& scan,
                        GlobalLocalizer& search) {
  // Fitted to one scan it may slide to where a row of shelves looks like a wall.
  hypotheses_.add(index, std::vector<StoreyPose>{tracked});
  hypotheses_.add(index,
                  propose_poses(index, {}, scan, search_.filter.beam_stride, search_.likelihood, search_.proposals));
  hypotheses_.add(index, search.aliases(index, {tracked.storey, tracked.X_IH}, {}, scan));
}

bool Alternatives::is_one_better(const PlanIndex& index, const Tracked& tracked, const Step& step,
                                 const std::optional<ExpectedYaw>& yaw, GlobalLocalizer& search) {
  hypotheses_.expect_yaw(yaw);
  hypotheses_.predict_and_update(index, step.u, step.scan);
  since_check_m_ += step.u.t.norm();
  if (since_check_m_ < config_.every_m) return false;
  since_check_m_ = 0.0;
  const bool confirming = !hypotheses_.all().empty();
  if (!confirming) find(index, tracked.pose, step.scan, search);
  hypotheses_.prune_and_normalize();
  const std::vector<PoseHypothesis>& all = hypotheses_.all();
  const auto own =
      std::find_if(all.begin(), all.end(), [&](const PoseHypothesis& c) { return is_same(c, tracked.pose); });
  // The ratio alone is no proof: among clutter, poses with planned walls in front of much of what is seen beat the
  // right one.
  const double penetration_ratio = tracked.agreement.penetration_ratio_otherwise() + config_.penetration_ratio_margin;
  const bool worse = std::any_of(all.begin(), all.end(), [&](const PoseHypothesis& c) {
    const bool likelier = own == all.end() || c.evidence - own->evidence >= config_.log_ratio;
    return !is_same(c, tracked.pose) && likelier && c.agreement.inliers >= tracked.agreement.inliers &&
           c.agreement.penetration_ratio_otherwise() <= penetration_ratio;
  });
  if (!worse || confirming) hypotheses_.clear_hypotheses();
  return worse && confirming;
}

bool Alternatives::may_stand_elsewhere(const PlanIndex& index, const StoreyPose& tracked, const LocalizationScan& scan,
                                       GlobalLocalizer& search) {
  clear();
  hypotheses_.predict_and_update(index, Pose2{}, scan);
  find(index, tracked, scan, search);
  hypotheses_.prune_and_normalize();
  const std::vector<PoseHypothesis> all = hypotheses_.all();
  clear();
  const auto own = std::find_if(all.begin(), all.end(), [&](const PoseHypothesis& c) { return is_same(c, tracked); });
  return std::any_of(all.begin(), all.end(), [&](const PoseHypothesis& c) {
    return !is_same(c, tracked) && (own == all.end() || c.evidence > own->evidence - search_.convergence.log_ratio);
  });
}

}  // namespace plumbline::slam
