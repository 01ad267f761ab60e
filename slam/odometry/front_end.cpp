// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/front_end.h"

#include <optional>
#include <utility>

namespace plumbline::slam {

FrontEnd::FrontEnd(const LidarOdometryConfig& config, const Calibration& calibration, bool has_odometry)
    : config_(config), calibration_(calibration), has_odometry_(has_odometry), as_is_(tracking(false)) {}

std::unique_ptr<FrontEnd::Tracking> FrontEnd::tracking(bool inferred_times) const {
  return std::make_unique<Tracking>(
      Tracking{ScanTracker(config_, calibration_, has_odometry_, inferred_times),
               has_odometry_ ? std::nullopt : std::optional<StartTrial>(std::in_place, config_, calibration_),
               {},
               {}});
}

void FrontEnd::on_odometry(const Odometry& odometry) {
  constexpr std::size_t most = 10'000;  // some seconds
  if (as_is_) as_is_->tracker.on_odometry(odometry);
  if (timed_) timed_->tracker.on_odometry(odometry);
  if (timed_ || sweep_times_.is_settled()) return;
  first_odometry_.push_back(odometry);
  if (first_odometry_.size() > most) first_odometry_.pop_front();
}

DeskewedScan FrontEnd::deskewed(const Scan& scan) const {
  if (!uses_times()) return as_is_->tracker.deskewed(scan);
  const std::optional<Scan> timed = sweep_times_.with_times(scan);
  return timed_->tracker.deskewed(timed ? *timed : scan);
}

Registration FrontEnd::track(const Scan& raw, DeskewedScan& scan) {
  sweep_times_.add(raw);
  if (!timed_) begin_trial(raw);
  if (!timed_) return as_is_->track(raw, scan);
  const std::optional<Scan> with_times = sweep_times_.with_times(raw);
  const Scan& timed = with_times ? *with_times : raw;
  if (!with_times) sweep_times_.add_not_spinning();
  const Pose X_MT = X_MT_;
  Registration result = as_is_ ? track_both(raw, timed, scan) : timed_->track(timed, scan);
  result.X_MR = X_MT * result.X_MR;
  return result;
}

void FrontEnd::locate_map() {
  if (as_is_) as_is_->tracker.locate_map();
  if (timed_) timed_->tracker.locate_map();
}

bool FrontEnd::compensated() const { return (uses_times() ? timed_ : as_is_)->tracker.compensated(); }

Registration FrontEnd::Tracking::track(const Scan& scan, DeskewedScan& deskewed) {
  Registration result = tracker.track(scan, deskewed);
  if (std::optional<StartTrial::Tracked> other = start ? start->add(scan, tracker, result) : std::nullopt) {
    tracker = std::move(other->tracker);
    deskewed = std::move(other->scan);
    result = std::move(other->result);
  }
  step = X_MR.inverse() * result.X_MR;
  X_MR = result.X_MR;
  return result;
}

void FrontEnd::begin_trial(const Scan& scan) {
  if (sweep_times_.is_settled()) {
    first_scans_.clear();
    first_odometry_.clear();
  } else if (!sweep_times_.with_times(scan)) {
    if (sweep_times_.share_of_step() > 0.0) sweep_times_.add_not_spinning();
    first_scans_.push_back(scan);
  } else {
    timed_ = tracking(true);
    for (const Scan& first : std::exchange(first_scans_, {})) {
      for (; !first_odometry_.empty() && first_odometry_.front().stamp <= first.stamp; first_odometry_.pop_front())
        timed_->tracker.on_odometry(first_odometry_.front());
      const std::optional<Scan> timed = sweep_times_.with_times(first);
      DeskewedScan deskewed = timed_->tracker.deskewed(timed ? *timed : first);
      (void)timed_->track(timed ? *timed : first, deskewed);
    }
    for (const Odometry& odometry : std::exchange(first_odometry_, {})) timed_->tracker.on_odometry(odometry);
  }
}

Registration FrontEnd::track_both(const Scan& raw, const Scan& timed, DeskewedScan& scan) {
  const bool used_times = uses_times();
  DeskewedScan other = used_times ? as_is_->tracker.deskewed(raw) : timed_->tracker.deskewed(timed);
  const Registration as_is = as_is_->track(raw, used_times ? other : scan);
  const Registration by_times = timed_->track(timed, used_times ? scan : other);
  sweep_times_.compare({as_is, as_is_->step}, {by_times, timed_->step});
  if (uses_times() != used_times) change_tracker(used_times ? by_times : as_is, used_times ? as_is : by_times);
  if (sweep_times_.is_settled()) (sweep_times_.are_inferred() ? as_is_ : timed_).reset();
  return used_times ? by_times : as_is;
}

void FrontEnd::change_tracker(const Registration& used, const Registration& next) {
  // Both trackers begin at the first pose. Past a way that is not known, another one's frame is anywhere.
  X_MT_ = next.displaced ? join_frames(X_MT_ * used.X_MR, next.X_MR) : Pose{};
}

}  // namespace plumbline::slam
