// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

double fraction(Nanoseconds from, Nanoseconds to, Nanoseconds t) {
  return static_cast<double>(t - from) / static_cast<double>(to - from);
}

}  // namespace

void MotionBuffer::add(const Odometry& odometry) {
  if (!records_.empty() && odometry.stamp < records_.back().stamp)
    throw InternalError("odometry records are not in time order");
  if (!odometry.X_OR.t.allFinite() || !odometry.X_OR.q.coeffs().allFinite()) return;
  Odometry record = odometry;
  if (frame_shift_) record.X_OR = *frame_shift_ * record.X_OR;
  if (!records_.empty() && is_jump(records_.back(), record)) {
    frame_shift_ = join_frames(records_.back().X_OR, odometry.X_OR);
    record.X_OR = *frame_shift_ * odometry.X_OR;
  }
  if (!records_.empty() && record.stamp == records_.back().stamp) records_.pop_back();
  records_.push_back(record);
}

bool MotionBuffer::is_jump(const Odometry& from, const Odometry& to) const {
  constexpr double noise_m = 0.05, noise_rad = 0.05;  // of an odometry's own noise
  const double dt = std::max(seconds(to.stamp - from.stamp), 1e-9 * interval().mean_ns);
  const Pose step = from.X_OR.inverse() * to.X_OR;
  return step.t.norm() > max_speed_mps * dt + noise_m || log_so3(step.q).norm() > max_turn_radps * dt + noise_rad;
}

Pose MotionBuffer::at(Nanoseconds t) const {
  if (records_.empty()) throw InternalError("motion requested before the first odometry record");
  if (records_.size() == 1 || t <= records_.front().stamp) return records_.front().X_OR;
  const auto after = std::lower_bound(records_.begin() + 1, records_.end() - 1, t,
                                      [](const Odometry& record, Nanoseconds time) { return record.stamp < time; });
  const Odometry& b = *after;
  const Odometry& a = t > b.stamp ? before_last() : *(after - 1);
  return interpolate(a.X_OR, b.X_OR, fraction(a.stamp, b.stamp, std::min(t, b.stamp + max_age())));
}

MotionBuffer::Interval MotionBuffer::interval() const {
  constexpr std::size_t most = 20;
  constexpr double tolerance = 0.25;
  if (records_.size() < 2) return {};
  const std::size_t last = records_.size() - 1, first = last > most ? last - most : 0;
  const double mean_ns =
      static_cast<double>(records_[last].stamp - records_[first].stamp) / static_cast<double>(last - first);
  Interval result{mean_ns, true};
  for (std::size_t i = first; i < last; ++i)
    result.even &=
        std::abs(static_cast<double>(records_[i + 1].stamp - records_[i].stamp) - mean_ns) <= tolerance * mean_ns;
  return result;
}

// Records that come in bursts have stamps microseconds apart: their step is no velocity.
const Odometry& MotionBuffer::before_last() const {
  constexpr double intervals = 10.0;
  const Interval usual = interval();
  std::size_t i = records_.size() - 2;
  const auto span_ns = [&] { return static_cast<double>(records_.back().stamp - records_[i].stamp); };
  if (!usual.even)
    while (i > 0 && span_ns() < intervals * usual.mean_ns) --i;
  return records_[i];
}

Nanoseconds MotionBuffer::max_age() const {
  if (records_.size() < 2) return least_max_age;
  return std::clamp(period() + period() / 2, least_max_age, most_max_age);
}

void MotionBuffer::forget_before(Nanoseconds t) {
  while (records_.size() > 2 && records_[1].stamp <= t) records_.pop_front();
}

Pose join_frames(const Pose& X_OR, const Pose& X_BR) {
  const auto level = [](const Pose& X) { return Pose::from_xyz_yaw(X.t, X.yaw()); };
  return level(X_OR) * level(X_BR).inverse();
}

}  // namespace plumbline::slam
