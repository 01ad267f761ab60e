// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/bin_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

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

/// How much coordinates differ from one point to the next, were there so many numbers a point; the median.
float roughness(const std::vector<std::uint8_t>& data, std::size_t numbers) {
  constexpr std::size_t most = 10000;  // tell enough
  constexpr std::size_t axes = 3;
  const std::size_t step = numbers * sizeof(float),
                    points = std::min((data.size() - axes * sizeof(float)) / step, most);
  std::vector<float> jumps;
  for (std::size_t i = 0; i + 1 < points; ++i)
    for (std::size_t axis = 0; axis < axes; ++axis) {
      std::array<float, 2> values{};
      std::memcpy(values.data(), &data[i * step + axis * sizeof(float)], sizeof(float));
      std::memcpy(values.data() + 1, &data[(i + 1) * step + axis * sizeof(float)], sizeof(float));
      if (const float jump = std::abs(values[1] - values[0]); std::isfinite(jump)) jumps.push_back(jump);
    }
  return jumps.empty() ? 0.0F : upper_median(std::move(jumps));
}

/// So many numbers a point make neighbours of points, and the number that is expected does not; 0 none. One: the points
/// lie axis by axis.
std::size_t other_numbers(const std::vector<std::uint8_t>& data, std::size_t expected) {
  constexpr std::size_t least_points = 100;
  constexpr float plainly = 4.0F;  // 0.03 m against 3 m on KITTI's scans read as five numbers a point
  if (data.size() < least_points * expected * sizeof(float)) return 0;
  const float as_expected = roughness(data, expected);
  for (const std::size_t numbers : {1U, 3U, 4U, 5U, 6U, 7U, 8U})
    if (numbers != expected && data.size() % (numbers * sizeof(float)) == 0 &&
        plainly * roughness(data, numbers) < as_expected)
      return numbers;
  return 0;
}

}  // namespace

bool is_bin_cloud(std::string_view file) { return file.ends_with(".bin"); }

PointCloud read_bin_cloud(const std::string& file) {
  const bool with_ring = file.ends_with(".pcd.bin");
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
  if (const std::size_t numbers = other_numbers(cloud.data, cloud.fields.size()); numbers > 0)
    throw InputError({file, 0, 0},
                     (numbers == 1 ? "it seems to hold all x, then all y and z; "
                                   : "its points seem to be of " + std::to_string(numbers) + " float32 each; ") +
                         layout);
  return cloud;
}

}  // namespace plumbline::slam
