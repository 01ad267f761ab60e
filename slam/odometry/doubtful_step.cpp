// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/doubtful_step.h"

#include <algorithm>

#include "slam/registration/coarse_search.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t most_doubts = 4;  ///< assumed; after more of them only a loop closure ends LOST

}  // namespace

DoubtfulStep::DoubtfulStep(const VgicpOdometry& matcher, const Scan& scan) : before_(matcher.maps()), scans_{scan} {}

void DoubtfulStep::add_doubtful(const Scan& scan) {
  if (scans_.size() <= most_doubts) scans_.push_back(scan);
  confirmed_ = 0;
  X_MR_.reset();
}

void DoubtfulStep::add(const VgicpOdometry& matcher, const Pose& X_MR, bool expected) {
  if (!expected || scans_.size() > most_doubts) {
    confirmed_ = 0;
    X_MR_.reset();
    return;
  }
  const Registration here = matcher.place_in(before_, X_MR);
  // An alias that fits one view fits the same view again.
  constexpr double new_view_m = 0.3, new_view_rad = 0.35;  // both assumed
  const Pose way = X_MR_ ? X_MR_->inverse() * X_MR : Pose{};
  const bool seen = X_MR_ && way.t.norm() < new_view_m && log_so3(way.q).norm() < new_view_rad;
  if (!fits(here, X_MR) || (!seen && fits_elsewhere(matcher, here, X_MR))) {
    confirmed_ = 0;
    X_MR_.reset();
  } else if (!seen) {
    ++confirmed_;
    X_MR_ = X_MR;
  }
}

bool DoubtfulStep::is_settled() const {
  constexpr int enough = 5;  // assumed; looked at on a walk through a hall at 2 Hz with a turn of 54 degrees
  return confirmed_ >= enough;
}

bool DoubtfulStep::fits(const Registration& here, const Pose& X_MR) const {
  // Half of a voxel of the local map, and what that turns a room: assumed. In that hall it was 4 mm.
  constexpr double same_m = 0.1, same_rad = 0.02, about = 1.5;
  const Pose off = here.X_MR.inverse() * X_MR;
  const Scan& first = scans_.front();
  return off.t.norm() < same_m && log_so3(off.q).norm() < same_rad && here.degenerate_directions == 0 &&
         here.matched >= first.sure_share * first.usual_matched && here.residual_m <= about * first.usual_residual_m;
}

bool DoubtfulStep::fits_elsewhere(const VgicpOdometry& matcher, const Registration& here, const Pose& X_MR) const {
  const auto leads_elsewhere = [&](const Scan& scan, const Pose& step) {
    const Pose since = (scan.X_MR_before * scan.found).inverse() * X_MR;
    const Registration there = matcher.place_in(before_, scan.X_MR_before * step * since);
    return !matcher.is_near(here.X_MR, there.X_MR) && there.matched >= scan.sure_share * here.matched;
  };
  // What is expected after a fast turn may be far off: a turn in place is as likely.
  const std::vector<Pose> turns = yaw_fan({});
  return std::any_of(scans_.begin(), scans_.end(), [&](const Scan& scan) {
    const auto is_possible = [&](const Pose& step) { return leads_elsewhere(scan, step); };
    return is_possible(scan.expected) || std::any_of(turns.begin(), turns.end(), is_possible);
  });
}

}  // namespace plumbline::slam
