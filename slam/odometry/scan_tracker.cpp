// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/scan_tracker.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace plumbline::slam {

namespace {

/// Time from a scan's first return to its stamp; 0 where returns have no times.
Nanoseconds sweep_time(const Scan& scan) {
  return scan.offset_ns.empty() ? 0 : -*std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
}

}  // namespace

ScanTracker::ScanTracker(const LidarOdometryConfig& config, const Calibration& calibration, bool has_odometry,
                         bool inferred_times)
    : calibration_(calibration),
      has_odometry_(has_odometry),
      inferred_times_(inferred_times),
      odometry_(make_lidar_odometry(config)),
      clock_offset_(calibration) {}

ScanTracker::ScanTracker(const ScanTracker& other)
    : calibration_(other.calibration_),
      has_odometry_(other.has_odometry_),
      inferred_times_(other.inferred_times_),
      motion_(other.motion_),
      odometry_(other.odometry_->clone()),
      compensation_(other.compensation_),
      clock_offset_(other.clock_offset_),
      undone_offset_(other.undone_offset_),
      longest_sweep_(other.longest_sweep_),
      stamp_(other.stamp_),
      X_MR_(other.X_MR_),
      first_(other.first_) {}

void ScanTracker::assume_velocity(const Eigen::Vector3d& mps) {
  if (!first_) return;
  const Nanoseconds sweep = sweep_time(*first_);
  const Pose way{Eigen::Quaterniond::Identity(), mps * seconds(sweep)};
  odometry_->assume_velocity(
      compensated() || sweep <= 0 ? as_deskewed(*first_, calibration_) : deskewed_by(*first_, way, sweep), mps);
}

void ScanTracker::on_odometry(const Odometry& odometry) {
  motion_.add(odometry);
  clock_offset_.add(odometry);
}

DeskewedScan ScanTracker::deskewed(const Scan& scan) const {
  const bool stale = !has_odometry_ || motion_.is_stale_at(scan.stamp);
  DeskewedScan out = compensated() ? as_deskewed(scan, calibration_)
                     : stale       ? deskewed_by(scan, odometry_->continued_step(scan.stamp),
                                           stamp_ ? std::max<Nanoseconds>(scan.stamp - *stamp_, 1) : 1)
                                   : deskew(scan, motion_, calibration_);
  out.odometry_stale = has_odometry_ && stale;
  if (!compensated()) out.twist_sigma = twist_sigma(scan, stale);
  out.odometry_age = motion_.age_at(scan.stamp);
  return out;
}

Registration ScanTracker::track(const Scan& raw, DeskewedScan& scan) {
  Registration result;
  if (has_odometry_) {
    result = odometry_->update(scan, motion_.at(raw.stamp));
    motion_.forget_before(raw.stamp);
    if (stamp_ && result.accepted) test_compensation(raw, X_MR_.inverse() * result.X_MR, raw.stamp - *stamp_);
    test_clock(raw);
  } else {
    result = track_alone(raw, scan);
  }
  stamp_ = raw.stamp;
  X_MR_ = result.X_MR;
  if (!result.sweep_twist.isZero(0.0)) correct_motion(scan, result.sweep_twist);
  return result;
}

TwistSigma ScanTracker::twist_sigma(const Scan& scan, bool stale) const {
  // What a hand or robot accelerates by in passing, over half of the interval whose mean is known.
  constexpr double acceleration_mps2 = 2.0, turn_acceleration_radps2 = 4.0, most_s = 1.0;
  const Nanoseconds known = stale ? (stamp_ ? scan.stamp - *stamp_ : 0) : motion_.period(), sweep = sweep_time(scan);
  const double half_s = 0.5 * std::min(seconds(known), most_s);
  // Odometry of about a scan each follows the motion, unless a hand bends a scan by more than this. It does by 0.02 rad
  // at 10 Hz, by 0.08 at 5 Hz. Steps between scans do not: on corridors carried by hand half of the error was theirs.
  constexpr double dense = 1.5, bend_m = 0.18;
  const bool follows = !stale && static_cast<double>(known) < dense * static_cast<double>(sweep);
  return {acceleration_mps2 * half_s, turn_acceleration_radps2 * half_s, follows ? bend_m : 0.0};
}

Registration ScanTracker::track_alone(const Scan& raw, DeskewedScan& scan) {
  const Nanoseconds sweep = sweep_time(raw);
  const Pose expected = odometry_->continued_step(raw.stamp);
  Pose used = compensated() ? Pose{} : expected;
  bool tested = false;
  std::vector<DeskewedScan> rounds;
  const DeskewAgain again = [&](const Pose& step) -> std::optional<DeskewedAgain> {
    if (!stamp_ || sweep <= 0 || raw.stamp <= *stamp_) return std::nullopt;
    const Nanoseconds dt = raw.stamp - *stamp_;
    if (!tested) test_compensation(raw, step, dt);
    tested = true;
    // A pose at a sweep's end that follows from its mean by half of the step that it makes swings about the truth for
    // ever; with half of the step before in it, that dies out, and small errors are left alone.
    const Pose found = first_ ? step : expected * interpolate(Pose{}, expected.inverse() * step, 0.5);
    const Pose motion = compensated() ? Pose{} : found;
    // What the error of the step bends the scan by, from its first return to its last.
    const double bent_m = first_ ? 0.005 : 0.03, bent_rad = first_ ? 0.001 : 0.01;
    const double share = std::min(1.0, seconds(sweep) / seconds(dt));
    const Pose error = used.inverse() * motion;
    if (share * error.t.norm() < bent_m && share * log_so3(error.q).norm() < bent_rad) return std::nullopt;
    used = motion;
    rounds.push_back(deskewed_by(raw, motion, dt));
    rounds.back().twist_sigma = scan.twist_sigma;
    DeskewedAgain better{rounds.back(), std::nullopt};
    if (first_) better.first = deskewed_by(*first_, motion, dt);
    return better;
  };
  const Registration result = odometry_->update_alone(scan, again);
  if (result.deskewed_again > 0) scan = std::move(rounds[static_cast<std::size_t>(result.deskewed_again - 1)]);
  first_.reset();
  if (result.began) first_ = raw;
  return result;
}

void ScanTracker::test_compensation(const Scan& raw, const Pose& step, Nanoseconds dt) {
  if (inferred_times_ || compensated() || compensation_.is_settled() || dt <= 0) return;
  compensation_.add(raw, calibration_.X_RL.q.conjugate() * step.t / seconds(dt));
}

void ScanTracker::test_clock(const Scan& raw) {
  clock_offset_.add(raw);
  // Of odometry that is later, most of a sweep's motion would be extrapolated: matching finds it better.
  constexpr double latest_sweeps = 0.6;
  longest_sweep_ = std::max(longest_sweep_, sweep_time(raw));  // messages are not of one length
  const bool too_late =
      static_cast<double>(clock_offset_.value()) > latest_sweeps * static_cast<double>(longest_sweep_);
  // Returns of compensated scans are of the stamp, not of their own times.
  const Nanoseconds offset = compensated() || too_late ? 0 : clock_offset_.value();
  if (offset == undone_offset_) return;
  motion_.set_clock_offset(offset, raw.stamp);
  undone_offset_ = offset;
}

DeskewedScan ScanTracker::deskewed_by(const Scan& scan, const Pose& step, Nanoseconds dt) const {
  MotionBuffer motion;
  motion.add({scan.stamp - dt, Pose{}});
  motion.add({scan.stamp, step});
  return deskew(scan, motion, calibration_);
}

}  // namespace plumbline::slam
