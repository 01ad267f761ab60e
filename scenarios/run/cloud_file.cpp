// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/cloud_file.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::size_t point_bytes = 3 * sizeof(float);
constexpr std::string_view before_count = "ply\nformat binary_little_endian 1.0\nelement vertex ";
constexpr std::string_view after_count = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";

}  // namespace

std::string write_ply(const std::vector<Eigen::Vector3f>& points) {
  std::string bytes = std::string(before_count) + std::to_string(points.size()) + std::string(after_count);
  const std::size_t start = bytes.size();
  bytes.resize(start + points.size() * point_bytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) throw InternalError("a map point is not a finite number");
    std::memcpy(bytes.data() + start + i * point_bytes, points[i].data(), point_bytes);
  }
  return bytes;
}

std::vector<Eigen::Vector3f> read_ply(std::string_view bytes, const std::string& file) {
  const Mark mark{file, 1, 1};
  if (bytes.substr(0, before_count.size()) != before_count) throw InputError(mark, "no binary little-endian PLY");
  bytes.remove_prefix(before_count.size());
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(bytes.data(), bytes.data() + bytes.size(), count);
  bytes.remove_prefix(static_cast<std::size_t>(end - bytes.data()));
  if (error != std::errc() || bytes.substr(0, after_count.size()) != after_count)
    throw InputError(mark, "a PLY of float x, y, z is expected");
  bytes.remove_prefix(after_count.size());
  if (bytes.size() / point_bytes != count || bytes.size() % point_bytes != 0)
    throw InputError(mark, "holds " + std::to_string(bytes.size()) + " bytes for " + std::to_string(count) + " points");
  std::vector<Eigen::Vector3f> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(points[i].data(), bytes.data() + i * point_bytes, point_bytes);
    if (!points[i].allFinite()) throw InputError(mark, "point " + std::to_string(i) + " is not finite");
  }
  return points;
}

}  // namespace plumbline::scenarios
