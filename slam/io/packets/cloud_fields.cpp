// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/cloud_fields.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>

#include "bim/errors.h"

namespace plumbline::slam {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr double farthest_m = 1000.0;
constexpr double ring_beyond = most_cloud_rings + 1.0;  ///< who counts from 1 has the last one, too

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

/// Some drivers leave the row's length at 0.
std::uint64_t row_bytes(const PointCloud& cloud) {
  return cloud.row_step > 0 ? cloud.row_step : std::uint64_t{cloud.point_step} * cloud.width;
}

const PointField* find_field(const PointCloud& cloud, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const PointField& field : cloud.fields)
      if (field.name == name) return &field;
  return nullptr;
}

const PointField& need_field(const PointCloud& cloud, std::string_view name) {
  const PointField* field = find_field(cloud, {name});
  if (field != nullptr) return *field;
  std::string others;
  for (const PointField& other : cloud.fields) others += (others.empty() ? "; it has " : ", ") + other.name;
  throw InputError({}, "point cloud without field '" + std::string(name) + "'" + others);
}

}  // namespace

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

// Livox's `line` is no ring: its lines cross each other.
const PointField* ring_field(const PointCloud& cloud) { return find_field(cloud, {"ring", "channel"}); }
const PointField* time_field(const PointCloud& cloud) {
  return find_field(cloud, {"t", "time", "timestamp", "time_stamp", "offset_time", "time_offset", "time_offset_ns"});
}

std::string unread_times(const PointCloud& cloud) {
  std::string names;
  for (const PointField& field : cloud.fields) {
    std::string name = field.name;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.find("time") == std::string::npos && name.find("stamp") == std::string::npos) continue;
    names += (names.empty() ? "fields " : ", ") + field.name;
  }
  return names;
}

bool is_in_mm(const PointCloud& cloud) {
  const auto is_whole = [&](std::string_view name) {
    const PointField* field = find_field(cloud, {name});
    return field != nullptr && field->type >= PointType::i16 && field->type <= PointType::u32;
  };
  return is_whole("x") && is_whole("y") && is_whole("z");
}

void check_cloud(const PointCloud& cloud) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  if (points == 0 && !cloud.data.empty()) throw InputError({}, "point cloud with bytes and without points");
  if (points > most_cloud_points)
    throw InputError({}, "point cloud of " + std::to_string(points) + " points; at most 4 million");
  if (row_bytes(cloud) < std::uint64_t{cloud.point_step} * cloud.width ||
      cloud.data.size() < row_bytes(cloud) * cloud.height)
    throw InputError({}, "point cloud with fewer bytes than its points need");
  for (const PointField& field : cloud.fields) {
    const auto type = static_cast<unsigned>(field.type);
    if (type < 1 || type > 8) throw InputError({}, "field '" + field.name + "' of no known type");
    if (std::uint64_t{field.offset} + size_of(field.type) > cloud.point_step)
      throw InputError({}, "field '" + field.name + "' lies beyond the point's bytes");
  }
}

const std::uint8_t* bytes_of(const PointCloud& cloud, std::size_t i) {
  return &cloud.data[i / cloud.width * row_bytes(cloud) + i % cloud.width * std::size_t{cloud.point_step}];
}

std::vector<CloudPoint> read_untimed(const PointCloud& cloud) {
  const std::array<const PointField*, 3> xyz = {&need_field(cloud, "x"), &need_field(cloud, "y"),
                                                &need_field(cloud, "z")};
  const PointField* intensity = find_field(cloud, {"intensity", "reflectivity"});
  const PointField* ring = ring_field(cloud);
  const double unit_m = is_in_mm(cloud) ? 1e-3 : 1.0;
  std::vector<CloudPoint> points(std::size_t{cloud.width} * cloud.height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t* bytes = bytes_of(cloud, i);
    CloudPoint& point = points[i];
    for (int a = 0; a < 3; ++a)
      point.p_L[a] =
          unit_m * number_at(bytes + xyz[static_cast<std::size_t>(a)]->offset, xyz[static_cast<std::size_t>(a)]->type);
    point.valid = point.p_L.allFinite() && point.p_L.norm() <= farthest_m && !point.p_L.isZero(0.0);
    if (intensity != nullptr) {
      const double value = number_at(bytes + intensity->offset, intensity->type);
      point.reflectivity = static_cast<float>(std::isfinite(value) ? std::clamp(value, 0.0, 255.0) : 0.0);
    }
    if (ring != nullptr) {
      const double value = number_at(bytes + ring->offset, ring->type);
      const bool is_ring = value >= 0.0 && value < ring_beyond;
      if (is_ring || (value >= 0.0 && point.valid)) point.ring = static_cast<int>(std::min(value, ring_beyond));
    }
  }
  return points;
}

}  // namespace plumbline::slam
