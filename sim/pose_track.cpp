// SPDX-License-Identifier: Apache-2.0
#include "sim/pose_track.h"

#include <algorithm>

#include "bim/errors.h"

namespace plumbline::sim {

void PoseTrack::add(slam::Nanoseconds stamp, const Pose& X_WR) {
  if (!poses_.empty() && stamp <= poses_.back().stamp) throw InternalError("poses of a track must ascend in time");
  poses_.push_back({stamp, X_WR});
}

Pose PoseTrack::at(slam::Nanoseconds t) const {
  if (poses_.empty() || t < poses_.front().stamp || t > poses_.back().stamp)
    throw InternalError("the requested pose lies outside the track");
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), t,
                                      [](const Stamped& p, slam::Nanoseconds time) { return p.stamp < time; });
  if (after->stamp == t) return after->X_WR;
  const auto before = after - 1;
  const double s = static_cast<double>(t - before->stamp) / static_cast<double>(after->stamp - before->stamp);
  return interpolate(before->X_WR, after->X_WR, s);
}

void PoseTrack::forget_before(slam::Nanoseconds t) {
  while (poses_.size() > 1 && poses_[1].stamp <= t) poses_.pop_front();
}

}  // namespace plumbline::sim
