// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/time_shift.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/median.h"

namespace plumbline::scenarios::score {

namespace {

using slam::Nanoseconds;

/// Distance and turn over a window, m and rad; a radian weighs as a metre.
using Motion = Eigen::Vector2d;

Nanoseconds in_ns(double seconds) { return static_cast<Nanoseconds>(std::llround(1e9 * seconds)); }

/// The motion around each step of a trajectory.
std::vector<Motion> motions_of(const std::vector<slam::StampedPose>& poses, const ShiftRules& rules) {
  const Truth path{poses, {}};  // interpolates
  const Nanoseconds step = in_ns(rules.step_s), window = in_ns(rules.window_s);
  std::vector<Motion> motions;
  for (Nanoseconds t = poses.front().stamp; t + window <= poses.back().stamp; t += step) {
    const Pose motion = path.at(t).inverse() * path.at(t + window);
    motions.emplace_back(motion.t.norm(), log_so3(motion.q).norm());
  }
  return motions;
}

/// Mean square of what is left where b[0] is beside a[lag].
double left_at(const std::vector<Motion>& a, const std::vector<Motion>& b, std::ptrdiff_t lag, std::size_t least) {
  const auto first = std::max<std::ptrdiff_t>(0, lag);
  const auto last = std::min(static_cast<std::ptrdiff_t>(a.size()), static_cast<std::ptrdiff_t>(b.size()) + lag);
  if (last - first < static_cast<std::ptrdiff_t>(least)) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::ptrdiff_t i = first; i < last; ++i)
    sum += (a[static_cast<std::size_t>(i)] - b[static_cast<std::size_t>(i - lag)]).squaredNorm();
  return sum / static_cast<double>(last - first);
}

/// Aligned error of the poses at the truth of their shifted stamps, m.
double error_at(const Truth& truth, const std::vector<slam::StampedPose>& poses, Nanoseconds shift) {
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Nanoseconds t = poses[i].stamp + shift;
    if (t >= truth.poses_W.front().stamp && t <= truth.poses_W.back().stamp)
      pairs.push_back({i, poses[i].X_FR, truth.at(t)});
  }
  return pairs.empty() ? std::numeric_limits<double>::infinity() : position_rmse(pairs, umeyama(pairs));
}

/// The shift with the least error among those up to `reach` steps from `start`.
Nanoseconds least_error(const Truth& truth, const std::vector<slam::StampedPose>& poses, Nanoseconds start,
                        Nanoseconds step, int reach) {
  Nanoseconds best = start;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -reach; i <= reach; ++i)
    if (const double error = error_at(truth, poses, start + i * step); error < least) {
      least = error;
      best = start + i * step;
    }
  return best;
}

/// Brings poses that belong to scans to their stamps.
Nanoseconds on_scans(const Truth& truth, const std::vector<slam::StampedPose>& poses, Nanoseconds shift) {
  constexpr Nanoseconds near = 1'000'000;
  constexpr double most = 0.9;  // a program may leave out scans, or answer some of them late
  std::vector<Nanoseconds> off;
  for (const slam::StampedPose& pose : poses) {
    const Nanoseconds t = pose.stamp + shift;
    const auto next = std::lower_bound(truth.scans.begin(), truth.scans.end(), t);
    const bool before = next == truth.scans.end() || (next != truth.scans.begin() && t - *std::prev(next) < *next - t);
    off.push_back((before ? *std::prev(next) : *next) - t);
  }
  const Nanoseconds usual = upper_median(off);
  const auto on = std::count_if(off.begin(), off.end(), [&](Nanoseconds o) { return std::abs(o - usual) <= near; });
  return static_cast<double>(on) >= most * static_cast<double>(off.size()) ? shift + usual : shift;
}

}  // namespace

std::optional<Nanoseconds> find_shift(const Truth& truth, const std::vector<slam::StampedPose>& poses_F,
                                      const ShiftRules& rules) {
  if (truth.scans.empty() || truth.poses_W.empty() || poses_F.empty()) return std::nullopt;
  const auto lasts_s = [](const std::vector<slam::StampedPose>& poses) {
    return 1e-9 * (static_cast<double>(poses.back().stamp) - static_cast<double>(poses.front().stamp));
  };
  if (lasts_s(poses_F) > lasts_s(truth.poses_W) + rules.most_longer_s) return std::nullopt;
  const std::vector<Motion> a = motions_of(truth.poses_W, rules), b = motions_of(poses_F, rules);
  const auto least = static_cast<std::size_t>(rules.least_overlap * static_cast<double>(std::min(a.size(), b.size())));
  const auto window = static_cast<std::ptrdiff_t>(rules.window_s / rules.step_s);
  if (least < static_cast<std::size_t>(window)) return std::nullopt;
  std::vector<double> left;
  const auto first_lag = -static_cast<std::ptrdiff_t>(b.size());
  for (std::ptrdiff_t lag = first_lag; lag < static_cast<std::ptrdiff_t>(a.size()); ++lag)
    left.push_back(left_at(a, b, lag, least));
  const auto best = std::min_element(left.begin(), left.end());
  for (auto other = left.begin(); other != left.end(); ++other)
    if (std::abs(other - best) > window && *best > rules.most_of_next * *other) return std::nullopt;
  const Nanoseconds start =
      truth.poses_W.front().stamp - poses_F.front().stamp + (best - left.begin() + first_lag) * in_ns(rules.step_s);
  constexpr int coarse = 10, reach = 20;  // two steps of the first search to either side
  const Nanoseconds fine = in_ns(rules.fine_s);
  const Nanoseconds near = least_error(truth, poses_F, start, coarse * fine, reach);
  return on_scans(truth, poses_F, least_error(truth, poses_F, near, fine, coarse));
}

}  // namespace plumbline::scenarios::score
