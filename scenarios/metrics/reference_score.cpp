// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/reference_score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/median.h"

namespace plumbline::scenarios::score {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

/// Distance from the first pose along the path to each pose, m.
std::vector<double> distances_of(const std::vector<slam::StampedPose>& poses) {
  std::vector<double> distances(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i)
    distances[i] = distances[i - 1] + (poses[i].X_FR.t - poses[i - 1].X_FR.t).norm();
  return distances;
}

/// The longest time over which poses are interpolated, ns.
double longest_interval(const std::vector<slam::StampedPose>& poses, const ReferenceRules& rules) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < poses.size(); ++i)
    intervals.push_back(static_cast<double>(poses[i].stamp - poses[i - 1].stamp));
  return intervals.empty() ? 0.0 : rules.most_intervals * median(std::move(intervals));
}

void score_steps(const std::vector<PosePair>& pairs, ReferenceScore& score) {
  std::vector<double> meters, turns;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    if (pairs[i].scan != pairs[i - 1].scan + 1) continue;
    const Pose error = motion_error(pairs[i - 1], pairs[i]);
    meters.push_back(error.t.norm());
    turns.push_back(degrees * log_so3(error.q).norm());
  }
  if (meters.empty()) return;
  StepErrors& steps = score.steps.emplace();
  steps.max_m = *std::max_element(meters.begin(), meters.end());
  steps.rotation_max_deg = *std::max_element(turns.begin(), turns.end());
  steps.median_m = median(std::move(meters));
  steps.rotation_median_deg = median(std::move(turns));
}

}  // namespace

PathScore score_path(const std::vector<slam::StampedPose>& poses_F) {
  PathScore score;
  score.poses = poses_F.size();
  if (poses_F.empty()) return score;
  score.duration_s = slam::seconds(poses_F.back().stamp - poses_F.front().stamp);
  score.length_m = distances_of(poses_F).back();
  if (score.length_m > 0.0)
    score.straightness = (poses_F.back().X_FR.t - poses_F.front().X_FR.t).norm() / score.length_m;
  const auto [low, high] = std::minmax_element(
      poses_F.begin(), poses_F.end(),
      [](const slam::StampedPose& a, const slam::StampedPose& b) { return a.X_FR.t.z() < b.X_FR.t.z(); });
  score.vertical_m = high->X_FR.t.z() - low->X_FR.t.z();
  return score;
}

std::vector<PosePair> match_reference(const std::vector<slam::StampedPose>& reference_W,
                                      const std::vector<slam::StampedPose>& poses_F, const ReferenceRules& rules) {
  const auto tolerance = static_cast<slam::Nanoseconds>(std::llround(rules.end_tolerance_s * 1e9));
  const double longest = longest_interval(poses_F, rules);
  const Truth estimate{poses_F, {}};  // interpolates
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < reference_W.size(); ++i) {
    const slam::Nanoseconds t = reference_W[i].stamp;
    if (t < poses_F.front().stamp - tolerance || t > poses_F.back().stamp + tolerance) continue;
    const auto next =
        std::lower_bound(poses_F.begin(), poses_F.end(), t,
                         [](const slam::StampedPose& pose, slam::Nanoseconds at) { return pose.stamp < at; });
    const bool between = next != poses_F.begin() && next != poses_F.end() && next->stamp != t;
    if (between && static_cast<double>(next->stamp - std::prev(next)->stamp) > longest) continue;
    pairs.push_back({i, estimate.at(t), reference_W[i].X_FR});
  }
  return pairs;
}

std::optional<ReferenceScore> score_by_reference(const std::vector<slam::StampedPose>& reference_W,
                                                 const std::vector<slam::StampedPose>& poses_F,
                                                 const ReferenceRules& rules) {
  if (reference_W.empty() || poses_F.empty()) return std::nullopt;
  const std::vector<PosePair> pairs = match_reference(reference_W, poses_F, rules);
  if (pairs.size() < rules.least_matched) return std::nullopt;
  ReferenceScore score;
  score.matched = pairs.size();
  score.ate_aligned_rmse_m = position_rmse(pairs, umeyama(pairs));
  score_steps(pairs, score);
  if (const auto errors = relative_errors(pairs, distances_of(reference_W), rules.rpe_distance_m)) {
    score.rpe_1m_rmse_m = errors->translation_rmse_m;
    score.rpe_1m_rotation_deg = degrees * errors->rotation_mean_rad;
  }
  return score;
}

}  // namespace plumbline::scenarios::score
