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
    recent.push_back(is_contradicted(plane));
    if (recent.size() > most) recent.pop_front();
    const auto count = static_cast<double>(std::count(recent.begin(), recent.end(), true));
    return recent.back() || count > config_.contradicted_share * static_cast<double>(most);
  });
  latest_.insert(latest_.end(), newest.begin(), newest.end());
}

double LevelAgreement::chi2(const Look& former, const PlaneResidual& r, const PlaneObservation& level) {
  const Eigen::Matrix3d S = level.covariance + r.J_plane * former.level.covariance * r.J_plane.transpose() +
                            r.J_pose * former.covariance * r.J_pose.transpose();
  return r.e.dot(S.llt().solve(r.e));
}

bool LevelAgreement::is_contradicted(const PlaneObservation& level) const {
  std::vector<double> compared;
  for (const Look& former : latest_) {
    if (is_floor(former.level) != is_floor(level)) continue;
    const PlaneResidual r = plane_residual(former.X_KR, former.level.plane_R, level.plane_R);
    if (std::abs(r.e.z()) > config_.near_m || r.e.head<2>().norm() > config_.near_rad) continue;
    compared.push_back(chi2(former, r, level));
  }
  return !compared.empty() && !(upper_median(std::move(compared)) <= config_.usual_chi2);
}

}  // namespace plumbline::slam
