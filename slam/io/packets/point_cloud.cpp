// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/point_cloud.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "bim/errors.h"
#include "slam/io/packets/cloud_order.h"

namespace plumbline::slam {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr double farthest_m = 1000.0;
constexpr Nanoseconds longest_ns = 1'000'000'000;

std::size_t size_of(PointType type) {
  constexpr std::array<std::size_t, 9> sizes = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return sizes.at(static_cast<std::size_t>(type));
}

template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <class T>
void store(std::vector<std::uint8_t>& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(&bytes[at], &value, sizeof(T));
}

double number_at(const std::uint8_t* bytes, PointType type) {
  switch (type) {
    case PointType::i8:
      return load<std::int8_t>(bytes);
    case PointType::u8:
      return load<std::uint8_t>(bytes);
    case PointType::i16:
      return load<std::int16_t>(bytes);
    case PointType::u16:
      return load<std::uint16_t>(bytes);
    case PointType::i32:
      return load<std::int32_t>(bytes);
    case PointType::u32:
      return load<std::uint32_t>(bytes);
    case PointType::f32:
      return static_cast<double>(load<float>(bytes));
    case PointType::f64:
      return load<double>(bytes);
  }
  return 0.0;
}

const PointField* find_field(const PointCloud& cloud, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const PointField& field : cloud.fields)
      if (field.name == name) return &field;
  return nullptr;
}

// Livox's `line` is no ring: its lines cross each other.
const PointField* ring_field(const PointCloud& cloud) { return find_field(cloud, {"ring", "channel"}); }
const PointField* time_field(const PointCloud& cloud) {
  return find_field(cloud, {"t", "time", "timestamp", "time_stamp"});
}

const PointField& need_field(const PointCloud& cloud, std::string_view name) {
  const PointField* field = find_field(cloud, {name});
  if (field == nullptr) throw InputError({}, "point cloud without field '" + std::string(name) + "'");
  return *field;
}

void check(const PointCloud& cloud) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  if (points == 0 && !cloud.data.empty()) throw InputError({}, "point cloud with bytes and without points");
  if (points > most_cloud_points)
    throw InputError({}, "point cloud of " + std::to_string(points) + " points; at most 4 million");
  if (cloud.row_step < std::uint64_t{cloud.point_step} * cloud.width ||
      cloud.data.size() < std::uint64_t{cloud.row_step} * cloud.height)
    throw InputError({}, "point cloud with fewer bytes than its points need");
  for (const PointField& field : cloud.fields) {
    const auto type = static_cast<unsigned>(field.type);
    if (type < 1 || type > 8) throw InputError({}, "field '" + field.name + "' of no known type");
    if (std::uint64_t{field.offset} + size_of(field.type) > cloud.point_step)
      throw InputError({}, "field '" + field.name + "' lies beyond the point's bytes");
  }
}

/// What the numbers of a time field mean.
struct PointClock {
  const PointField* field = nullptr;
  double unit_ns = 1.0;
  double zero_ns = 0.0;  ///< the cloud's stamp where the times are those of the day, else 0

  [[nodiscard]] double nanoseconds(const std::uint8_t* point) const {
    return unit_ns * number_at(point + field->offset, field->type) - zero_ns;
  }
};

const std::uint8_t* bytes_of(const PointCloud& cloud, std::size_t i) {
  return &cloud.data[i / cloud.width * cloud.row_step + i % cloud.width * std::size_t{cloud.point_step}];
}

/// Least and greatest time of the returns, ns from the stamp; (0, 0) without one.
std::pair<double, double> extent(const PointCloud& cloud, const PointClock& clock,
                                 const std::vector<CloudPoint>& points) {
  std::pair<double, double> found(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid) continue;
    const double t = clock.nanoseconds(bytes_of(cloud, i));
    if (!std::isfinite(t)) return {-std::numeric_limits<double>::infinity(), 0.0};
    found = {std::min(found.first, t), std::max(found.second, t)};
  }
  return found.first > found.second ? std::pair(0.0, 0.0) : found;
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
  /// All points at 0, as before a driver knows the time: that is from neither.
  [[nodiscard]] bool is_without_times() const {
    return extent(cloud_, {&field_, 1.0, 0.0}, points_) == std::pair(0.0, 0.0);
  }
  /// From the stamp, in a unit by which the times are of a scan, 5 ms to 1 s long.
  [[nodiscard]] std::optional<PointClock> in_other_unit() const {
    constexpr double least_turn = 5e6;
    if (whole()) return std::nullopt;
    for (const double unit : units_ns)
      if (const auto clock = fitting({&field_, unit, 0.0}, least_turn)) return clock;
    return std::nullopt;
  }

 private:
  static constexpr std::array<double, 4> units_ns = {1e9, 1e6, 1e3, 1.0};

  [[nodiscard]] bool whole() const { return field_.type != PointType::f32 && field_.type != PointType::f64; }
  [[nodiscard]] std::optional<PointClock> fitting(const PointClock& clock, double least) const {
    constexpr double longest = longest_ns;
    const auto [first, last] = extent(cloud_, clock, points_);
    const bool fits = std::abs(first) <= longest && std::abs(last) <= longest && last - first >= least;
    return fits ? std::optional(clock) : std::nullopt;
  }

  const PointCloud& cloud_;
  const PointField& field_;
  const std::vector<CloudPoint>& points_;
};

PointClock clock_of(const PointCloud& cloud, const PointField& field, const std::vector<CloudPoint>& points,
                    TimeBase base) {
  const ClockChoice choice(cloud, field, points);
  std::optional<PointClock> clock;
  if (base != TimeBase::day || choice.is_without_times()) clock = choice.plain();
  if (!clock && base != TimeBase::stamp) clock = choice.of_day();
  if (!clock && base != TimeBase::day) clock = choice.in_other_unit();
  if (clock) return *clock;
  throw InputError({}, "field '" + field.name +
                           "' is not within 1 s of the stamp, be it in s, ms, us or ns, from the stamp or of the day "
                           "(whole numbers: ns from the stamp)");
}

/// All but their times.
std::vector<CloudPoint> read_untimed(const PointCloud& cloud) {
  const std::array<const PointField*, 3> xyz = {&need_field(cloud, "x"), &need_field(cloud, "y"),
                                                &need_field(cloud, "z")};
  const PointField* intensity = find_field(cloud, {"intensity", "reflectivity"});
  const PointField* ring = ring_field(cloud);
  std::vector<CloudPoint> points(std::size_t{cloud.width} * cloud.height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t* bytes = bytes_of(cloud, i);
    CloudPoint& point = points[i];
    for (int a = 0; a < 3; ++a)
      point.p_L[a] =
          number_at(bytes + xyz[static_cast<std::size_t>(a)]->offset, xyz[static_cast<std::size_t>(a)]->type);
    point.valid = point.p_L.allFinite() && point.p_L.norm() <= farthest_m && !point.p_L.isZero(0.0);
    if (intensity != nullptr) {
      const double value = number_at(bytes + intensity->offset, intensity->type);
      point.reflectivity = static_cast<float>(std::isfinite(value) ? std::clamp(value, 0.0, 255.0) : 0.0);
    }
    if (ring != nullptr) {
      const double value = number_at(bytes + ring->offset, ring->type);
      if (!(value >= 0.0 && value < most_cloud_rings))
        throw InputError({}, "point of a ring that is not within 0 to 127");
      point.ring = static_cast<int>(value);
    }
  }
  return points;
}

std::vector<CloudPoint> read_points(const PointCloud& cloud, TimeBase base) {
  std::vector<CloudPoint> points = read_untimed(cloud);
  const PointField* time = time_field(cloud);
  if (time == nullptr) return points;
  const PointClock clock = clock_of(cloud, *time, points, base);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = clock.nanoseconds(bytes_of(cloud, i));
    // What stands where no return is may be anything.
    if (points[i].valid || std::abs(t) <= static_cast<double>(longest_ns)) points[i].time = std::llround(t);
  }
  return points;
}

}  // namespace

PointCloud cloud_of(const Scan& scan, CloudLayout layout) {
  const bool organised = layout == CloudLayout::organised;
  const Nanoseconds first =
      scan.offset_ns.empty() ? 0 : *std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
  PointCloud cloud;
  cloud.stamp = scan.stamp + first;
  cloud.point_step = 22;
  cloud.dense = !organised;
  cloud.fields = {{"x", 0, PointType::f32},          {"y", 4, PointType::f32},     {"z", 8, PointType::f32},
                  {"intensity", 12, PointType::f32}, {"ring", 16, PointType::u16}, {"time", 18, PointType::f32}};
  if (!organised) cloud.fields.back() = {"t", 18, PointType::u32};
  std::uint32_t points = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool hit = scan.range_m[i] > 0.0;
    if (!hit && !organised) continue;
    ++points;
    for (int a = 0; a < 3; ++a)
      store(cloud.data, hit ? static_cast<float>(scan.point_L[i][a]) : std::numeric_limits<float>::quiet_NaN());
    store(cloud.data, scan.reflectivity[i]);
    store(cloud.data, static_cast<std::uint16_t>(i % static_cast<std::size_t>(scan.rings)));
    const Nanoseconds t = scan.offset_ns[i] - first;
    if (organised)
      store(cloud.data, static_cast<float>(1e-9 * static_cast<double>(t)));
    else
      store(cloud.data, static_cast<std::uint32_t>(t));
  }
  cloud.width = organised ? static_cast<std::uint32_t>(scan.rings) : points;
  cloud.height = organised ? points / static_cast<std::uint32_t>(scan.rings) : 1;
  cloud.row_step = cloud.width * cloud.point_step;
  return cloud;
}

bool TimeBaseSearch::add(const PointCloud& cloud) {
  check(cloud);
  const PointField* time = time_field(cloud);
  if (time == nullptr || time->type != PointType::f64) found_ = TimeBase::unknown;
  if (found_) return false;
  const std::vector<CloudPoint> points = read_untimed(cloud);
  if (std::none_of(points.begin(), points.end(), [](const CloudPoint& point) { return point.valid; })) return true;
  const ClockChoice choice(cloud, *time, points);
  constexpr int most_without_times = 100;  // of a recording that has none, not all is read
  if (choice.is_without_times()) return ++without_times_ < most_without_times;
  const std::optional<PointClock> of_day = choice.of_day();
  const bool from_stamp = choice.plain() || choice.in_other_unit();
  if (of_day && from_stamp) {
    last_ = {cloud.stamp, extent(cloud, *of_day, points).first + of_day->zero_ns};
    if (!first_) first_ = last_;
    return true;
  }
  found_ = of_day ? TimeBase::day : from_stamp ? TimeBase::stamp : TimeBase::unknown;
  return false;
}

TimeBase TimeBaseSearch::base() const {
  if (found_) return *found_;
  if (!first_ || last_->stamp <= first_->stamp) return TimeBase::unknown;
  const double passed = static_cast<double>(last_->stamp - first_->stamp);
  return std::abs(last_->first_ns - first_->first_ns - passed) < 0.5 * passed ? TimeBase::day : TimeBase::stamp;
}

Scan scan_of(const PointCloud& cloud, TimeBase base) {
  check(cloud);
  Scan scan;
  scan.stamp = cloud.stamp;
  if (cloud.width == 0 || cloud.height == 0) return scan;
  std::vector<CloudPoint> points = read_points(cloud, base);
  const bool timed = time_field(cloud) != nullptr;
  const bool named_rings = ring_field(cloud) != nullptr;
  const auto [rings, columns] = order_points(points, {cloud.width, cloud.height, named_rings, timed});
  scan.rings = rings;
  scan.columns = columns;

  const auto first_last = std::minmax_element(points.begin(), points.end(),
                                              [](const CloudPoint& a, const CloudPoint& b) { return a.time < b.time; });
  const Nanoseconds last = first_last.second->time;
  scan.stamp = cloud.stamp + last;
  const auto size = static_cast<std::size_t>(scan.columns) * static_cast<std::size_t>(rings);
  if (size > most_cloud_points) throw InputError({}, "point cloud whose points are not in the order of their firings");
  scan.range_m.assign(size, 0.0);
  scan.point_L.assign(size, Eigen::Vector3d::Zero());
  scan.reflectivity.assign(size, 0.0F);
  // A slot without a point has the time of its column.
  std::vector<Nanoseconds> column_ns(static_cast<std::size_t>(scan.columns), last);
  for (const CloudPoint& point : points)
    if (point.ring >= 0) {
      Nanoseconds& t = column_ns[static_cast<std::size_t>(point.column)];
      t = std::min(t, point.time);
    }
  scan.offset_ns.assign(size, 0);
  for (std::size_t i = 0; i < size; ++i)
    scan.offset_ns[i] = static_cast<std::int32_t>(column_ns[i / static_cast<std::size_t>(rings)] - last);
  for (const CloudPoint& point : points) {
    if (point.ring < 0) continue;
    const std::size_t slot =
        static_cast<std::size_t>(point.column) * static_cast<std::size_t>(rings) + static_cast<std::size_t>(point.ring);
    scan.offset_ns[slot] = static_cast<std::int32_t>(point.time - last);
    if (!point.valid) continue;
    scan.range_m[slot] = point.p_L.norm();
    scan.point_L[slot] = point.p_L;
    scan.reflectivity[slot] = point.reflectivity;
  }
  return scan;
}

}  // namespace plumbline::slam
