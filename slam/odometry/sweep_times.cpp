// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/sweep_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "bim/median.h"

namespace plumbline::slam {

bool has_times(const Scan& scan) {
  return std::any_of(scan.offset_ns.begin(), scan.offset_ns.end(), [](auto offset) { return offset != 0; });
}

std::vector<float> turns_at_slots(const Scan& scan) {
  constexpr double turn_rad = 2.0 * std::numbers::pi;
  constexpr double fewest_turns = 0.5, most_turns = 1.25;
  constexpr double uneven_turns = 0.1;  // lasers of one firing may point degrees apart
  constexpr double nearest_m = 0.5;     // nearer, where a laser sits in the sensor matters
  constexpr std::size_t fewest = 200;
  std::vector<double> azimuths;  // since the first return, unwrapped
  std::vector<std::size_t> slots;
  double last = 0.0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d& p = scan.point_L[i];
    if (scan.range_m[i] <= 0.0 || !p.allFinite() || p.head<2>().norm() < nearest_m) continue;
    const double azimuth = std::atan2(p.y(), p.x());
    azimuths.push_back(azimuths.empty() ? 0.0 : azimuths.back() + wrap_angle(azimuth - last));
    slots.push_back(i);
    last = azimuth;
  }
  if (slots.size() < fewest) return {};
  const double all_turns = azimuths.back() / turn_rad;
  if (std::abs(all_turns) < fewest_turns || std::abs(all_turns) > most_turns) return {};
  const double sign = all_turns < 0.0 ? -1.0 : 1.0;
  std::vector<float> turns(scan.size(), 0.0F);
  double farthest = 0.0, here = 0.0;
  for (std::size_t i = 0, k = 0; i < scan.size(); ++i) {
    if (k < slots.size() && slots[k] == i) {
      here = std::max(sign * azimuths[k] / turn_rad, 0.0);
      if (here < farthest - uneven_turns) return {};
      farthest = std::max(farthest, here);
      ++k;
    }
    turns[i] = static_cast<float>(here);
  }
  return turns;
}

void SweepTimes::add(const Scan& scan) {
  if (settled_) return;
  constexpr std::size_t known = 3;
  constexpr Nanoseconds shortest = 40'000'000, longest = 225'000'000, usual = 100'000'000;
  interval_ = stamp_ ? scan.stamp - *stamp_ : 0;
  stamp_ = scan.stamp;
  if (has_times(scan)) {
    settled_ = true;
    inferred_ = false;
    sweep_ = 0;
  }
  if (settled_ || sweep_ > 0 || interval_ <= 0) return;
  intervals_.push_back(interval_);
  if (intervals_.size() < known) return;
  // Heads turn 5 to 20 times a second; scans that are farther apart are some of many.
  const Nanoseconds interval = upper_median(intervals_);
  if (interval >= shortest) sweep_ = interval > longest ? usual : interval;
  settled_ = interval < shortest;
}

void SweepTimes::add_not_spinning() {
  constexpr int most = 20;
  settled_ |= ++not_spinning_ >= most;
}

double SweepTimes::share_of_step() const {
  return interval_ > 0 ? static_cast<double>(sweep_) / static_cast<double>(interval_) : 0.0;
}

std::optional<Scan> SweepTimes::with_times(const Scan& scan) const {
  if (sweep_ == 0 || has_times(scan)) return std::nullopt;
  const std::vector<float> turns = turns_at_slots(scan);
  if (turns.empty()) return std::nullopt;
  const float last = *std::max_element(turns.begin(), turns.end());
  Scan out = scan;
  out.offset_ns.assign(scan.size(), 0);
  for (std::size_t i = 0; i < turns.size(); ++i)
    out.offset_ns[i] =
        static_cast<std::int32_t>(std::lround(static_cast<double>(turns[i] - last) * static_cast<double>(sweep_)));
  return out;
}

void SweepTimes::compare(const Match& a, const Match& b) {
  const Registration &as_is = a.match, &timed = b.match;
  if (settled_ || interval_ <= 0 || as_is.began || timed.began) return;
  add_ratio(a, b);
  // Chosen on 40 s of quickstart, seed 1, raw and deskewed by the true motion, with odometry and without, on 25 s of it
  // at 5 Hz, and on a corridor that a raw VLP-16 was carried down: ratios are 1.2 to 2 where it is known.
  constexpr double least_ratio = 1.1, seems = 3.0, seems_of_lost = 2.0, sure = 6.0;
  constexpr int fewest = 5, fewest_of_lost = 3, fewest_sure = 10, most = 300;
  constexpr Nanoseconds shortest_sure = 4'000'000'000;
  if (compared_ < fewest_of_lost) return;
  const double mean = sum_ / compared_;
  const double deviation = std::sqrt(std::max(squares_ / compared_ - mean * mean, 0.0) / compared_);
  const auto is_beyond = [&](double deviations) {
    return std::abs(mean) > std::log(least_ratio) && std::abs(mean) > deviations * deviation;
  };
  const bool other_is_lost = mean > 0.0 ? as_is.lost && !timed.lost : timed.lost && !as_is.lost;
  if ((compared_ >= fewest && is_beyond(seems)) || (other_is_lost && is_beyond(seems_of_lost))) inferred_ = mean > 0.0;
  settled_ =
      compared_ >= most || (compared_ >= fewest_sure && *stamp_ - *first_compared_ >= shortest_sure && is_beyond(sure));
}

void SweepTimes::add_ratio(const Match& a, const Match& b) {
  constexpr double least_bend_m = 0.02, near_m = 3.0;
  const Registration &as_is = a.match, &timed = b.match;
  if (!as_is.accepted || !timed.accepted || !(as_is.residual_m > 0.0 && timed.residual_m > 0.0)) return;
  const auto way = [](const Pose& step) { return step.t.norm() + near_m * log_so3(step.q).norm(); };
  if (share_of_step() * std::max(way(a.step), way(b.step)) < least_bend_m) return;
  if (!first_compared_) first_compared_ = stamp_;
  const double ratio = std::log(as_is.residual_m / timed.residual_m);
  ++compared_;
  sum_ += ratio;
  squares_ += ratio * ratio;
}

}  // namespace plumbline::slam
