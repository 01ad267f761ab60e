// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "bim/rays/face.h"
#include "bim/rays/ray_scene.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace plumbline::bim {

/// What Embree found for the rays of one packet: faces of its inflated, float copy of the mesh.
struct Proposals {
  static constexpr std::size_t capacity = 16;
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  alignas(64) std::array<std::uint32_t, capacity> face;
  alignas(64) std::array<float, capacity> u, v;   ///< barycentric on the inflated triangle
  alignas(64) std::array<float, capacity> range;  ///< from the shifted origin
};

/// The only user of Embree. Its results may differ in the last bits, and between faces that coincide, by
/// CPU and packet width; RayScene decides.
class EmbreeScene {
 public:
  /// Embree starts this far behind the origin, so that no face just before it is lost to float rounding, m.
  static constexpr double back_off = 1e-4;
  /// Embree searches this much beyond the maximum range, m.
  static constexpr double overreach = 1e-3;

  /// faces as RayScene numbers them. Throws EnvironmentError when Embree fails.
  EmbreeScene(std::span<const Face> faces, const RayTolerances& tolerances, const RaySceneOptions& options);

  /// Most rays that one call of propose() takes: 16 where the CPU has 16-wide instructions, else 8.
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Nearest faces of 1 to width() rays, traced together.
  void propose(std::span<const Ray> rays, double range_max_m, Proposals& proposals) const;
  /// Nearest face of one ray beyond tnear (from the shifted origin), in slot 0.
  void propose_after(const Ray& ray, double range_max_m, float tnear, Proposals& proposals) const;

 private:
  struct ReleaseDevice {
    void operator()(RTCDeviceTy* device) const;
  };
  struct ReleaseScene {
    void operator()(RTCSceneTy* scene) const;
  };
  void build(std::span<const Face> faces, const RayTolerances& tolerances);
  template <class Packet, class Trace>
  void propose_packet(std::span<const Ray> rays, double range_max_m, Proposals& proposals, Trace&& trace) const;

  std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
  std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
  Eigen::Vector3d center_W_ = Eigen::Vector3d::Zero();
  std::size_t width_ = 8;
};

}  // namespace plumbline::bim
