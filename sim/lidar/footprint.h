// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "bim/rays/scene.h"
#include "sim/lidar/config.h"

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

/// True when two hits are not on one flat face, or on faces of one element whose distance makes a jump in range, m.
[[nodiscard]] bool breaks(const bim::Ray& ray_a, const bim::Hit& a, const bim::Ray& ray_b, const bim::Hit& b,
                          double jump_m);

}  // namespace plumbline::sim
