// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bim/rays/ray_scene.h"

namespace plumbline::bim {

/// Which part of a body a ray meets.
struct BodyHit {
  double range_m = 0.0;
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< unit, outwards
};

/// Where the body is at a time: before its first station and after its last it rests, between two it moves evenly.
[[nodiscard]] BodyStation station_at(const MovingBody& body, double time_s);

/// Nearest point ahead of the ray's origin where it passes through the body's surface, from outside or inside;
/// range_m is infinite when there is none.
[[nodiscard]] BodyHit hit_body(const MovingBody& body, const Ray& ray);

/// Bodies with what keeps rays from being tested against them one by one.
class MovingBodies {
 public:
  static constexpr std::size_t most = 256;

  MovingBodies() = default;
  /// Throws InternalError on more than `most` bodies or on one without a station or without extent.
  explicit MovingBodies(std::vector<MovingBody> bodies);

  [[nodiscard]] bool empty() const { return bodies_.empty(); }
  /// Puts bodies into the hits of rays that stand next to each other: within the tie distance of the nearest the
  /// lowest element wins, as among faces.
  void cast(std::span<const Ray> rays, double range_max_m, std::span<Hit> hits) const;

 private:
  struct Sphere {
    Eigen::Vector3d center_W;
    double radius_m = 0.0;
  };
  void cast_one(const Ray& ray, double range_max_m, std::span<const std::size_t> near, Hit& hit) const;

  std::vector<MovingBody> bodies_;
  std::vector<Sphere> spheres_;  ///< bounds each body over its motion
};

}  // namespace plumbline::bim
