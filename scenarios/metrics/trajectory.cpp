// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/geometry/best_rotation.h"
#include "bim/geometry/symmetric.h"

namespace plumbline::scenarios::score {

namespace {

bool earlier(const slam::StampedPose& pose, slam::Nanoseconds t) { return pose.stamp < t; }

Eigen::Vector3d mean(const std::vector<PosePair>& pairs, Pose PosePair::*pose) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) sum += (pair.*pose).t;
  return sum / static_cast<double>(pairs.size());
}

}  // namespace

Pose Truth::at(slam::Nanoseconds t) const {
  if (poses_W.empty()) throw InternalError("score: the truth holds no pose");
  const auto next = std::lower_bound(poses_W.begin(), poses_W.end(), t, earlier);
  if (next == poses_W.end()) return poses_W.back().X_FR;
  if (next->stamp == t || next == poses_W.begin()) return next->X_FR;
  const slam::StampedPose& last = *std::prev(next);
  const double s = static_cast<double>(t - last.stamp) / static_cast<double>(next->stamp - last.stamp);
  return interpolate(last.X_FR, next->X_FR, s);
}

std::vector<double> Truth::walked() const {
  std::vector<double> distance(scans.size(), 0.0);
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const bool carried = set_down == scans[i];
    distance[i] = distance[i - 1] + (carried ? 0.0 : (at(scans[i]).t - at(scans[i - 1]).t).head<2>().norm());
  }
  return distance;
}

Truth Truth::before() const {
  Truth part = *this;
  if (!set_down) return part;
  part.set_down.reset();
  std::erase_if(part.scans, [&](slam::Nanoseconds t) { return t >= *set_down; });
  const slam::Nanoseconds last = part.scans.back();
  std::erase_if(part.poses_W, [&](const slam::StampedPose& pose) { return pose.stamp > last; });
  return part;
}

std::vector<PosePair> associate(const Truth& truth, const std::vector<slam::StampedPose>& poses_F,
                                const TrajectoryRules& rules) {
  const auto limit = static_cast<slam::Nanoseconds>(std::llround(rules.max_stamp_difference_s * 1e9));
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.scans.size(); ++i) {
    const slam::Nanoseconds t = truth.scans[i];
    auto best = std::lower_bound(poses_F.begin(), poses_F.end(), t, earlier);
    if (best != poses_F.begin()) {
      const auto before = std::prev(best);
      if (best == poses_F.end() || t - before->stamp <= best->stamp - t) best = before;
    }
    if (best == poses_F.end() || std::abs(best->stamp - t) > limit) continue;
    pairs.push_back({i, best->X_FR, truth.at(best->stamp)});
  }
  return pairs;
}

Pose umeyama(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) throw InternalError("score: nothing to align");
  const Eigen::Vector3d mean_F = mean(pairs, &PosePair::X_FR);
  const Eigen::Vector3d mean_W = mean(pairs, &PosePair::X_WR);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) covariance += (pair.X_WR.t - mean_W) * (pair.X_FR.t - mean_F).transpose();
  const Eigen::Quaterniond q_WF = Eigen::Quaterniond(best_rotation(covariance)).normalized();
  return {q_WF, mean_W - q_WF * mean_F};
}

Pose place_map(const std::vector<PosePair>& pairs) {
  constexpr double free_below_m = 0.5;  // rms distance from the line or point; the sway of a gait is far less. Assumed
  const Pose X_WF = umeyama(pairs);
  const Eigen::Vector3d mean_F = mean(pairs, &PosePair::X_FR), mean_W = X_WF * mean_F;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero(), attitudes = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d off = pair.X_WR.t - mean_W;
    spread += off * off.transpose() / static_cast<double>(pairs.size());
    attitudes += pair.X_WR.rotation() * (X_WF * pair.X_FR).rotation().transpose();
  }
  const auto axes = symmetric_eigen(spread);
  if (axes.values[1] >= free_below_m * free_below_m) return X_WF;
  Eigen::Matrix3d turn = best_rotation(attitudes);
  if (axes.values[2] >= free_below_m * free_below_m) {
    const Eigen::Vector3d u = axes.vectors.col(2);
    const Eigen::Vector3d twist(attitudes(2, 1) - attitudes(1, 2), attitudes(0, 2) - attitudes(2, 0),
                                attitudes(1, 0) - attitudes(0, 1));
    turn = Eigen::AngleAxisd(std::atan2(u.dot(twist), attitudes.trace() - u.dot(attitudes * u)), u).toRotationMatrix();
  }
  const Eigen::Quaterniond q_WF = (Eigen::Quaterniond(turn) * X_WF.q).normalized();
  return {q_WF, mean_W - q_WF * mean_F};
}

Pose place_by_first(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) throw InternalError("score: nothing to place by");
  return pairs.front().X_WR * pairs.front().X_FR.inverse();
}

double position_rmse(const std::vector<PosePair>& pairs, const Pose& X_WF) {
  if (pairs.empty()) throw InternalError("score: an error over no poses");
  double sum = 0.0;
  for (const PosePair& pair : pairs) sum += (X_WF * pair.X_FR.t - pair.X_WR.t).squaredNorm();
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

Pose motion_error(const PosePair& a, const PosePair& b) {
  return (a.X_WR.inverse() * b.X_WR).inverse() * (a.X_FR.inverse() * b.X_FR);
}

std::optional<RelativeErrors> relative_errors(const std::vector<PosePair>& pairs, const Truth& truth,
                                              double distance_m) {
  return relative_errors(pairs, truth.walked(), distance_m);
}

std::optional<RelativeErrors> relative_errors(const std::vector<PosePair>& pairs, const std::vector<double>& walked,
                                              double distance_m) {
  // Scans of a fast vehicle, or poses with a gap between them, may lie far beyond it.
  constexpr double longest = 2.0;
  RelativeErrors errors;
  int count = 0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double from = walked[pairs[i].scan];
    while (j < pairs.size() && walked[pairs[j].scan] < from + distance_m) ++j;
    if (j == pairs.size()) break;
    if (walked[pairs[j].scan] > from + longest * distance_m) continue;
    const Pose error = motion_error(pairs[i], pairs[j]);
    errors.translation_rmse_m += error.t.squaredNorm();
    errors.translation_mean_m += error.t.norm();
    errors.rotation_mean_rad += log_so3(error.q).norm();
    ++count;
  }
  if (count == 0) return std::nullopt;
  errors.translation_rmse_m = std::sqrt(errors.translation_rmse_m / count);
  errors.translation_mean_m /= count;
  errors.rotation_mean_rad /= count;
  return errors;
}

std::vector<std::optional<double>> errors_over(const std::vector<PosePair>& pairs, const std::vector<double>& walked,
                                               double distance_m) {
  std::vector<std::optional<double>> errors(pairs.size());
  std::size_t from = 0;  // one past the last pair that lies far enough back
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (from < i && walked[pairs[from].scan] + distance_m <= walked[pairs[i].scan]) ++from;
    if (from > 0) errors[i] = motion_error(pairs[from - 1], pairs[i]).t.norm();
  }
  return errors;
}

std::optional<TrajectoryScore> score_trajectory(const Truth& truth, const std::vector<slam::StampedPose>& causal_F,
                                                const std::vector<slam::StampedPose>& final_F,
                                                const TrajectoryRules& rules) {
  const std::vector<PosePair> causal = associate(truth, causal_F, rules);
  if (causal.empty()) return std::nullopt;
  TrajectoryScore score;
  score.coverage = static_cast<double>(causal.size()) / static_cast<double>(truth.scans.size());
  score.ate_rmse_m = position_rmse(causal, place_by_first(causal));
  score.ate_aligned_rmse_m = position_rmse(causal, umeyama(causal));
  if (const auto errors = relative_errors(causal, truth, rules.rpe_distance_m))
    score.rpe_1m_rmse_m = errors->translation_rmse_m;
  if (const auto drift = relative_errors(causal, truth, rules.drift_distance_m)) {
    score.drift_10m_percent = 100.0 * drift->translation_mean_m / rules.drift_distance_m;
    score.drift_10m_deg_per_m = drift->rotation_mean_rad / rules.drift_distance_m * 180.0 / std::numbers::pi;
  }
  const std::vector<PosePair> last = associate(truth, final_F, rules);
  score.X_WF_final = place_map(last.empty() ? causal : last);
  const bool covers = static_cast<double>(last.size()) >= rules.min_coverage * static_cast<double>(truth.scans.size());
  if (!last.empty() && covers) score.ate_final_rmse_m = position_rmse(last, umeyama(last));
  return score;
}

}  // namespace plumbline::scenarios::score
