// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/point_cloud.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "bim/errors.h"
#include "slam/io/packets/cloud_fields.h"
#include "slam/io/packets/cloud_order.h"
#include "slam/io/packets/point_clock.h"

namespace plumbline::slam {

static_assert(std::endian::native == std::endian::little);

namespace {

template <class T>
void store(std::vector<std::uint8_t>& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(&bytes[at], &value, sizeof(T));
}

std::vector<CloudPoint> read_points(const PointCloud& cloud, const PointTimes& times) {
  std::vector<CloudPoint> points = read_untimed(cloud);
  const PointField* time = time_field(cloud);
  if (time == nullptr || times.ignored) return points;
  const PointClock clock = clock_of(cloud, *time, points, times);
  // What stands where no return is may be anything. Where that is no time, such a slot has that of the one before.
  Nanoseconds known = std::llround(returns_extent(cloud, clock, points, longest_sweep_ns).first);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = clock.nanoseconds(bytes_of(cloud, i));
    const bool is_time = std::abs(t) <= static_cast<double>(longest_sweep_ns);
    if (is_time) known = std::llround(t);
    points[i].time = known;
    points[i].valid = points[i].valid && is_time;
  }
  return points;
}

bool is_far(const std::vector<CloudPoint>& points) {
  constexpr double farthest_median_m = 500.0;
  std::size_t returns = 0, far = 0;
  for (const CloudPoint& point : points) {
    if (!point.p_L.allFinite() || point.p_L.isZero(0.0)) continue;
    ++returns;
    far += point.p_L.norm() > farthest_median_m ? 1 : 0;
  }
  return 2 * far > returns;
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

CloudScan read_scan(const PointCloud& cloud, const PointTimes& times) {
  check_cloud(cloud);
  CloudScan out;
  Scan& scan = out.scan;
  scan.stamp = cloud.stamp;
  if (cloud.width == 0 || cloud.height == 0) {
    scan.stamp += times.end_ns;
    return out;
  }
  std::vector<CloudPoint> points = read_points(cloud, times);
  out.in_mm = is_in_mm(cloud);
  out.far = is_far(points);
  const bool timed = time_field(cloud) != nullptr && !times.ignored;
  const bool named_rings = ring_field(cloud) != nullptr;
  const auto [rings, columns, rings_left_out] = order_points(points, {cloud.width, cloud.height, named_rings, timed});
  out.rings_left_out = rings_left_out;
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
    if (!point.valid && scan.range_m[slot] > 0.0) continue;
    scan.offset_ns[slot] = static_cast<std::int32_t>(point.time - last);
    if (!point.valid) continue;
    scan.range_m[slot] = point.p_L.norm();
    scan.point_L[slot] = point.p_L;
    scan.reflectivity[slot] = point.reflectivity;
  }
  return out;
}

}  // namespace plumbline::slam
