// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "bim/plan/plan.h"

namespace plumbline::slam {

/// A wall face, or a side of a column or the like, as a vertical rectangle with holes, in the plan-fixed frame I.
struct PlanSegment {
  int plan_face = -1;  ///< index into Plan::faces, -1: side of a solid, which is no wall
  int element = -1;    ///< lowest index of a segment of the same wall or solid
  int line = -1;       ///< WallLine it is part of, -1: none
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d e = Eigen::Vector2d::UnitX();  ///< unit, along the face
  Eigen::Vector2d n = Eigen::Vector2d::UnitY();  ///< unit, into free space: left of e
  double length = 0.0;
  double z0 = 0.0, z1 = 3.0;
  std::vector<bim::FaceHole> holes;
};

/// A straight ray over the plan: horizontal direction and rise per horizontal metre.
struct PlanRay {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit
  double z = 0.0;
  double slope = 0.0;
};

struct PlanHit {
  double distance = 0.0;  ///< horizontal, m; max_distance when nothing is hit
  int segment = -1;       ///< -1: nothing
};

/// Horizontal distance at which a ray hits the plane of a face, infinity where it does not.
[[nodiscard]] inline double plane_distance(const PlanSegment& segment, const PlanRay& ray) {
  // Rays starting on a face (a robot never does, a reflection of rounding may) do not hit that face.
  constexpr double min_distance_m = 1e-9, infinity = std::numeric_limits<double>::infinity();
  const double along = ray.direction.dot(segment.n);
  if (std::abs(along) < 1e-12) return infinity;
  const double t = (segment.a - ray.origin).dot(segment.n) / along;
  return t > min_distance_m ? t : infinity;
}

/// What of a face stands at a point of its plane.
enum class FacePart { none, solid, hole };
/// t: distance along the ray.
[[nodiscard]] inline FacePart part_at(const PlanSegment& segment, const PlanRay& ray, double t) {
  const double s = (t * ray.direction - (segment.a - ray.origin)).dot(segment.e);
  if (s < 0.0 || s > segment.length) return FacePart::none;
  const double z = ray.z + t * ray.slope;
  if (z < segment.z0 || z > segment.z1) return FacePart::none;
  for (const bim::FaceHole& hole : segment.holes)
    if (s > hole.s0 && s < hole.s1 && z > hole.z0 && z < hole.z1) return FacePart::hole;
  return FacePart::solid;
}

/// Takes the face as the hit where it is nearer; of faces at equal distance the lowest index.
inline void keep_nearest(const PlanSegment& segment, int index, const PlanRay& ray, PlanHit& best) {
  const double t = plane_distance(segment, ray);
  const bool nearer = t < best.distance || (t == best.distance && best.segment >= 0 && index < best.segment);
  if (nearer && part_at(segment, ray, t) == FacePart::solid) best = {t, index};
}

}  // namespace plumbline::slam
