// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/localization/hypotheses.h"
#include "slam/localization/wall_crossing.h"

namespace plumbline::slam {

// One scan of a turn may be off. It must not stand for others where all of them can be replayed.
std::size_t HypothesisSet::replay_stride() const {
  const auto stride = static_cast<std::size_t>(config_.replay_stride);
  const std::size_t most = std::max<std::size_t>(1, static_cast<std::size_t>(config_.history) / stride);
  return std::max<std::size_t>(1, (history_.size() + most - 1) / most);
}

const HypothesisSet::ReplayedReference& HypothesisSet::replayed_reference(const PlanIndex& index) {
  const StoreyPose pose = hypotheses_[reference_].pose();
  const auto is_kept = [&](const ReplayedReference& kept) {
    return kept.pose.storey == pose.storey && kept.pose.X_IH.t == pose.X_IH.t && kept.pose.X_IH.yaw == pose.X_IH.yaw;
  };
  if (!replayed_reference_ || !is_kept(*replayed_reference_))
    replayed_reference_ = {pose, replay(index, fitted_to_last_scan(index, pose), {}).scans, {}};
  return *replayed_reference_;
}

const std::vector<HypothesisSet::ScanAtPose>& HypothesisSet::screening_of_reference(const PlanIndex& index) {
  static_cast<void>(replayed_reference(index));
  if (replayed_reference_->screening.empty())
    replayed_reference_->screening =
        replay(index, fitted_to_last_scan(index, replayed_reference_->pose), {}, Grid::screening).scans;
  return replayed_reference_->screening;
}

bool HypothesisSet::is_screened_out(const PlanIndex& index, const StoreyPose& start) {
  if (hypotheses_.empty() || config_.screening_columns == 1) return false;
  return replay(index, start, screening_of_reference(index), Grid::screening).evidence <
         -config_.drop_ratio - config_.screening_margin;
}

StoreyPose HypothesisSet::fitted_to_last_scan(const PlanIndex& index, const StoreyPose& pose) const {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
  return {pose.storey, refine(storey, pose.X_IH, history_.back().scan, likelihood_, tracking_refine_).X_IH};
}

void HypothesisSet::replay_agreement(const StoreyIndex& storey, const std::vector<ScanAtPose>& scans,
                                     PoseHypothesis& hypothesis) const {
  const std::size_t stride = replay_stride();
  for (std::size_t k = scans.size(); k-- > 0;) {
    const LocalizationScan& scan = history_[history_.size() - 1 - k * stride].scan;
    const Agreement seen = agreement(storey, scans[k].X_IH, scan, likelihood_, refine_);
    if (k + 1 == scans.size()) hypothesis.agreement = seen;
    for (std::size_t i = 0; i < static_cast<std::size_t>(scans[k].represented_scans); ++i)
      update_agreement(seen, history_[history_.size() - 1 - k * stride - i].share, hypothesis);
  }
}

void HypothesisSet::replay_best_agreement(const PlanIndex& index) {
  if (hypotheses_.empty() || history_.empty()) return;
  PoseHypothesis& best = hypotheses_.front();
  best.fit = best.fit_sum = best.scans = 0.0;
  replay_agreement(index.storeys[static_cast<std::size_t>(best.storey)],
                   replay(index, fitted_to_last_scan(index, best.pose()), {}).scans, best);
}

void HypothesisSet::accumulate_evidence(const LocalizationScan& scan, const ScanAtPose& own,
                                        const ScanAtPose& reference, const HypothesisComparisonConfig& config,
                                        EvidenceBalance& balance) const {
  const auto add_crossings = [&](const std::vector<int>& more, const std::vector<int>& than, const Structure& structure,
                                 EvidenceByCause& evidence) {
    for (std::size_t i = than.size(); i < more.size(); ++i)
      evidence.add({OutlierCause::Kind::not_built, more[i]}, config_.crossing_cost,
                   structure.is_wall(more[i]) ? config_.crossing_cost : 0.0);
  };
  add_crossings(own.crossed, reference.crossed, *own.predicted.storey->structure, balance.against);
  add_crossings(reference.crossed, own.crossed, *reference.predicted.storey->structure, balance.supporting);
  const PairwiseLikelihoodRatio comparison = compare_hypotheses(scan, own.predicted, reference.predicted, config);
  const double size = std::abs(comparison.ratio);
  if (size <= config_.deadband) return;
  const double scale = own.represented_scans * std::min(size - config_.deadband, config_.step_cap) / size;
  balance.against.add(comparison.against_a, scale);
  balance.supporting.add(comparison.against_b, scale);
}

void HypothesisSet::compare_all_with_reference(const PlanIndex& index) {
  const std::vector<ScanAtPose>& scans = replayed_reference(index).scans;
  for (PoseHypothesis& hypothesis : hypotheses_) {
    Replay past;
    if (&hypothesis != &hypotheses_[reference_])
      past = replay(index, fitted_to_last_scan(index, hypothesis.pose()), scans);
    hypothesis.balance = std::move(past.balance);
    hypothesis.evidence = past.evidence + yaw_evidence(hypothesis.X_IH);
  }
}

HypothesisSet::Replay HypothesisSet::replay(const PlanIndex& index, const StoreyPose& start,
                                            const std::vector<ScanAtPose>& reference, Grid grid) const {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(start.storey)];
  const bool screening = grid == Grid::screening;
  const double dropped = -config_.drop_ratio - (screening ? config_.screening_margin : 0.0);
  const std::size_t stride = screening ? static_cast<std::size_t>(config_.replay_stride) : replay_stride();
  Pose2 X = start.X_IH;
  Replay past;
  std::vector<int> crossed;
  for (std::size_t back = 0; back < history_.size(); ++back) {
    const HistoryStep& step = history_[history_.size() - 1 - back];
    const LocalizationScan& scan = screening ? step.screening : step.scan;
    const bool is_sampled = back % stride == 0;
    if (is_sampled && back > 0) X = refine(storey, X, scan, likelihood_, tracking_refine_).X_IH;
    const Pose2 before = X * step.u.inverse();
    add_crossed_element(storey, before, X, index.config.body_height_m, crossed);
    if (is_sampled) {
      const int represented_scans = static_cast<int>(std::min(stride, history_.size() - back));
      past.scans.push_back({X, predict_scan(storey, X, scan, comparison_), std::move(crossed), represented_scans});
      crossed.clear();
    }
    X = before;
    const std::size_t k = past.scans.size() - 1;
    if (!is_sampled || k >= reference.size()) continue;
    accumulate_evidence(scan, past.scans[k], reference[k], comparison_, past.balance);
    past.scans[k].predicted = {};
    past.evidence = past.balance.evidence(comparison_);
    if (past.evidence < dropped) break;
  }
  return past;
}

}  // namespace plumbline::slam
