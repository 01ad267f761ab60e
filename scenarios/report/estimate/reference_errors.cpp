// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/reference_errors.h"

#include <optional>
#include <utility>

#include "scenarios/metrics/reference_axes.h"
#include "scenarios/metrics/reference_score.h"

namespace plumbline::scenarios {

namespace {

/// Poses of the estimate beside those of the reference, at the stamps of the estimate.
std::vector<score::PosePair> pairs_at_estimate(const std::vector<slam::StampedPose>& reference,
                                               const std::vector<slam::StampedPose>& poses) {
  std::vector<score::PosePair> pairs = score::match_reference(poses, reference);
  for (score::PosePair& pair : pairs) std::swap(pair.X_FR, pair.X_WR);
  return pairs;
}

/// Distance along the reference to each pose of the estimate, m; of those without a pair, to the one before.
std::vector<double> distances_to(const std::vector<score::PosePair>& pairs, std::size_t poses) {
  std::vector<double> distances(poses, 0.0);
  double distance = 0.0;
  std::size_t pose = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0) distance += (pairs[i].X_WR.t - pairs[i - 1].X_WR.t).norm();
    for (; pose < pairs[i].scan; ++pose) distances[pose] = pose == 0 ? 0.0 : distances[pose - 1];
    distances[pose++] = distance;
  }
  for (; pose < poses; ++pose) distances[pose] = distance;
  return distances;
}

}  // namespace

std::vector<ReportSample> lay_reference(const std::vector<slam::StampedPose>& reference, const MethodRecord& method,
                                        const ReferenceKind& kind, const ScanRange& scans,
                                        std::vector<ReportSample>& samples) {
  const score::ReferenceRules rules;
  if (reference.empty() || method.causal.empty() || samples.size() != method.causal.size()) return {};
  const std::vector<score::PosePair> matched = score::match_reference(reference, method.causal);
  if (matched.size() < rules.least_matched) return {};
  const Pose X_FW = kind.in_plan_frame ? Pose() : score::umeyama(matched).inverse();
  const bool by_positions = kind.in_plan_frame || kind.positions_alone;
  const Pose shown_X_FW = by_positions ? X_FW : score::place_map(matched).inverse();
  const std::vector<score::PosePair> pairs = pairs_at_estimate(reference, method.causal);
  const std::vector<std::optional<double>> relative =
      score::errors_over(pairs, distances_to(pairs, samples.size()), rules.rpe_distance_m);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ReportSample& sample = samples[pairs[i].scan];
    sample.judged = true;
    sample.error_W = pairs[i].X_FR.t - X_FW * pairs[i].X_WR.t;
    sample.error_m = sample.error_W.norm();
    if (kind.positions_alone) continue;
    sample.yaw_error = ((shown_X_FW * pairs[i].X_WR).inverse() * pairs[i].X_FR).yaw();
    sample.relative_m = relative[i];
  }
  std::vector<ReportSample> shown;
  for (const slam::StampedPose& pose : reference) {
    if (pose.stamp < scans.first || pose.stamp > scans.last) continue;
    const Pose X_FR = shown_X_FW * pose.X_FR;
    shown.push_back({slam::seconds(pose.stamp - scans.first), X_FR.t.x(), X_FR.t.y(), X_FR.yaw()});
  }
  return shown;
}

}  // namespace plumbline::scenarios
