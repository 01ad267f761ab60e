// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/bin_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "bim/config/file_ending.h"
#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "bim/median.h"
#include "slam/io/packets/cloud_order.h"

namespace plumbline::slam {

namespace {

/// Bytes of something else, taken for float32, are mostly huge or next to nothing.
bool is_unlikely(const std::uint8_t* point) {
  constexpr float least_m = 1e-6F, most_m = 1e5F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float value = 0.0F;
    std::memcpy(&value, point + axis * sizeof value, sizeof value);
    const float size = std::abs(value);
    if (std::isfinite(value) && value != 0.0F && (size < least_m || size > most_m)) return true;
  }
  return false;
}

constexpr std::size_t least_looked_at = 100, most_looked_at = 10000;  // that tell how points lie

float number_in(const std::vector<std::uint8_t>& data, std::size_t k) {
  float value = 0.0F;
  std::memcpy(&value, &data[k * sizeof value], sizeof value);
  return value;
}

/// How much coordinates differ from one point to the next, were there so many numbers a point; the median.
float roughness(const std::vector<std::uint8_t>& data, std::size_t numbers) {
  const std::size_t points = std::min(data.size() / (numbers * sizeof(float)), most_looked_at);
  std::vector<float> jumps;
  for (std::size_t i = 0; i + 1 < points; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float jump = std::abs(number_in(data, (i + 1) * numbers + axis) - number_in(data, i * numbers + axis));
      if (std::isfinite(jump)) jumps.push_back(jump);
    }
  return jumps.empty() ? 0.0F : upper_median(std::move(jumps));
}

/// So many numbers a point make neighbours of points, and the number that is expected does not; 0 none.
std::size_t other_numbers(const std::vector<std::uint8_t>& data, std::size_t expected) {
  // On three real captures (16 and 64 rings), as stored and with their points in any order, the right number is at most
  // 1.04 times as rough as another; of five numbers read as four, 14 times and more.
  constexpr float plainly = 4.0F;
  if (data.size() < least_looked_at * expected * sizeof(float)) return 0;
  const float as_expected = roughness(data, expected);
  // Every second point, as twice the numbers would make it, may be nearer than the next: lasers fire out of order.
  for (const std::size_t numbers : {3U, 4U, 5U, 6U, 7U})
    if (numbers != expected && data.size() % (numbers * sizeof(float)) == 0 &&
        plainly * roughness(data, numbers) < as_expected)
      return numbers;
  return 0;
}

/// All x stand before all y: one number is near the next, whose axis is another's in points.
bool is_by_axis(const std::vector<std::uint8_t>& data) {
  constexpr float near = 0.4F;  // of their size; on the same captures 1.7 and more by points, 0.1 and less by axis
  const std::size_t numbers = std::min(data.size() / sizeof(float), 4 * most_looked_at);
  if (numbers < 4 * least_looked_at) return false;
  std::vector<float> jumps, sizes;
  for (std::size_t k = 0; k + 1 < numbers; ++k) {
    const float value = number_in(data, k), jump = std::abs(number_in(data, k + 1) - value);
    if (std::isfinite(jump)) jumps.push_back(jump);
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  }
  return !jumps.empty() && upper_median(std::move(jumps)) < near * upper_median(std::move(sizes));
}

}  // namespace

bool is_bin_cloud(std::string_view file) { return has_ending(file, ".bin"); }

PointCloud read_bin_cloud(const std::string& file) {
  const bool with_ring = has_ending(file, ".pcd.bin");
  PointCloud cloud;
  for (const char* name : {"x", "y", "z", "intensity", "ring"})
    if (with_ring || cloud.fields.size() < 4)
      cloud.fields.push_back({name, static_cast<std::uint32_t>(4 * cloud.fields.size()), PointType::f32});
  cloud.point_step = static_cast<std::uint32_t>(4 * cloud.fields.size());
  const std::string layout =
      with_ring ? "nuScenes' points are 20 (x, y, z, intensity, ring as float32)"
                : "KITTI's points are 16 (x, y, z, intensity as float32), and files with a ring are to end in .pcd.bin";

  const InputFile input = open_input_file(file, std::uint64_t{most_cloud_points} * cloud.point_step);
  if (!input.regular) throw InputError({file, 0, 0}, "is no regular file");
  if (input.bytes == 0) throw InputError({file, 0, 0}, "is empty");
  if (input.bytes % cloud.point_step != 0)
    throw InputError({file, 0, 0}, "its " + std::to_string(input.bytes) + " bytes are no whole points; " + layout);
  cloud.data.resize(static_cast<std::size_t>(input.bytes));
  if (std::fread(cloud.data.data(), 1, cloud.data.size(), input.stream.get()) != cloud.data.size())
    throw InputError({file, 0, 0}, "cannot be read");
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(cloud.data.size() / cloud.point_step);
  cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());

  std::size_t unlikely = 0;
  for (std::size_t at = 0; at < cloud.data.size(); at += cloud.point_step)
    unlikely += is_unlikely(&cloud.data[at]) ? 1 : 0;
  if (2 * unlikely > cloud.width)
    throw InputError({file, 0, 0}, "most of its numbers are no coordinates in metres; " + layout);
  if (is_by_axis(cloud.data)) throw InputError({file, 0, 0}, "it seems to hold all x, then all y and z; " + layout);
  if (const std::size_t numbers = other_numbers(cloud.data, cloud.fields.size()); numbers > 0)
    throw InputError({file, 0, 0}, "its points seem to be of " + std::to_string(numbers) + " float32 each; " + layout);
  return cloud;
}

}  // namespace plumbline::slam
