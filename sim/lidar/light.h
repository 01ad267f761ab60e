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
inline constexpr std::uint8_t mixed = 1;      ///< from surfaces apart: the range lies between them
inline constexpr std::uint8_t through = 2;    ///< came through a pane
inline constexpr std::uint8_t mirrored = 4;   ///< came over a mirror: the return lies where there is no surface
inline constexpr std::uint8_t glint = 8;      ///< mirrored straight back
inline constexpr std::uint8_t airborne = 16;  ///< came back from dust or rain: of no element
}  // namespace light_path

/// A point that reflects part of a ray's light back to the sensor.
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

/// One straight segment of a light path.
struct RaySegment {
  std::uint32_t beam = 0;
  bim::Ray ray;
  double before_m = 0.0;  ///< path length before this segment
  double gain = 1.0;      ///< what is left of its light, both ways
  int inside = -1;        ///< element whose body it passes through
  int bounces = 0;
  std::uint8_t flags = 0;
};

/// Traces light through panes and over mirrors. All rays of a batch advance one surface at a time, so that they are
/// cast in packets. At most two mirrors and eight surfaces a ray.
class Light {
 public:
  /// Elements beyond `surfaces` reflect config.reflectivity. Scene and surfaces must outlive it.
  Light(const bim::RayScene& scene, std::span<const Surface> surfaces, const LidarConfig& config);

  [[nodiscard]] Surface surface(int element) const {
    const auto i = static_cast<std::size_t>(element);
    return i < surfaces_.size() ? surfaces_[i] : Surface{reflectivity_, 0.0, 0.0};
  }

  /// Appends the reflections of every segment; hits[i] belongs to segments[i]. Consumes both.
  void trace(std::vector<RaySegment>& segments, std::vector<bim::Hit>& hits, std::vector<Reflection>& out);

 private:
  void process_hit(const RaySegment& segment, const bim::Hit& hit, std::vector<Reflection>& out);
  void spawn_segments(const RaySegment& segment, const bim::Hit& hit, const Surface& surface);

  const bim::RayScene& scene_;
  std::span<const Surface> surfaces_;
  double reflectivity_;
  double range_max_m_;
  double glint_cosine_;
  bool optics_;
  std::vector<RaySegment> next_;
  std::vector<bim::Ray> rays_;
};

}  // namespace plumbline::sim
