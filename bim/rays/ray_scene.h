// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

struct Ray {
  Eigen::Vector3d origin_W;
  Eigen::Vector3d direction_W;  ///< unit
  double time_s = 0.0;          ///< when it is shot; where moving bodies are then
};

struct Hit {
  double range_m = std::numeric_limits<double>::infinity();  ///< along the ray, from the face's own plane in double
  int element = -1;                                    ///< index into BuildingMesh::elements, -1 when nothing is hit
  int triangle = -1;                                   ///< index into BuildingMesh::triangles, -1 on a moving body
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< unit, towards the ray's origin
};

enum class BodyShape { capsule, box };

/// Where the origin of a moving body is at a time, and how it is turned about the vertical, rad.
struct BodyStation {
  double time_s = 0.0;
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
  double yaw = 0.0;
};

/// Something upright and rigid that moves: a capsule (around B's z axis from low_B.z to high_B.z, its radius
/// high_B.x) or a box.
struct MovingBody {
  BodyShape shape = BodyShape::capsule;
  Eigen::Vector3d low_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d high_B = Eigen::Vector3d::Zero();
  int element = -1;                   ///< beyond those of the mesh, so that what stands wins ties
  std::vector<BodyStation> stations;  ///< times ascend; even motion between them, rest beyond
};

/// For tests and measurements: results must not depend on these.
struct RaySceneOptions {
  std::string_view embree = {};  ///< appended to Embree's device string, as "isa=sse4.2"
  std::size_t width = 0;         ///< rays traced together: 1, 8 or 16; 0 by what the CPU has
};

/// Closest hits on a mesh, from either side of a face. Embree proposes (geometry, primitive); range and ties are
/// decided here in double, so that results depend neither on the CPU nor on packets: among faces hit within 0.1 mm
/// of the nearest the lowest element id, then triangle id wins. A ray in the plane of a face does not hit it.
/// Triangles without area are ignored.
class RayScene {
 public:
  /// Throws EnvironmentError when Embree fails.
  explicit RayScene(const BuildingMesh& mesh, const RaySceneOptions& options = {});
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// Casts every ray up to range_max_m. Blocks of 16 (8 on a CPU without AVX-512) are traced as packets, so
  /// neighbouring beams should stand next to each other; best 8 neighbouring columns of a ring, then the same of the
  /// next ring. hits.size() == rays.size(). Allocates nothing.
  void cast(std::span<const Ray> rays, double range_max_m, std::span<Hit> hits) const;
  [[nodiscard]] Hit cast(const Ray& ray, double range_max_m) const;

  /// True when the line of a ray meets this triangle of the mesh, its border included.
  [[nodiscard]] bool meets(int triangle, const Ray& ray) const;

  /// Casts hit these as well, each where it is at the ray's time; Hit::triangle is -1 there.
  void set_bodies(std::vector<MovingBody> bodies);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::bim
