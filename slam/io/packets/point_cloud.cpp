// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/point_cloud.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>

#include "bim/errors.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::slam {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr double farthest_m = 1000.0;
constexpr double column_azimuth =
    0.3 * std::numbers::pi / 180.0;  ///< lasers of a VLP-16 that fire together lie this close
constexpr Nanoseconds longest_ns = 1'000'000'000;
constexpr std::uint64_t most_points = 4'000'000;
constexpr int most_rings = 128;

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

const PointField& need_field(const PointCloud& cloud, std::string_view name) {
  const PointField* field = find_field(cloud, {name});
  if (field == nullptr) throw InputError({}, "point cloud without field '" + std::string(name) + "'");
  return *field;
}

void check(const PointCloud& cloud) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  if (points == 0 && !cloud.data.empty()) throw InputError({}, "point cloud with bytes and without points");
  if (points > most_points)
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

/// One point of a cloud.
struct Point {
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  bool valid = false;
  float reflectivity = 0.0F;
  int ring = -1;         ///< -1 until it is known
  Nanoseconds time = 0;  ///< from the cloud's stamp
  int column = 0;
};

/// Time of a point from the cloud's stamp, in ns; the field decides what the number means.
Nanoseconds time_of(const PointCloud& cloud, const PointField& field, const std::uint8_t* bytes) {
  double t = number_at(bytes + field.offset, field.type);
  const bool whole = field.type != PointType::f32 && field.type != PointType::f64;
  if (!whole) t *= 1e9;
  if (field.type == PointType::f64 && std::abs(t) > 1e3 * 1e9) t -= static_cast<double>(cloud.stamp);
  if (!(std::abs(t) <= static_cast<double>(longest_ns)))
    throw InputError({},
                     "field '" + field.name + "' is not within 1 s of the stamp; f32 and f64 must be s, integers ns");
  return std::llround(t);
}

std::vector<Point> read_points(const PointCloud& cloud) {
  const std::array<const PointField*, 3> xyz = {&need_field(cloud, "x"), &need_field(cloud, "y"),
                                                &need_field(cloud, "z")};
  const PointField* intensity = find_field(cloud, {"intensity", "reflectivity"});
  const PointField* ring = find_field(cloud, {"ring"});
  const PointField* time = find_field(cloud, {"t", "time", "timestamp", "time_stamp"});
  std::vector<Point> points(std::size_t{cloud.width} * cloud.height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t* bytes =
        &cloud.data[i / cloud.width * cloud.row_step + i % cloud.width * std::size_t{cloud.point_step}];
    Point& point = points[i];
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
      if (!(value >= 0.0 && value < most_rings)) throw InputError({}, "point of a ring that is not within 0 to 127");
      point.ring = static_cast<int>(value);
    }
    if (time != nullptr) point.time = time_of(cloud, *time, bytes);
  }
  return points;
}

double elevation_deg(const Point& point) {
  return std::atan2(point.p_L.z(), point.p_L.head<2>().norm()) * (180.0 / std::numbers::pi);
}

/// Rings of a VLP-16 by elevation, for clouds that do not name them. False, and nothing is changed, unless nearly all
/// points lie where its lasers point: by chance three in ten do.
bool find_rings(std::vector<Point>& points) {
  constexpr double off_deg = 0.3, origin_m = 0.0112;  // of an elevation; of a laser's origin above the sensor's
  constexpr double least_share = 0.8;
  std::size_t valid = 0, on_ring = 0;
  std::vector<int> rings(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid) continue;
    ++valid;
    const double place = (elevation_deg(points[i]) + 15.0) / 2.0;
    const double nearest = std::clamp(std::round(place), 0.0, vlp16::rings - 1.0);
    const double slack_deg = off_deg + origin_m / points[i].p_L.norm() * (180.0 / std::numbers::pi);
    if (2.0 * std::abs(place - nearest) <= slack_deg) ++on_ring;
    rings[i] = static_cast<int>(nearest);
  }
  if (static_cast<double>(on_ring) < least_share * static_cast<double>(valid)) return false;
  for (std::size_t i = 0; i < points.size(); ++i) points[i].ring = rings[i];
  return true;
}

int ring_count(const std::vector<Point>& points) {
  int highest = 0;
  for (const Point& point : points) highest = std::max(highest, point.ring);
  for (const int rings : {16, 32, 64})
    if (highest < rings) return rings;
  return most_rings;
}

/// Ring 0 is the lowest here; some drivers count from the top.
void order_rings(std::vector<Point>& points, int rings) {
  double rising = 0.0;
  std::vector<double> sum(static_cast<std::size_t>(rings), 0.0), count(sum);
  for (const Point& point : points) {
    if (point.ring < 0 || !point.valid) continue;
    sum[static_cast<std::size_t>(point.ring)] += elevation_deg(point);
    count[static_cast<std::size_t>(point.ring)] += 1.0;
  }
  for (std::size_t r = 1; r < sum.size(); ++r)
    if (count[r] > 0.0 && count[r - 1] > 0.0) rising += sum[r] / count[r] > sum[r - 1] / count[r - 1] ? 1.0 : -1.0;
  if (rising >= 0.0) return;
  for (Point& point : points)
    if (point.ring >= 0) point.ring = rings - 1 - point.ring;
}

/// Firing of each point from its time, for a VLP-16 with a time for every laser. False where times do not fit the
/// firings.
bool columns_by_time(std::vector<Point>& points) {
  std::array<Nanoseconds, vlp16::rings> laser_ns{};
  for (int k = 0; k < vlp16::rings; ++k)
    laser_ns[static_cast<std::size_t>(vlp16::ring_of_laser(k))] = k * vlp16::laser_period_ns;
  const auto firing_ns = [&](const Point& point) {
    return point.time - laser_ns[static_cast<std::size_t>(point.ring)];
  };
  Nanoseconds first = std::numeric_limits<Nanoseconds>::max();
  for (const Point& point : points)
    if (point.ring >= 0) first = std::min(first, firing_ns(point));
  for (Point& point : points) {
    if (point.ring < 0) continue;
    const Nanoseconds t = firing_ns(point) - first;
    const Nanoseconds column = (t + vlp16::firing_period_ns / 2) / vlp16::firing_period_ns;
    if (std::abs(t - column * vlp16::firing_period_ns) > vlp16::laser_period_ns / 2) return false;
    point.column = static_cast<int>(column);
  }
  return true;
}

/// Columns in the order of the points, whose place in a firing is place[ring]: a new one where the place does not
/// increase or the azimuth has gone on by more than azimuth_max. Returns their number.
int columns_in_order(std::vector<Point>& points, const std::array<int, most_rings>& place, double azimuth_max) {
  int column = -1, last_place = 0;
  double azimuth = 0.0;
  for (Point& point : points) {
    if (!point.valid || point.ring < 0) continue;
    const double here = std::atan2(point.p_L.y(), point.p_L.x());
    const int here_place = place[static_cast<std::size_t>(point.ring)];
    if (column < 0 || here_place <= last_place || std::abs(wrap_angle(here - azimuth)) > azimuth_max) {
      ++column;
      azimuth = here;
    }
    last_place = here_place;
    point.column = column;
  }
  return column + 1;
}

/// Points of a firing come by ring or, of a VLP-16, as its lasers fire: whichever gives fewer columns.
void columns_by_azimuth(std::vector<Point>& points, int rings) {
  std::array<int, most_rings> by_ring{}, by_laser{};
  for (int r = 0; r < most_rings; ++r) by_ring[static_cast<std::size_t>(r)] = by_laser[static_cast<std::size_t>(r)] = r;
  for (int k = 0; k < vlp16::rings && rings == vlp16::rings; ++k)
    by_laser[static_cast<std::size_t>(vlp16::ring_of_laser(k))] = k;
  // Other sensors' lasers may point degrees apart.
  const double azimuth_max = rings == vlp16::rings ? column_azimuth : std::numbers::pi;
  if (columns_in_order(points, by_laser, azimuth_max) >= columns_in_order(points, by_ring, azimuth_max)) return;
  static_cast<void>(columns_in_order(points, by_laser, azimuth_max));
}

int column_count(const std::vector<Point>& points) {
  int last = 0;
  for (const Point& point : points) last = std::max(last, point.column);
  return last + 1;
}

/// Columns by azimuth alone, for points that come ring by ring or in no order: as many as the fullest ring has points,
/// and half as many again for those that fall into a column twice, which move to the next free one or are dropped.
void columns_by_angle(std::vector<Point>& points, int rings) {
  std::vector<int> filled(static_cast<std::size_t>(rings), 0);
  for (const Point& point : points)
    if (point.ring >= 0 && point.valid) ++filled[static_cast<std::size_t>(point.ring)];
  const int fullest = *std::max_element(filled.begin(), filled.end());
  const int columns = fullest + fullest / 2 + 1;
  if (static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rings) > most_points)
    throw InputError({}, "point cloud with most of its points on one ring");
  std::vector<bool> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rings), false);
  for (Point& point : points) {
    if (point.ring < 0 || !point.valid) {
      point.ring = -1;
      continue;
    }
    const double turn = 0.5 - std::atan2(point.p_L.y(), point.p_L.x()) / (2.0 * std::numbers::pi);  // clockwise
    const int column = std::clamp(static_cast<int>(turn * columns), 0, columns - 1);
    const auto slot = [&](int c) {
      return static_cast<std::size_t>(c % columns) * static_cast<std::size_t>(rings) +
             static_cast<std::size_t>(point.ring);
    };
    constexpr int reach = 3;
    int step = 0;
    while (step < reach && taken[slot(column + step)]) ++step;
    point.column = (column + step) % columns;
    if (step == reach) point.ring = -1;
    if (step < reach) taken[slot(column + step)] = true;
  }
}

/// Gives every point its column; returns how many there are.
int find_columns(const PointCloud& cloud, std::vector<Point>& points, int rings, bool timed) {
  const auto count = static_cast<std::uint32_t>(rings);
  const bool row_a_firing = cloud.width == count && cloud.height > 1;
  const bool row_a_ring = !row_a_firing && cloud.height == count && cloud.width > 1;
  for (std::size_t i = 0; i < points.size() && (row_a_firing || row_a_ring); ++i)
    points[i].column = static_cast<int>(row_a_firing ? i / cloud.width : i % cloud.width);
  if (row_a_firing || row_a_ring) return column_count(points);
  if (timed && rings == vlp16::rings && columns_by_time(points)) return column_count(points);
  columns_by_azimuth(points, rings);
  constexpr std::size_t emptiest = 4;  // slots a point
  const auto columns = static_cast<std::size_t>(column_count(points));
  if (columns * static_cast<std::size_t>(rings) > emptiest * std::max(points.size(), columns))
    columns_by_angle(points, rings);
  return column_count(points);
}

/// Rows or columns of an organised cloud as rings, where no field names them. False: it is not organised so.
bool rings_by_layout(const PointCloud& cloud, std::vector<Point>& points) {
  const auto is_ring_count = [](std::uint32_t n) { return n == 16 || n == 32 || n == 64 || n == most_rings; };
  const bool row_a_firing = is_ring_count(cloud.width) && cloud.height > cloud.width;
  if (!row_a_firing && !(is_ring_count(cloud.height) && cloud.width > 1)) return false;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].ring = static_cast<int>(row_a_firing ? i % cloud.width : i / cloud.width);
  return true;
}

/// A scan without order: one ring, a column a point.
int without_rings(std::vector<Point>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].ring = 0;
    points[i].column = static_cast<int>(i);
  }
  return static_cast<int>(points.size());
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

Scan scan_of(const PointCloud& cloud) {
  check(cloud);
  Scan scan;
  scan.stamp = cloud.stamp;
  if (cloud.width == 0 || cloud.height == 0) return scan;
  std::vector<Point> points = read_points(cloud);
  const bool timed = find_field(cloud, {"t", "time", "timestamp", "time_stamp"}) != nullptr;
  const bool named_rings = find_field(cloud, {"ring"}) != nullptr;
  const bool ringed = named_rings || rings_by_layout(cloud, points) || find_rings(points);
  const int rings = ringed ? ring_count(points) : 1;
  if (ringed) order_rings(points, rings);
  scan.rings = rings;
  scan.columns = ringed ? find_columns(cloud, points, rings, timed) : without_rings(points);

  const auto first_last =
      std::minmax_element(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.time < b.time; });
  const Nanoseconds last = first_last.second->time;
  scan.stamp = cloud.stamp + last;
  const auto size = static_cast<std::size_t>(scan.columns) * static_cast<std::size_t>(rings);
  if (size > most_points) throw InputError({}, "point cloud whose points are not in the order of their firings");
  scan.range_m.assign(size, 0.0);
  scan.point_L.assign(size, Eigen::Vector3d::Zero());
  scan.reflectivity.assign(size, 0.0F);
  // A slot without a point has the time of its column.
  std::vector<Nanoseconds> column_ns(static_cast<std::size_t>(scan.columns), last);
  for (const Point& point : points)
    if (point.ring >= 0) {
      Nanoseconds& t = column_ns[static_cast<std::size_t>(point.column)];
      t = std::min(t, point.time);
    }
  scan.offset_ns.assign(size, 0);
  for (std::size_t i = 0; i < size; ++i)
    scan.offset_ns[i] = static_cast<std::int32_t>(column_ns[i / static_cast<std::size_t>(rings)] - last);
  for (const Point& point : points) {
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
