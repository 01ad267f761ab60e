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
  usual_ = usual();
}

bool MotionBuffer::is_jump(const Odometry& from, const Odometry& to) const {
  constexpr double noise_m = 0.05, noise_rad = 0.05;  // of an odometry's own noise
  constexpr double most_usual_s = 0.1;                // a gap among the intervals says nothing
  const double dt = std::max(seconds(to.stamp - from.stamp), std::min(1e-9 * usual_.mean_ns, most_usual_s));
  const Pose step = from.X_OR.inverse() * to.X_OR;
  return step.t.norm() > max_speed_mps * dt + noise_m || log_so3(step.q).norm() > max_turn_radps * dt + noise_rad;
}

Pose MotionBuffer::at(Nanoseconds t) const {
  if (records_.empty()) throw InternalError("motion requested before the first odometry record");
  t += clock_offset_;
  if (records_.size() == 1 || t <= records_.front().stamp) return records_.front().X_OR;
  const Odometry& last = records_.back();
  if (t > last.stamp) {
    const Odometry& from = records_[usual_.velocity_from];
    constexpr Nanoseconds least_span = 5'000'000;  // of a first burst, which tells no velocity
    if (!usual_.even && last.stamp - from.stamp < least_span) return last.X_OR;
    return interpolate(from.X_OR, last.X_OR, fraction(from.stamp, last.stamp, std::min(t, last.stamp + max_age())));
  }
  const auto after = std::lower_bound(records_.begin() + 1, records_.end() - 1, t,
                                      [](const Odometry& record, Nanoseconds time) { return record.stamp < time; });
  const Odometry& b = *after;
  const Odometry& a = *(after - 1);
  return interpolate(a.X_OR, b.X_OR, fraction(a.stamp, b.stamp, t));
}

// Records that come in bursts have stamps microseconds apart: their step is no velocity.
MotionBuffer::Usual MotionBuffer::usual() const {
  constexpr double tolerance = 0.25, intervals = 10.0;
  Usual result;
  if (records_.size() < 2) return result;
  const std::size_t last = records_.size() - 1;
  const auto span_ns = [&](std::size_t from) {
    return static_cast<double>(records_[last].stamp - records_[from].stamp);
  };
  std::size_t first = last - 1;
  while (first > 0 && records_[last].stamp - records_[first].stamp < window) --first;
  result.mean_ns = span_ns(first) / static_cast<double>(last - first);
  Nanoseconds largest = 0, second = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Nanoseconds interval = records_[i + 1].stamp - records_[i].stamp;
    result.even &= std::abs(static_cast<double>(interval) - result.mean_ns) <= tolerance * result.mean_ns;
    second = std::max(second, std::min(largest, interval));
    largest = std::max(largest, interval);
  }
  constexpr double fastest_ns = 1e6;
  result.even &= result.mean_ns >= fastest_ns;
  result.velocity_from = last - 1;
  result.period = records_[last].stamp - records_[last - 1].stamp;
  if (result.even) return result;
  while (result.velocity_from > first && span_ns(result.velocity_from) < intervals * result.mean_ns)
    --result.velocity_from;
  result.period = second;
  return result;
}

Nanoseconds MotionBuffer::max_age() const {
  const Nanoseconds late = std::max<Nanoseconds>(clock_offset_, 0);
  if (records_.size() < 2) return least_max_age + late;
  return std::clamp(period() + period() / 2, least_max_age, most_max_age) + late;
}

Nanoseconds MotionBuffer::longest_gap(Nanoseconds from, Nanoseconds to) const {
  from += clock_offset_;
  to += clock_offset_;
  Nanoseconds longest = 0;
  for (std::size_t i = 1; i < records_.size(); ++i)
    longest = std::max(longest, std::min(records_[i].stamp, to) - std::max(records_[i - 1].stamp, from));
  return longest;
}

void MotionBuffer::forget_before(Nanoseconds t) {
  if (records_.empty()) return;
  t = std::min(t + clock_offset_, records_.back().stamp - window);
  while (records_.size() > 2 && records_[1].stamp <= t) records_.pop_front();
  usual_ = usual();
}

void MotionBuffer::set_clock_offset(Nanoseconds offset, Nanoseconds t) {
  if (records_.empty()) {
    clock_offset_ = offset;
    return;
  }
  const Pose before = at(t);
  clock_offset_ = offset;
  const Pose shift = join_frames(before, at(t));
  for (Odometry& record : records_) record.X_OR = shift * record.X_OR;
  frame_shift_ = frame_shift_ ? shift * *frame_shift_ : shift;
}

std::vector<Eigen::Vector3d> points_between(const DeskewedScan& scan, double min_range_m, double max_range_m) {
  std::vector<Eigen::Vector3d> points_R;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] >= min_range_m && scan.range_m[i] <= max_range_m) points_R.push_back(scan.point_R[i]);
  return points_R;
}

std::vector<Eigen::Vector3d> points_of(const DeskewedScan& scan, const std::vector<std::uint32_t>& returns) {
  std::vector<Eigen::Vector3d> points_R;
  points_R.reserve(returns.size());
  for (const std::uint32_t i : returns) points_R.push_back(scan.point_R[i]);
  return points_R;
}

Pose join_frames(const Pose& X_OR, const Pose& X_BR) {
  const auto level = [](const Pose& X) { return Pose::from_xyz_yaw(X.t, X.yaw()); };
  return level(X_OR) * level(X_BR).inverse();
}

}  // namespace plumbline::slam
