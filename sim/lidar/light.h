// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "sim/lidar/lidar_config.h"
#include "sim/lidar/surface.h"

namespace plumbline::sim {

/// What happened to the light of a return; bits.
namespace light_path {
inline constexpr std::uint8_t mixed = 1;     ///< from surfaces apart: the range lies between them
inline constexpr std::uint8_t through = 2;   ///< came through a pane
inline constexpr std::uint8_t mirrored = 4;  ///< came over a polished surface: seen where nothing is
inline constexpr std::uint8_t glint = 8;     ///< mirrored straight back
}  // namespace light_path

/// A place that gives some of a ray's light back to the sensor.
struct Reflection {
  std::uint32_t beam = 0;  ///< whose ray it was
  double path_m = 0.0;     ///< length of the light's way there
  double strength = 0.0;   ///< reflectivity times what was left of the light, both ways
  double cosine = 1.0;     ///< of the angle of incidence
  std::uint8_t flags = 0;  ///< light_path
  std::int32_t element = -1;
  std::int32_t triangle = -1;
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();  ///< of the light on arrival

  /// What the sensor gets of it, up to a factor.
  [[nodiscard]] double energy() const {
    const double r = std::max(path_m, 0.01);
    return strength * cosine / (r * r);
  }
};

/// A ray on its way.
struct Leg {
  std::uint32_t beam = 0;
  bim::Ray ray;
  double before_m = 0.0;  ///< way behind it
  double gain = 1.0;      ///< what is left of its light, both ways
  int inside = -1;        ///< element whose body it passes through
  int bounces = 0;
  std::uint8_t flags = 0;
};

/// Follows light through panes and over polished surfaces, all rays of a batch step by step, so that they are cast in
/// packets. At most two mirrors and eight surfaces a ray.
class Light {
 public:
  /// Elements beyond `surfaces` reflect config.reflectivity. Scene and surfaces must outlive it.
  Light(const bim::RayScene& scene, std::span<const Surface> surfaces, const LidarConfig& config);

  [[nodiscard]] Surface surface(int element) const {
    const auto i = static_cast<std::size_t>(element);
    return i < surfaces_.size() ? surfaces_[i] : Surface{reflectivity_, 0.0, 0.0};
  }

  /// Appends the reflections of every leg, which is given with what it hits. Both are used up.
  void follow(std::vector<Leg>& legs, std::vector<bim::Hit>& hits, std::vector<Reflection>& out);

 private:
  void arrive(const Leg& leg, const bim::Hit& hit, std::vector<Reflection>& out);
  void go_on(const Leg& leg, const bim::Hit& hit, const Surface& surface);

  const bim::RayScene& scene_;
  std::span<const Surface> surfaces_;
  double reflectivity_;
  double range_max_m_;
  double glint_cosine_;
  bool optics_;
  std::vector<Leg> next_;
  std::vector<bim::Ray> rays_;
};

}  // namespace plumbline::sim
