// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/registration_timing.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bim/errors.h"
#include "slam/io/stopwatch.h"
#include "slam/registration/cloud_surfels.h"

namespace plumbline::scenarios {

namespace {

/// Number of vertices and of floats of each; leaves the stream at the data.
std::array<std::size_t, 2> read_header(std::istream& in, const std::string& file) {
  std::array<std::size_t, 2> size{};
  bool binary = false;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "end_header") break;
    if (first == "format") binary = second == "binary_little_endian";
    if (first == "element" && second == "vertex") words >> size[0];
    if (first != "property") continue;
    if (second != "float") throw InputError({file}, "a property that is not float: '" + line + "'");
    ++size[1];
  }
  if (!binary || !in || size[1] < 3) throw InputError({file}, "a binary little-endian .ply with x, y, z is expected");
  return size;
}

}  // namespace

std::vector<Eigen::Vector3f> read_ply(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError({file}, "cannot be read");
  const auto [count, floats] = read_header(in, file);
  std::vector<float> point(floats);
  const std::size_t bytes = floats * sizeof(float);
  if (count > std::filesystem::file_size(file) / bytes) throw InputError({file}, "is shorter than its header says");
  std::vector<Eigen::Vector3f> points;
  points.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (!in.read(reinterpret_cast<char*>(point.data()), static_cast<std::streamsize>(bytes)))
      throw InputError({file}, "is shorter than its header says");
    points.emplace_back(point[0], point[1], point[2]);
  }
  return points;
}

Registered register_ours(const std::vector<Eigen::Vector3f>& target_T, const std::vector<Eigen::Vector3f>& source_S) {
  const slam::Stopwatch watch;
  const slam::Registration result = slam::register_clouds(target_T, source_S, Pose{}, {});
  return {result.X_MR, watch.cpu_ms()};
}

}  // namespace plumbline::scenarios
