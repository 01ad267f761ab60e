// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "bim/rays/ray_scene.h"

namespace plumbline::scenarios {

/// What RayScene is measured against: Embree as its manual shows it, one rtcIntersect1 a ray in a robust scene with
/// default settings, and from the ids it gives the range in double from a stored plane. No rule for ties.
class PlainRays {
 public:
  /// Throws EnvironmentError when Embree fails.
  explicit PlainRays(const bim::BuildingMesh& mesh);
  ~PlainRays();
  PlainRays(const PlainRays&) = delete;
  PlainRays& operator=(const PlainRays&) = delete;

  void cast(std::span<const bim::Ray> rays, double range_max_m, std::span<bim::Hit> hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::scenarios
