// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/point_clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bim/errors.h"
#include "bim/median.h"
#include "slam/io/packets/cloud_fields.h"
#include "slam/io/second.h"

namespace plumbline::slam {

namespace {

constexpr std::array<double, 4> units_ns = {1e9, 1e6, 1e3, 1.0};
constexpr double least_turn = 5e6;  ///< ns
constexpr double unbounded = std::numeric_limits<double>::infinity();

/// As returns_extent(), of whole ns within the second.
std::pair<double, double> extent_in_second(const PointCloud& cloud, const PointField& field,
                                           const std::vector<CloudPoint>& points) {
  constexpr double middle_ns = 499'999'999.5;
  const auto [first, last] = returns_extent(cloud, {&field, 1.0, middle_ns}, points, middle_ns);
  return {first + middle_ns, last + middle_ns};
}

/// The clocks by which a cloud's times may be read, those from the stamp and those of the day.
class ClockChoice {
 public:
  ClockChoice(const PointCloud& cloud, const PointField& field, const std::vector<CloudPoint>& points)
      : cloud_(cloud), field_(field), points_(points) {}

  /// Whole numbers are ns; others s, where that fits.
  [[nodiscard]] std::optional<PointClock> plain() const {
    return fitting({&field_, whole() ? 1.0 : units_ns[0], 0.0}, 0.0);
  }
  /// In the unit that puts all returns within a second of the stamp.
  [[nodiscard]] std::optional<PointClock> of_day() const {
    if (field_.type != PointType::f64) return std::nullopt;
    for (const double unit : units_ns)
      if (const auto clock = fitting({&field_, unit, static_cast<double>(cloud_.stamp)}, 0.0)) return clock;
    return std::nullopt;
  }
  /// Whole ns within the second.
  [[nodiscard]] std::optional<PointClock> of_second() const {
    if (!whole() || !std::isfinite(extent_in_second(cloud_, field_, points_).first)) return std::nullopt;
    return PointClock{&field_, 1.0, static_cast<double>(cloud_.stamp % second_ns), true};
  }
  /// All points at 0, as before a driver knows the time: that is from neither.
  [[nodiscard]] bool is_without_times() const {
    return returns_extent(cloud_, {&field_, 1.0, 0.0}, points_, unbounded) == std::pair(0.0, 0.0);
  }
  /// From the stamp, in a unit that is known.
  [[nodiscard]] std::optional<PointClock> in_unit(double unit_ns) const {
    return fitting({&field_, unit_ns, 0.0}, 0.0);
  }
  /// By how much the times of the returns are ahead of the stamp, s, where they last as long as a scan in some unit.
  [[nodiscard]] std::optional<double> ahead_of_stamp_s() const {
    if (field_.type != PointType::f64) return std::nullopt;
    for (const double unit : units_ns) {
      const auto [first, last] = returns_extent(cloud_, {&field_, unit, 0.0}, points_, unbounded);
      if (std::isfinite(first) && last - first >= least_turn && last - first <= longest_sweep_ns)
        return 1e-9 * (first - static_cast<double>(cloud_.stamp));
    }
    return std::nullopt;
  }
  /// From the stamp, in a unit by which the times are of a scan, 5 ms to 1 s long.
  [[nodiscard]] std::optional<PointClock> in_other_unit() const {
    if (whole()) return std::nullopt;
    for (const double unit : units_ns)
      if (const auto clock = fitting({&field_, unit, 0.0}, least_turn)) return clock;
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool whole() const { return field_.type != PointType::f32 && field_.type != PointType::f64; }
  [[nodiscard]] std::optional<PointClock> fitting(const PointClock& clock, double least) const {
    const auto [first, last] = returns_extent(cloud_, clock, points_, longest_sweep_ns);
    const bool fits = std::isfinite(first) && last - first >= least;
    return fits ? std::optional(clock) : std::nullopt;
  }

  const PointCloud& cloud_;
  const PointField& field_;
  const std::vector<CloudPoint>& points_;
};

std::optional<PointClock> find_clock(const PointCloud& cloud, const PointField& field,
                                     const std::vector<CloudPoint>& points, const PointTimes& times) {
  const ClockChoice choice(cloud, field, points);
  if (times.unit_ns > 0.0) return choice.in_unit(times.unit_ns);
  if (times.base == TimeBase::second && !choice.is_without_times()) return choice.of_second();
  std::optional<PointClock> clock;
  if (times.base != TimeBase::day || choice.is_without_times()) clock = choice.plain();
  if (!clock && times.base != TimeBase::stamp) clock = choice.of_day();
  if (!clock && times.base != TimeBase::day) clock = choice.in_other_unit();
  return clock;
}

/// Clouds that tell nothing of their times: 5 minutes of most LiDARs. Of a longer recording not all is read beforehand.
constexpr int most_without_times = 3000;

/// Whatever its fields are.
bool is_empty(const PointCloud& cloud) { return cloud.width == 0 || cloud.height == 0; }

/// "100 ms"
std::string in_ms(double ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g ms", 1e-6 * ns);
  return text.data();
}

std::string taken_in(std::size_t unit, double sweep_ns) {
  constexpr std::array<std::string_view, units_ns.size()> names = {"s", "ms", "us", "ns"};
  return "point times are taken to be in " + std::string(names[unit]) + ", by which a scan lasts " + in_ms(sweep_ns);
}

}  // namespace

std::pair<double, double> returns_extent(const PointCloud& cloud, const PointClock& clock,
                                         const std::vector<CloudPoint>& points, double most_ns) {
  constexpr std::size_t share = 100;  // of the returns, one
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::pair<double, double> found(infinity, -infinity);
  std::size_t returns = 0, off = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid) continue;
    ++returns;
    const double t = clock.nanoseconds(bytes_of(cloud, i));
    if (std::isfinite(t) && std::abs(t) <= most_ns)
      found = {std::min(found.first, t), std::max(found.second, t)};
    else
      ++off;
  }
  if (share * off > returns) return {-infinity, 0.0};
  return found.first > found.second ? std::pair(0.0, 0.0) : found;
}

PointClock clock_of(const PointCloud& cloud, const PointField& field, const std::vector<CloudPoint>& points,
                    const PointTimes& times) {
  if (const std::optional<PointClock> clock = find_clock(cloud, field, points, times)) return *clock;
  if (const auto ahead_s = ClockChoice(cloud, field, points).ahead_of_stamp_s()) {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "' are %.1f s %s the cloud's stamp; both must be on one clock",
                  std::abs(*ahead_s), *ahead_s > 0.0 ? "ahead of" : "behind");
    throw InputError({}, "times of field '" + field.name + text.data() +
                             "; --without times leaves those of a bag out, and times.txt gives the stamps of a folder");
  }
  if (times.unit_ns > 0.0)
    throw InputError({}, "field '" + field.name +
                             "' is not within 1 s of the stamp in the unit of the first scans; --without times leaves "
                             "point times out where those of a bag's first scans are so");
  throw InputError({}, "field '" + field.name +
                           "' is not within 1 s of the stamp, be it in s, ms, us or ns, from the stamp or of the day "
                           "(whole numbers: ns from the stamp); --without times leaves those of a bag out; stamps of a "
                           "folder's clouds may "
                           "stand in times.txt");
}

bool TimeBaseSearch::add(const PointCloud& cloud) {
  if (is_empty(cloud)) return ++without_times_ < most_without_times;
  check_cloud(cloud);
  const PointField* time = time_field(cloud);
  if (time != nullptr && (time->type == PointType::u32 || time->type == PointType::i32)) return add_whole(cloud, *time);
  if (time == nullptr || time->type != PointType::f64) found_ = TimeBase::unknown;
  if (found_) return false;
  const std::vector<CloudPoint> points = read_untimed(cloud);
  if (std::none_of(points.begin(), points.end(), [](const CloudPoint& point) { return point.valid; }))
    return ++without_times_ < most_without_times;
  const ClockChoice choice(cloud, *time, points);
  if (choice.is_without_times()) return ++without_times_ < most_without_times;
  const std::optional<PointClock> of_day = choice.of_day();
  const bool from_stamp = choice.plain() || choice.in_other_unit();
  if (of_day && from_stamp) {
    last_ = {cloud.stamp, returns_extent(cloud, *of_day, points, longest_sweep_ns).first + of_day->zero_ns};
    if (!first_) first_ = last_;
    return true;
  }
  found_ = of_day ? TimeBase::day : from_stamp ? TimeBase::stamp : TimeBase::unknown;
  return false;
}

bool TimeBaseSearch::add_whole(const PointCloud& cloud, const PointField& time) {
  constexpr int least = 5, enough = 20;  // clouds
  constexpr double far_ns = 0.2e9, share = 0.25;
  if (found_) return false;
  const std::vector<CloudPoint> points = read_untimed(cloud);
  const auto [first, last] = extent_in_second(cloud, time, points);
  if (!(last > first)) return ++without_times_ < most_without_times;
  if (!std::isfinite(first)) {
    found_ = TimeBase::unknown;
    return false;
  }
  // Where the second ends within the cloud, the first point is the least of those before that.
  const bool goes_round = last - first > 0.5e9;
  const double begin = goes_round ? returns_extent(cloud, {&time, 1.0, 0.0, true}, points, unbounded).first : first;
  const Seen seen{cloud.stamp, begin};
  if (!first_) first_ = seen;
  const double passed = static_cast<double>((seen.stamp - first_->stamp) % second_ns);
  const double moved = seen.first_ns - first_->first_ns;
  most_moved_ns_ = std::max(most_moved_ns_, std::abs(moved));
  most_moved_from_stamp_ns_ = std::max(most_moved_from_stamp_ns_, std::abs(std::remainder(moved - passed, 1e9)));
  ++whole_;
  const bool grows = most_moved_ns_ > far_ns, follows = most_moved_from_stamp_ns_ < share * far_ns;
  if (whole_ >= least && !grows && !follows) found_ = TimeBase::unknown;
  if (whole_ >= least && grows) found_ = follows ? TimeBase::second : TimeBase::unknown;
  if (whole_ >= enough && !found_) found_ = TimeBase::unknown;
  return !found_;
}

TimeBase TimeBaseSearch::base() const {
  if (found_) return *found_;
  if (whole_ > 0) return TimeBase::unknown;
  if (!first_ || last_->stamp <= first_->stamp) return TimeBase::unknown;
  const double passed = static_cast<double>(last_->stamp - first_->stamp);
  return std::abs(last_->first_ns - first_->first_ns - passed) < 0.5 * passed ? TimeBase::day : TimeBase::stamp;
}

bool SweepLengthSearch::add(const PointCloud& cloud) {
  constexpr std::size_t enough = 20;
  if (is_empty(cloud)) return ++without_times_ < most_without_times;
  check_cloud(cloud);
  const PointField* time = time_field(cloud);
  if (time == nullptr) {
    unread_ = unread_times(cloud);
    return false;
  }
  if (last_stamp_ && cloud.stamp > *last_stamp_)
    spacings_ns_.push_back(static_cast<double>(cloud.stamp - *last_stamp_));
  last_stamp_ = cloud.stamp;
  const std::vector<CloudPoint> points = read_untimed(cloud);
  const auto [first, last] = returns_extent(cloud, {time, 1.0, 0.0}, points, unbounded);
  const std::optional<PointClock> clock = find_clock(cloud, *time, points, {base_, 0.0, 0, false});
  readable_ = readable_ && clock;
  // A driver may need long to know the time, and the unit is told by what it then writes.
  if (!(last > first) || !std::isfinite(first)) return ++without_times_ < most_without_times;
  const auto [from, to] = clock ? returns_extent(cloud, *clock, points, longest_sweep_ns) : std::pair(0.0, 0.0);
  from_stamp_ = from_stamp_ && (!clock || clock->zero_ns == 0.0);
  const bool is_float = time->type == PointType::f32 || time->type == PointType::f64;
  unit_ns_ = is_float && clock && clock->unit_ns != units_ns[0] ? clock->unit_ns : 0.0;
  lengths_ns_.push_back(clock ? to - from : std::numeric_limits<double>::infinity());
  spans_.push_back(last - first);
  ends_ns_.push_back(to);
  ends_.push_back(last);
  constexpr double none = 1e-3, near = 0.1;  // of a sweep: beyond its ends, left out by blind sectors
  const bool counts_up = first > -none && first < near && last < 1.0 + none;
  const bool counts_down = last > -near && last < none && first > -1.0 - none;
  shares_ = shares_ && (counts_up || counts_down) && last - first > 1.0 - 2.0 * near;
  return spans_.size() < enough;
}

AssumedTimes SweepLengthSearch::found() const {
  AssumedTimes found = unit_found();
  if (found.said.empty() && !unread_.empty()) found.said = unread_ + ": not read as times of points";
  const double unit_ns = found.times.unit_ns;
  const double end_ns = ends_.empty() ? 0.0 : unit_ns > 0.0 ? unit_ns * upper_median(ends_) : upper_median(ends_ns_);
  if (std::abs(end_ns) <= static_cast<double>(longest_sweep_ns)) found.times.end_ns = std::llround(end_ns);
  found.readable = readable_;
  return found;
}

AssumedTimes SweepLengthSearch::unit_found() const {
  constexpr std::size_t least_seen = 2;
  constexpr double shortest = 2e6, too_long = 1.5, longest = 1.3, sparse = 1.0 / 3.0;  // ns; of the spacing
  AssumedTimes found{{base_, 0.0, 0, false}, {}, true};
  if (base_ == TimeBase::second) {
    found.said = "point times are ns within the second, which are taken against the stamps";
    return found;
  }
  if (spacings_ns_.size() < least_seen || spans_.size() < least_seen) return found;
  const double spacing = upper_median(spacings_ns_), length = upper_median(lengths_ns_), span = upper_median(spans_);
  // Of a fast head only some sweeps may have been kept, so that a sweep may be much shorter than the spacing.
  const bool is_long = length > too_long * spacing, is_short = length < shortest && length < sparse * spacing;
  const std::string apart = "; clouds are " + in_ms(spacing) + " apart";
  if (!is_long && !is_short) {
    const auto unit = std::find(units_ns.begin(), units_ns.end(), unit_ns_);
    if (from_stamp_ && unit != units_ns.end()) {
      found.times.unit_ns = unit_ns_;
      found.said = taken_in(static_cast<std::size_t>(unit - units_ns.begin()), length) + apart;
    }
    return found;
  }
  if (is_long && shares_ && from_stamp_) {
    found.times.unit_ns = spacing;
    found.said = "point times from 0 to 1 are taken as shares of a scan of " + in_ms(spacing) + apart;
    return found;
  }
  for (std::size_t i = 0; i < units_ns.size() && from_stamp_; ++i) {
    const double sweep = span * units_ns[i];
    if (sweep < least_turn || sweep > longest * spacing) continue;
    found.times.unit_ns = units_ns[i];
    found.said = taken_in(i, sweep) + apart;
    return found;
  }
  if (std::isfinite(length))
    found.said = "points of a scan are measured over " + in_ms(length) + " by their times" + apart +
                 "; one of the two is wrong, unless scans overlap or are flashes";
  return found;
}

}  // namespace plumbline::slam
