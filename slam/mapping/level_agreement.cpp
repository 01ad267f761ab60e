// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/level_agreement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bim/median.h"
#include "slam/planes/level.h"

namespace plumbline::slam {

void LevelAgreement::add_step(const Pose& step, const Matrix6d& covariance) {
  ++keyframe_;
  sloping_since_.reset();
  const int oldest = keyframe_ - std::max(config_.keyframes, config_.way_keyframes);
  while (!latest_.empty() && latest_.front().keyframe < oldest) latest_.pop_front();
  const Matrix6d back = adjoint(step.inverse());
  for (Look& look : latest_) {
    look.X_KR = look.X_KR * step;
    look.covariance = back * look.covariance * back.transpose() + covariance;
  }
}

void LevelAgreement::drop_contradicted(std::vector<PlaneObservation>& seen) {
  if (!config_.drop) return;
  const auto most = static_cast<std::size_t>(config_.keyframes);
  std::vector<Look> newest;
  bool any_floor = false, any_contradicts = false;
  for (const PlaneObservation& plane : seen) {
    if (plane.vertical || !is_floor(plane)) continue;
    any_floor = true;
    any_contradicts |= contradicts_way(plane);
  }
  judge_slope(any_floor, any_contradicts);
  std::erase_if(seen, [&](const PlaneObservation& plane) {
    if (plane.vertical) return false;
    newest.push_back({plane, keyframe_, {}, Matrix6d::Zero()});
    std::deque<bool>& recent = contradictions_[is_floor(plane) ? 0 : 1];
    const std::vector<double> chi2s = chi2_to_latest(plane);
    recent.push_back(!chi2s.empty() && !(upper_median(chi2s) <= config_.usual_chi2));
    if (recent.size() > most) recent.pop_front();
    const auto count = static_cast<double>(std::count(recent.begin(), recent.end(), true));
    const bool unconfirmed = !is_floor(plane) && chi2s.empty();
    return recent.back() || unconfirmed || (slopes_ && is_floor(plane)) ||
           count > config_.contradicted_share * static_cast<double>(most);
  });
  latest_.insert(latest_.end(), newest.begin(), newest.end());
}

double LevelAgreement::chi2(const Look& former, const PlaneResidual& r, const PlaneObservation& level) {
  const Eigen::Matrix3d S = level.covariance + r.J_plane * former.level.covariance * r.J_plane.transpose() +
                            r.J_pose * former.covariance * r.J_pose.transpose();
  return r.e.dot(S.llt().solve(r.e));
}

std::vector<double> LevelAgreement::chi2_to_latest(const PlaneObservation& level) const {
  std::vector<double> chi2s;
  for (const Look& former : latest_) {
    if (former.keyframe < keyframe_ - config_.keyframes || is_floor(former.level) != is_floor(level)) continue;
    const PlaneResidual r = plane_residual(former.X_KR, former.level.plane_R, level.plane_R);
    if (std::abs(r.e.z()) > config_.near_m || r.e.head<2>().norm() > config_.near_rad) continue;
    chi2s.push_back(chi2(former, r, level));
  }
  return chi2s;
}

bool LevelAgreement::contradicts_way(const PlaneObservation& floor) const {
  if (config_.way_keyframes == 0) return false;
  // Twice the odometry's drift: where it is farther off than that, it is another storey's.
  constexpr double sigmas = 2.0;
  std::vector<double> chi2s;
  for (const Look& former : latest_) {
    if (former.keyframe > keyframe_ - config_.way_keyframes / 2 || !is_floor(former.level)) continue;
    const PlaneResidual r = plane_residual(former.X_KR, former.level.plane_R, floor.plane_R);
    const Eigen::Matrix3d way = r.J_pose * former.covariance * r.J_pose.transpose();
    const double most_m = config_.near_m + sigmas * std::sqrt(way(2, 2));
    const double most_rad = config_.near_rad + sigmas * std::sqrt(way(0, 0) + way(1, 1));
    if (std::abs(r.e.z()) > most_m || r.e.head<2>().norm() > most_rad) continue;
    chi2s.push_back(chi2(former, r, floor));
  }
  return static_cast<int>(chi2s.size()) >= config_.keyframes && upper_median(chi2s) > config_.way_chi2;
}

void LevelAgreement::judge_slope(bool seen, bool contradicts) {
  if (!seen) return;
  const auto most = static_cast<std::size_t>(config_.keyframes);
  way_contradictions_.push_back(contradicts);
  if (way_contradictions_.size() > most) way_contradictions_.pop_front();
  const auto count = static_cast<double>(std::count(way_contradictions_.begin(), way_contradictions_.end(), true));
  const bool sloped = slopes_;
  // As many again as it takes to find a slope must agree before the ground counts as level.
  slopes_ = count > config_.contradicted_share * static_cast<double>(most) || (sloped && count > 0.0);
  if (slopes_ && !sloped) sloping_since_ = latest_.front().keyframe;
}

}  // namespace plumbline::slam
