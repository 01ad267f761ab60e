// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/watched_odometry.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace plumbline::slam {

namespace {

constexpr std::size_t kept_scans = 8;

/// Way and turn in one: a metre for a radian.
double size_of(const Pose& step) { return step.t.norm() + log_so3(step.q).norm(); }

bool is_measured(const Registration& found) {
  return found.accepted && !found.lost && !found.displaced && found.unobserved_directions == 0;
}

}  // namespace

WatchedOdometry::Tracked WatchedOdometry::track(const Scan& scan, const MotionBuffer& motion, Nanoseconds late) {
  constexpr Nanoseconds longest = 300'000'000;  // over which a walking robot's velocity may be taken to go on
  const Nanoseconds age = motion.age_at(scan.stamp);
  const bool silent = motion.is_stale_at(scan.stamp) || age - std::max<Nanoseconds>(late, 0) > longest;
  if (silent && !by_scans_ && !recent_.empty()) {
    by_scans_ = begin();
    why_ = Why::silent;
    // From the last scan on whose motion was measured.
    auto from = std::find_if(recent_.rbegin(), recent_.rend(),
                             [&](const Seen& seen) { return seen.scan.stamp <= scan.stamp - age; });
    if (from == recent_.rend()) --from;
    for (auto seen = std::prev(from.base()); seen != recent_.end(); ++seen) {
      DeskewedScan deskewed;
      (void)match(*by_scans_, seen->scan, seen->X_OR, deskewed);
    }
  }
  Tracked result = by_scans_ ? by_scans(scan, motion, silent) : by_odometry(scan, motion);
  X_OR_ = result.X_OR;
  X_BR_ = motion.at(scan.stamp);
  return result;
}

WatchedOdometry::Matching WatchedOdometry::begin() const {
  LidarOdometryConfig config;
  config.vgicp.odometry_prior = config.vgicp.tilt_prior = false;
  return {FrontEnd(config, calibration_, false), Pose{}, Pose{}, false};
}

Registration WatchedOdometry::match(Matching& matching, const Scan& scan, const Pose& X_OR,
                                    DeskewedScan& deskewed) const {
  deskewed = matching.front_end.deskewed(scan);
  const Registration result = matching.front_end.track(scan, deskewed);
  if (!matching.began) {
    matching.X_OM = X_OR * result.X_MR.inverse();
    matching.X_OR = X_OR;
  }
  matching.began = true;
  return result;
}

WatchedOdometry::Tracked WatchedOdometry::by_odometry(const Scan& scan, const MotionBuffer& motion) {
  Tracked result;
  const Pose X_BR = motion.at(scan.stamp);
  result.X_OR = X_OB_ ? *X_OB_ * X_BR : X_BR;
  if (!recent_.empty() && recent_.back().scan.stamp < scan.stamp) {
    const Nanoseconds before = recent_.back().scan.stamp;
    last_steps_.push_back({motion.at(before).inverse() * X_BR, scan.stamp - before});
    if (is_after_gap()) slip_.reset();
    if (slip_ || is_last_step_unexpected()) undo_slip(scan, X_BR, result);
    if (result.deskewed) X_OB_ = join_frames(result.X_OR, X_BR);
    if (by_scans_) return result;
    for (; !slip_ && last_steps_.size() > 1; last_steps_.pop_front())
      steps_.add(last_steps_.front().step, last_steps_.front().dt);
  }
  recent_.push_back({scan, result.X_OR, CoarseView(scan)});
  if (recent_.size() > kept_scans) recent_.pop_front();
  if (!contradicts_scans(scan, result.X_OR)) return result;
  why_ = Why::wrong;
  // The scan has been matched already: this one goes by odometry, the next one by scans.
  by_scans_ = std::exchange(beside_, std::nullopt);
  return result;
}

bool WatchedOdometry::is_after_gap() const {
  return last_steps_.size() > 1 && last_steps_.back().dt > 2 * std::prev(last_steps_.end(), 2)->dt;
}

bool WatchedOdometry::is_last_step_unexpected() const {
  if (is_after_gap()) return false;  // so far ahead nothing is expected
  // On walks that slip by 0.2 to 0.4 m, at 2 to 10 Hz, nothing but slips and sudden stops exceeds them.
  constexpr double sigmas = 2.5, least_mps = 0.3;
  const Step& last = last_steps_.back();
  const std::optional<Pose> expected = steps_.over(last.dt);
  return expected && (last.step.t - expected->t).norm() > sigmas * steps_.sigma_m() + least_mps * seconds(last.dt);
}

void WatchedOdometry::undo_slip(const Scan& scan, const Pose& X_BR, Tracked& by_odometry) {
  constexpr double least_m = 0.05;                  // more than registration errs by within the scans that are kept
  constexpr double undone = 0.5;                    // as in SlipWatch
  constexpr Nanoseconds enough = 300'000'000;       // longer than a slip pauses
  constexpr int most = 10;                          // scans
  constexpr std::size_t least_scans = 4;            // from which matching begins, ...
  constexpr Nanoseconds most_time = 1'000'000'000;  // ... or those of this time
  DeskewedScan deskewed;
  if (!slip_) {
    slip_ = begin();
    undone_ = 0;
    X_OB_before_slip_.reset();
    slipped_ = recent_.back().scan.stamp;
    for (std::size_t i = 0; i < recent_.size(); ++i)
      if (recent_.size() - i <= least_scans || scan.stamp - recent_[i].scan.stamp <= most_time)
        (void)match(*slip_, recent_[i].scan, recent_[i].X_OR, deskewed);
  }
  const Registration found = match(*slip_, scan, by_odometry.X_OR, deskewed);
  const Pose X_OR = slip_->X_OM * found.X_MR;
  Eigen::Vector3d unexpected_R = Eigen::Vector3d::Zero();
  for (const Step& last : last_steps_) unexpected_R += last.step.t - steps_.over(last.dt)->t;
  const Eigen::Vector3d correction_R = (by_odometry.X_OR.inverse() * X_OR).t;
  const bool slipped =
      is_measured(found) && correction_R.norm() > least_m &&
      (unexpected_R + correction_R).norm() < undone * std::max(unexpected_R.norm(), correction_R.norm());
  // One scan may be matched in a wrong place, as where the robot stops and turns at once; the next shows it.
  const bool was_none = X_OB_before_slip_ && is_measured(found) && correction_R.norm() > least_m &&
                        ((*X_OB_before_slip_ * X_BR).inverse() * X_OR).t.norm() < undone * correction_R.norm();
  if (was_none) {
    X_OB_before_slip_.reset();
    by_odometry.X_OR = X_OR;
    by_odometry.deskewed = std::move(deskewed);
  } else if (slipped) {
    X_OB_before_slip_ = X_OB_.value_or(Pose{});
    by_odometry.X_OR = X_OR;
    by_odometry.deskewed = std::move(deskewed);
    last_steps_.clear();
    slipped_ = scan.stamp;
    ++undone_;
  }
  if (undone_ >= most) {
    why_ = Why::wrong;
    by_scans_ = std::exchange(slip_, std::nullopt);
  } else if (!is_measured(found) || scan.stamp - slipped_ >= enough) {
    slip_.reset();
  }
}

bool WatchedOdometry::is_suspect(const Pose& X_OR) {
  constexpr double still = 0.03;  // m and rad: more than odometry's noise
  constexpr int enough = 6;       // scans, fewer than are kept
  if (!X_OR_standing_ || size_of(X_OR_standing_->inverse() * X_OR) > still) {
    X_OR_standing_ = X_OR;
    standing_ = 0;
  } else if (++standing_ >= enough) {
    return true;
  }
  // Assumed; a walk in place changes as little, and scan matching then agrees with odometry.
  constexpr double goes = 0.15, unchanged = 0.8;
  return recent_.size() == kept_scans && size_of(recent_.front().X_OR.inverse() * X_OR) > goes &&
         recent_.front().view.unchanged_share(recent_.back().view) > unchanged;
}

bool WatchedOdometry::contradicts_scans(const Scan& scan, const Pose& X_OR) {
  constexpr double apart = 0.3;  // m and rad: more than registration errs by where people pass, ...
  constexpr double share = 0.1;  // ... and this of the way since: odometry that is a tenth off is not wrong
  constexpr int in_a_row = 3;
  if (!is_suspect(X_OR)) {
    beside_apart_ = 0;
    beside_.reset();
    return false;
  }
  DeskewedScan deskewed;
  if (!beside_) {
    beside_ = begin();
    for (std::size_t i = 0; i + 1 < recent_.size(); ++i)
      (void)match(*beside_, recent_[i].scan, recent_[i].X_OR, deskewed);
  }
  const Registration found = match(*beside_, scan, X_OR, deskewed);
  const double way = size_of(beside_->X_OR.inverse() * X_OR);
  const bool is_apart = size_of(X_OR.inverse() * beside_->X_OM * found.X_MR) > apart + share * way;
  beside_apart_ = is_measured(found) && is_apart ? beside_apart_ + 1 : 0;
  return beside_apart_ >= in_a_row;
}

WatchedOdometry::Tracked WatchedOdometry::by_scans(const Scan& scan, const MotionBuffer& motion, bool silent) {
  Tracked result;
  result.deskewed.emplace();
  const Registration found = match(*by_scans_, scan, X_OR_.value_or(Pose{}), *result.deskewed);
  result.X_OR = by_scans_->X_OM * found.X_MR;
  result.is_way_known = !found.lost && !found.displaced;
  // Localization starts anew: what matters is whether the way from here on is known.
  if (!found.lost && found.displaced) by_scans_->front_end.locate_map();
  watch_return(scan, motion, result.X_OR, silent || !found.accepted);
  return result;
}

void WatchedOdometry::watch_return(const Scan& scan, const MotionBuffer& motion, const Pose& X_OR, bool silent) {
  constexpr double noise = 0.03, share = 0.2;  // m and rad; of the step
  constexpr int enough = 10;
  constexpr double enough_m = 0.3;  // of an odometry that was wrong
  const Pose step = X_OR_->inverse() * X_OR, measured = X_BR_->inverse() * motion.at(scan.stamp);
  const bool agrees = !silent && size_of(step.inverse() * measured) <= noise + share * size_of(step);
  agreeing_ = agrees ? agreeing_ + 1 : 0;
  agreed_m_ = agrees ? agreed_m_ + size_of(measured) : 0.0;
  if (agreeing_ < enough || (why_ == Why::wrong && agreed_m_ < enough_m)) return;
  X_OB_ = join_frames(X_OR, motion.at(scan.stamp));
  by_scans_.reset();
  slip_.reset();
  steps_.clear();
  last_steps_.clear();
  recent_.clear();
  X_OR_standing_.reset();
  agreeing_ = 0;
  agreed_m_ = 0.0;
}

}  // namespace plumbline::slam
