// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/footprint.h"

#include <cmath>

namespace plumbline::sim {

SubRays footprint_of(const LidarConfig& config) {
  constexpr std::size_t grid = 4;
  SubRays out;
  static_assert(std::tuple_size_v<SubRays> == grid * grid);
  const auto offset = [](std::size_t i, double full) {
    return full * ((static_cast<double>(i) + 0.5) / static_cast<double>(grid) - 0.5);
  };
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double across = offset(i % grid, config.divergence_horizontal_rad);
    const double up = offset(i / grid, config.divergence_vertical_rad);
    out[i] = {across, up, 1.0 / std::sqrt(1.0 + across * across + up * up)};
  }
  return out;
}

bim::Ray sub_ray(const bim::Ray& centre, const Tangents& tangents, const SubRay& sub) {
  bim::Ray ray = centre;
  ray.direction_W = sub.unit * (centre.direction_W + sub.across * tangents.across_W + sub.up * tangents.up_W);
  return ray;
}

bool leaves_face(const bim::Ray& ray_a, const bim::Hit& a, const bim::Ray& ray_b, const bim::Hit& b, double jump_m) {
  constexpr double same_face = 0.999;  // cosine: 2.6 degrees
  if (a.normal_W.dot(b.normal_W) < same_face) return true;
  const Eigen::Vector3d apart_W =
      ray_a.origin_W + a.range_m * ray_a.direction_W - ray_b.origin_W - b.range_m * ray_b.direction_W;
  return std::abs(a.normal_W.dot(apart_W)) > jump_m * std::abs(a.normal_W.dot(ray_a.direction_W));
}

}  // namespace plumbline::sim
