// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/bin_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "bim/config/input_file.h"
#include "bim/errors.h"
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
  return cloud;
}

}  // namespace plumbline::slam
