// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "bim/rays/ray_scene.h"
#include "sim/lidar/lidar_config.h"

namespace plumbline::sim {

/// A sub-ray of a footprint: offsets along the tangents, and what makes the direction unit.
struct SubRay {
  double across = 0.0;
  double up = 0.0;
  double unit = 1.0;
};

/// A grid over the beam's width and height.
using SubRays = std::array<SubRay, 16>;
[[nodiscard]] SubRays footprint_of(const LidarConfig& config);

/// Unit vectors square to a beam, in W.
struct Tangents {
  Eigen::Vector3d across_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d up_W = Eigen::Vector3d::Zero();
};

/// The beam's central ray turned to a sub-ray.
[[nodiscard]] bim::Ray sub_ray(const bim::Ray& centre, const Tangents& tangents, const SubRay& sub);

/// True when two hits of one element are not on one flat face, or on faces whose distance makes a jump in range, m.
[[nodiscard]] bool leaves_face(const bim::Ray& ray_a, const bim::Hit& a, const bim::Ray& ray_b, const bim::Hit& b,
                               double jump_m);

/// The same of hits on any elements, or on none.
[[nodiscard]] inline bool breaks(const bim::Ray& ray_a, const bim::Hit& a, const bim::Ray& ray_b, const bim::Hit& b,
                                 double jump_m) {
  if (a.element != b.element) return true;
  if (a.element < 0 || (a.triangle >= 0 && a.triangle == b.triangle)) return false;
  return leaves_face(ray_a, a, ray_b, b, jump_m);
}

}  // namespace plumbline::sim
