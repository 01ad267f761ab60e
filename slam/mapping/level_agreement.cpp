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
  while (!latest_.empty() && latest_.front().keyframe < keyframe_ - config_.keyframes) latest_.pop_front();
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
  std::erase_if(seen, [&](const PlaneObservation& plane) {
    if (plane.vertical) return false;
    newest.push_back({plane, keyframe_, {}, Matrix6d::Zero()});
    std::deque<bool>& recent = contradictions_[is_floor(plane) ? 0 : 1];
    const std::vector<double> chi2s = chi2_to_latest(plane);
    recent.push_back(!chi2s.empty() && !(upper_median(chi2s) <= config_.usual_chi2));
    if (recent.size() > most) recent.pop_front();
    const auto count = static_cast<double>(std::count(recent.begin(), recent.end(), true));
    const bool unconfirmed = !is_floor(plane) && chi2s.empty();
    return recent.back() || unconfirmed || count > config_.contradicted_share * static_cast<double>(most);
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
    if (is_floor(former.level) != is_floor(level)) continue;
    const PlaneResidual r = plane_residual(former.X_KR, former.level.plane_R, level.plane_R);
    if (std::abs(r.e.z()) > config_.near_m || r.e.head<2>().norm() > config_.near_rad) continue;
    chi2s.push_back(chi2(former, r, level));
  }
  return chi2s;
}

}  // namespace plumbline::slam
