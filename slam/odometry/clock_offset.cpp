// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace plumbline::slam {

namespace {

constexpr int bins = 720;
constexpr double bin_rad = 2.0 * std::numbers::pi / bins;
constexpr double flat = 0.09;      ///< sine of a return's elevation
constexpr double nearest_m = 0.5;  ///< nearer is the robot itself
constexpr double upright = 0.95;   ///< cosine of the sensor's tilt
constexpr int fewest_bins = bins / 4;
constexpr double longest_s = 1.0;  ///< a sweep, or from one to the next
constexpr double differs = 0.2;    ///< of two ranges' logarithms: another surface

int wrapped(int bin) { return ((bin % bins) + bins) % bins; }
std::size_t bin_of(const Eigen::Vector2d& p) {
  return static_cast<std::size_t>(wrapped(static_cast<int>(std::floor(std::atan2(p.y(), p.x()) / bin_rad))));
}

/// By azimuth.
struct Bins {
  std::vector<double> range_m = std::vector<double>(bins, 0.0);  ///< 0: nothing
  std::vector<double> time_s = std::vector<double>(bins, 0.0);
};

/// Of nearly horizontal returns, the means in each bin; times from the stamp.
Bins bins_of(const Scan& scan) {
  constexpr std::size_t most = 5'000;  // several in each bin
  std::size_t stride = (scan.size() / most) | 1U;
  while (std::gcd(stride, static_cast<std::size_t>(std::max(scan.rings, 1))) != 1) stride += 2;  // no ring is left out
  Bins means;
  std::vector<int> number(bins, 0);
  for (std::size_t i = 0; i < scan.size(); i += stride) {
    const Eigen::Vector3d& p = scan.point_L[i];
    const double range = p.head<2>().norm();
    if (!(scan.range_m[i] > nearest_m) || !(range > nearest_m) || !(std::abs(p.z()) < flat * range)) continue;
    const std::size_t bin = bin_of(p.head<2>());
    means.range_m[bin] += range;
    means.time_s[bin] += seconds(scan.offset_ns[i]);
    ++number[bin];
  }
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (number[bin] == 0) continue;
    means.range_m[bin] /= number[bin];
    means.time_s[bin] /= number[bin];
  }
  return means;
}

/// The same seen a while later, without a turn: `way_at` says from where, by the time of a return.
template <class WayAt>
Bins moved_by(const std::vector<double>& range_m, const std::vector<double>& time_s, const WayAt& way_at) {
  Bins moved;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (range_m[bin] <= 0.0) continue;
    const double azimuth = (static_cast<double>(bin) + 0.5) * bin_rad;
    const Eigen::Vector2d p =
        range_m[bin] * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth)) - way_at(time_s[bin]);
    const std::size_t to = bin_of(p);
    if (moved.range_m[to] > 0.0 && moved.range_m[to] <= p.norm()) continue;
    moved.range_m[to] = p.norm();
    moved.time_s[to] = time_s[bin];
  }
  return moved;
}

std::vector<double> logarithms(std::vector<double> range_m) {
  for (double& range : range_m) range = range > 0.0 ? std::log(range) : -std::numeric_limits<double>::infinity();
  return range_m;
}

/// Mean difference of logarithms of ranges where `now` is turned by a number of bins.
std::optional<double> difference(const std::vector<double>& before, const std::vector<double>& now, int turn) {
  double sum = 0.0;
  int both = 0;
  for (int bin = 0; bin < bins; ++bin) {
    const double a = before[static_cast<std::size_t>(bin)], b = now[static_cast<std::size_t>(wrapped(bin - turn))];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    sum += std::min(std::abs(a - b), differs);
    ++both;
  }
  if (both < fewest_bins) return std::nullopt;
  return sum / both;
}

/// Where the parabola through three values is least, in steps from the middle one.
double vertex(double left, double middle, double right) {
  const double bend = left - 2.0 * middle + right;
  return bend > 0.0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0.0;
}

/// Turn of the sensor between two profiles of logarithms, rad, counter-clockwise.
std::optional<double> turn_between(const std::vector<double>& before, const std::vector<double>& now, double least,
                                   double largest) {
  const int from = static_cast<int>(std::floor(least / bin_rad)), to = static_cast<int>(std::ceil(largest / bin_rad));
  std::vector<double> costs;
  for (int turn = from; turn <= to; ++turn) {
    const std::optional<double> cost = difference(before, now, turn);
    if (!cost) return std::nullopt;
    costs.push_back(*cost);
  }
  const auto best = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  if (best == 0 || best + 1 == costs.size()) return std::nullopt;
  return (from + static_cast<int>(best) + vertex(costs[best - 1], costs[best], costs[best + 1])) * bin_rad;
}

constexpr int reach = 3;  ///< bins either way of a turn that is sought

/// Logarithms of ranges by azimuth, with as much of the other end at either end as a shift by `reach` bins reaches.
class WrappedProfile {
 public:
  explicit WrappedProfile(const std::vector<double>& log) {
    for (int k = 0; k < size; ++k) {
      const double value = log[static_cast<std::size_t>(wrapped(k - reach))];
      values_[static_cast<std::size_t>(k)] = std::isfinite(value) ? value : nothing;
    }
  }
  /// From the bin `reach` before this one, of 0 to bins - 1.
  [[nodiscard]] const double* before(int bin) const { return values_.data() + bin; }

 private:
  static constexpr int size = bins + 2 * reach + 1;
  static constexpr double nothing = -1e12;  ///< differs from all
  std::array<double, size> values_;
};

/// Of a pair of scans: bins before that are seen now, too, and where each moves on to by odometry, in bins.
struct PredictedTurn {
  struct Seen {
    double before = 0.0;  ///< logarithm of its range
    double to_bin = 0.0;
  };
  std::vector<Seen> seen;
  double mean_rad = 0.0;
};

using Differences = std::array<double, 2 * reach + 1>;

/// Mean differences where the sensor turned by `first`, `first` + 1, ... bins more than predicted.
Differences differences_from(const PredictedTurn& predicted, const WrappedProfile& now, int first) {
  Differences sums{};
  for (const PredictedTurn::Seen& bin : predicted.seen) {
    const double at = bin.to_bin - (first + reach), left = std::floor(at), part = at - left;
    const double* const range = now.before(wrapped(static_cast<int>(left)));
    for (int more = 0; more < static_cast<int>(sums.size()); ++more) {
      const double* const pair = range + (2 * reach - more);
      const double here = (1.0 - part) * pair[0] + part * pair[1];
      sums[static_cast<std::size_t>(more)] += std::min(std::abs(bin.before - here), differs);
    }
  }
  for (double& sum : sums) sum /= static_cast<double>(predicted.seen.size());
  return sums;
}

/// By how much more than predicted the sensor turned, rad: within a few bins of `turn_rad`, where the scans differ
/// least.
double more_than(const PredictedTurn& predicted, const WrappedProfile& now, double turn_rad) {
  const int first = static_cast<int>(std::lround((turn_rad - predicted.mean_rad) / bin_rad)) - reach;
  const Differences differences = differences_from(predicted, now, first);
  const auto best = std::min_element(differences.begin() + 1, differences.end() - 1);
  return (first + static_cast<int>(best - differences.begin()) + vertex(*(best - 1), *best, *(best + 1))) * bin_rad;
}

}  // namespace

ClockOffset::ClockOffset(const Calibration& calibration) : calibration_(calibration) {}

void ClockOffset::add(const Odometry& odometry) {
  if (!odometry.X_OR.t.allFinite() || !odometry.X_OR.q.coeffs().allFinite()) return;
  const Pose X_OL = odometry.X_OR * calibration_.X_RL;
  Place place{odometry.stamp, X_OL.t.head<2>(), X_OL.yaw()};
  if (!places_.empty()) place.yaw = places_.back().yaw + wrap_angle(place.yaw - places_.back().yaw);
  if (!places_.empty() && places_.back().stamp == place.stamp) places_.pop_back();
  places_.push_back(place);
  constexpr Nanoseconds kept = 10'000'000'000;  // where no scans come
  while (places_.front().stamp < place.stamp - kept) places_.pop_front();
}

void ClockOffset::add(const Scan& scan) {
  if (calibration_.X_RL.rotation()(2, 2) < upright) return;
  double sum_ns = 0.0, returns = 0.0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.range_m[i] <= 0.0) continue;
    sum_ns += static_cast<double>(scan.offset_ns[i]);
    returns += 1.0;
  }
  if (sum_ns == 0.0) return;
  const double mean_s = 1e-9 * sum_ns / returns;
  Bins means = bins_of(scan);
  double farthest_s = 0.0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    means.time_s[bin] = means.range_m[bin] > 0.0 ? means.time_s[bin] - mean_s : 0.0;
    farthest_s = std::max(farthest_s, std::abs(means.time_s[bin]));
  }
  if (farthest_s > longest_s) return;
  profiles_.push_back({scan.stamp + std::llround(1e9 * mean_s), std::move(means.range_m), std::move(means.time_s),
                       std::llround(1e9 * farthest_s)});
  while (profiles_.size() > 1 && !places_.empty() &&
         places_.back().stamp >= profiles_[1].time + profiles_[1].farthest + most) {
    use(profiles_[0], profiles_[1]);
    profiles_.pop_front();
  }
  if (goes_straight()) decide();
  constexpr std::size_t most_waiting = 50;  // where no odometry comes
  if (profiles_.size() > most_waiting) profiles_.pop_front();
}

ClockOffset::Place ClockOffset::place_at(Nanoseconds t) const {
  const auto after = std::lower_bound(places_.begin() + 1, places_.end() - 1, t,
                                      [](const Place& place, Nanoseconds time) { return place.stamp < time; });
  const Place &a = *(after - 1), &b = *after;
  const double part = static_cast<double>(t - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return {t, a.t_OL + part * (b.t_OL - a.t_OL), a.yaw + part * (b.yaw - a.yaw)};
}

ClockOffset::Yaws ClockOffset::yaws_of(Nanoseconds time, const std::vector<double>& offset_s) const {
  const auto [first, last] = std::minmax_element(offset_s.begin(), offset_s.end());
  const Nanoseconds start = time + std::llround(1e9 * *first) - most;
  Yaws yaws;
  yaws.grid.resize(candidates + static_cast<std::size_t>(1e9 * (*last - *first) / candidate) + 2);
  for (std::size_t k = 0; k < yaws.grid.size(); ++k)
    yaws.grid[k] = place_at(start + static_cast<Nanoseconds>(k) * candidate).yaw;
  yaws.at.reserve(offset_s.size());
  for (const double offset : offset_s) {
    const double at = 1e9 * (offset - *first) / candidate;
    const auto k = static_cast<std::size_t>(at);
    yaws.at.push_back({k, at - static_cast<double>(k)});
  }
  return yaws;
}

void ClockOffset::use(const Profile& before, const Profile& now) {
  constexpr double least_spread_rad = 0.02;  // of odometry's turns by offset: else they tell no offset
  constexpr double margin_rad = 0.05;
  constexpr double off_rad = 0.05;  // a turn that was not found
  constexpr double forget = 0.995;
  if (places_.size() < 2 || places_.front().stamp > before.time - before.farthest - most || now.time <= before.time ||
      seconds(now.time - before.time) > longest_s)
    return;
  std::array<double, candidates> turns{};
  for (std::size_t j = 0; j < candidates; ++j) {
    const Nanoseconds offset = static_cast<Nanoseconds>(j) * candidate - most;
    turns[j] = place_at(now.time + offset).yaw - place_at(before.time + offset).yaw;
  }
  const auto [least, largest] = std::minmax_element(turns.begin(), turns.end());
  if (*largest - *least < least_spread_rad || *largest - *least > std::numbers::pi) return;
  Bins moved = moved_by(before.range_m, before.offset_s, [&](double offset_s) {
    const Nanoseconds offset = value_ + std::llround(1e9 * offset_s);
    const Place from = place_at(before.time + offset), to = place_at(now.time + offset);
    return Eigen::Vector2d(Eigen::Rotation2Dd(-from.yaw) * (to.t_OL - from.t_OL));
  });
  const std::vector<double> before_log = logarithms(std::move(moved.range_m)), now_log = logarithms(now.range_m);
  const std::optional<double> turn = turn_between(before_log, now_log, *least - margin_rad, *largest + margin_rad);
  if (!turn) return;
  if (*turn < *least - off_rad || *turn > *largest + off_rad) return;
  const int turned = static_cast<int>(std::lround(*turn / bin_rad));
  const Yaws from_yaw = yaws_of(before.time, moved.time_s), to_yaw = yaws_of(now.time, now.offset_s);
  std::vector<std::pair<std::size_t, std::size_t>> met;  // bins before and now
  for (int bin = 0; bin < bins; ++bin) {
    const auto here = static_cast<std::size_t>(bin), there = static_cast<std::size_t>(wrapped(bin - turned));
    if (std::isfinite(before_log[here]) && std::isfinite(now_log[there])) met.emplace_back(here, there);
  }
  const WrappedProfile now_ring(now_log);
  PredictedTurn predicted;
  predicted.seen.resize(met.size());
  std::array<double, candidates> seen{}, told{};
  for (std::size_t j = 0; j < candidates; ++j) {
    predicted.mean_rad = 0.0;
    for (std::size_t k = 0; k < met.size(); ++k) {
      const auto [here, there] = met[k];
      const double turns = to_yaw(there, j) - from_yaw(here, j);
      predicted.seen[k] = {before_log[here], static_cast<double>(here) - turns / bin_rad};
      predicted.mean_rad += turns;
    }
    predicted.mean_rad /= static_cast<double>(met.size());
    told[j] = predicted.mean_rad;
    seen[j] = told[j] + more_than(predicted, now_ring, *turn);
  }
  for (std::size_t j = 0; j < candidates; ++j) {
    seen2_[j] = forget * seen2_[j] + seen[j] * seen[j];
    both_[j] = forget * both_[j] + seen[j] * told[j];
    told2_[j] = forget * told2_[j] + told[j] * told[j];
  }
  pairs_ = forget * pairs_ + 1.0;
}

bool ClockOffset::goes_straight() const {
  constexpr double most_rad = 0.05;  // more than a gait sways
  if (places_.size() < 2) return false;
  double least = places_.back().yaw, largest = least;
  for (auto place = places_.rbegin(); place != places_.rend(); ++place) {
    least = std::min(least, place->yaw);
    largest = std::max(largest, place->yaw);
    if (place->stamp <= places_.back().stamp - most) break;  // that of slow odometry, too
  }
  return largest - least < most_rad;
}

// A turning head meets what it saw before a little later or sooner than a revolution after, and odometry has a scale
// of its own: all turns may differ by a factor.
double ClockOffset::left_at(std::size_t j) const {
  constexpr double most_scale = 0.05;
  const double scale = told2_[j] > 0.0 ? std::clamp(both_[j] / told2_[j], 1.0 - most_scale, 1.0 + most_scale) : 1.0;
  return std::max(0.0, seen2_[j] - 2.0 * scale * both_[j] + scale * scale * told2_[j]);
}

void ClockOffset::decide() {
  // In variances of what is left at the best offset: of the one in use, and of those `away`, which is a standard
  // deviation of 6 ms.
  constexpr double fewest_pairs = 20.0, better = 60.0, located = 80.0;
  constexpr std::size_t about = away / candidate;
  std::array<double, candidates> squares{};
  for (std::size_t j = 0; j < candidates; ++j) squares[j] = left_at(j);
  const auto best = static_cast<std::size_t>(std::min_element(squares.begin(), squares.end()) - squares.begin());
  if (pairs_ < fewest_pairs || best < about || best + about >= candidates) return;
  const double variance = squares[best] / pairs_;
  const auto used = static_cast<std::size_t>((value_ + most + candidate / 2) / candidate);
  if (squares[used] - squares[best] < better * variance ||
      std::min(squares[best - about], squares[best + about]) - squares[best] < located * variance)
    return;
  const double part = vertex(squares[best - 1], squares[best], squares[best + 1]);
  const Nanoseconds found = static_cast<Nanoseconds>(best) * candidate - most + std::llround(part * candidate);
  constexpr Nanoseconds better_by = 15'000'000;  // which costs little
  if (std::abs(found - value_) >= (value_ == 0 ? ignored : better_by)) value_ = found;
}

}  // namespace plumbline::slam
