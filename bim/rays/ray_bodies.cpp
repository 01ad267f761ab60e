// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/ray_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bim/errors.h"
#include "bim/rays/face.h"

namespace plumbline::bim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tie_m = RayTolerances{}.tie;
constexpr double rounding_m = 1e-6;  ///< spheres and cones are this much larger than they need to be

/// Stretch of a ray inside something convex; empty when from > to.
struct Stretch {
  double from = infinity;
  double to = -infinity;

  /// The stretch inside the convex hull of two overlapping parts of one body.
  void join(const Stretch& other) {
    from = std::min(from, other.from);
    to = std::max(to, other.to);
  }
};

Stretch inside_sphere(const Eigen::Vector3d& center, double radius, const Eigen::Vector3d& o,
                      const Eigen::Vector3d& d) {
  const double b = (center - o).dot(d);
  const Eigen::Vector3d across = center - o - b * d;
  const double h = radius * radius - across.squaredNorm();
  if (h < 0.0) return {};
  return {b - std::sqrt(h), b + std::sqrt(h)};
}

/// Upright cylinder around the z axis.
Stretch inside_cylinder(double radius, double z0, double z1, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  const double a = d.x() * d.x() + d.y() * d.y();
  const double b = o.x() * d.x() + o.y() * d.y();
  const double c = o.x() * o.x() + o.y() * o.y() - radius * radius;
  Stretch s{-infinity, infinity};
  if (a > 0.0) {
    const double h = b * b - a * c;
    if (h < 0.0) return {};
    s = {(-b - std::sqrt(h)) / a, (-b + std::sqrt(h)) / a};
  } else if (c > 0.0) {
    return {};
  }
  if (d.z() == 0.0) return o.z() >= z0 && o.z() <= z1 ? s : Stretch{};
  const double t0 = (z0 - o.z()) / d.z();
  const double t1 = (z1 - o.z()) / d.z();
  s.from = std::max(s.from, std::min(t0, t1));
  s.to = std::min(s.to, std::max(t0, t1));
  return s.from <= s.to ? s : Stretch{};
}

Stretch inside_capsule(const MovingBody& body, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  const double r = body.high_B.x();
  const Eigen::Vector3d low(0.0, 0.0, body.low_B.z() + r);
  const Eigen::Vector3d high(0.0, 0.0, body.high_B.z() - r);
  Stretch s = inside_sphere(low, r, o, d);
  s.join(inside_sphere(high, r, o, d));
  s.join(inside_cylinder(r, low.z(), high.z(), o, d));
  return s;
}

Stretch inside_box(const MovingBody& body, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  Stretch s{-infinity, infinity};
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0.0) {
      if (o[k] < body.low_B[k] || o[k] > body.high_B[k]) return {};
      continue;
    }
    const double t0 = (body.low_B[k] - o[k]) / d[k];
    const double t1 = (body.high_B[k] - o[k]) / d[k];
    s.from = std::max(s.from, std::min(t0, t1));
    s.to = std::min(s.to, std::max(t0, t1));
  }
  return s.from <= s.to ? s : Stretch{};
}

/// Outward normal at a point of the surface.
Eigen::Vector3d normal_at(const MovingBody& body, const Eigen::Vector3d& p_B) {
  if (body.shape == BodyShape::capsule) {
    const double r = body.high_B.x();
    const double z = std::clamp(p_B.z(), body.low_B.z() + r, body.high_B.z() - r);
    return (p_B - Eigen::Vector3d(0.0, 0.0, z)).normalized();
  }
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double nearest = infinity;
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      const double away = std::abs(p_B[k] - (side < 0.0 ? body.low_B[k] : body.high_B[k]));
      if (away >= nearest) continue;
      nearest = away;
      normal = side * Eigen::Vector3d::Unit(k);
    }
  return normal;
}

/// A cone that holds a few neighbouring rays: their origins within a distance of one, their directions within an angle.
struct RayCone {
  Eigen::Vector3d origin_W, axis_W;
  double spread_m = 0.0, cosine = 1.0, sine = 0.0;
  double range_m = 0.0;  ///< to the farthest hit

  RayCone(std::span<const Ray> rays, double range_max_m, std::span<const Hit> hits) : origin_W(rays[0].origin_W) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Ray& ray : rays) {
      sum += ray.direction_W;
      spread_m = std::max(spread_m, (ray.origin_W - origin_W).norm());
    }
    const double length = sum.norm();
    axis_W = length > 1e-3 ? Eigen::Vector3d(sum / length) : rays[0].direction_W;
    for (const Ray& ray : rays) cosine = std::min(cosine, axis_W.dot(ray.direction_W));
    sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    for (const Hit& hit : hits) range_m = std::max(range_m, std::min(hit.range_m, range_max_m));
  }

  [[nodiscard]] bool misses(const Eigen::Vector3d& center_W, double radius_m) const {
    const Eigen::Vector3d v = center_W - origin_W;
    const double reach = radius_m + spread_m + rounding_m;
    if (v.norm() > range_m + reach) return true;
    if (cosine <= 0.1) return false;
    const double along = v.dot(axis_W);
    return (v - along * axis_W).norm() * cosine - along * sine > reach;
  }
};

}  // namespace

BodyStation station_at(const MovingBody& body, double time_s) {
  const auto after = std::upper_bound(body.stations.begin(), body.stations.end(), time_s,
                                      [](double t, const BodyStation& s) { return t < s.time_s; });
  if (after == body.stations.begin()) return body.stations.front();
  if (after == body.stations.end()) return body.stations.back();
  const BodyStation& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return {time_s, before.position_W + share * (after->position_W - before.position_W),
          before.yaw + share * (after->yaw - before.yaw)};
}

BodyHit hit_body(const MovingBody& body, const Ray& ray) {
  const BodyStation at = station_at(body, ray.time_s);
  const double c = std::cos(at.yaw);
  const double s = std::sin(at.yaw);
  const auto to_B = [&](const Eigen::Vector3d& v) {
    return Eigen::Vector3d(c * v.x() + s * v.y(), c * v.y() - s * v.x(), v.z());
  };
  const Eigen::Vector3d o = to_B(ray.origin_W - at.position_W);
  const Eigen::Vector3d d = to_B(ray.direction_W);
  const Stretch in = body.shape == BodyShape::capsule ? inside_capsule(body, o, d) : inside_box(body, o, d);
  const double range = in.from > 0.0 ? in.from : in.to;
  if (!(in.from <= in.to && range > 0.0)) return {infinity, {}};
  const Eigen::Vector3d n = normal_at(body, o + range * d);
  return {range, {c * n.x() - s * n.y(), s * n.x() + c * n.y(), n.z()}};
}

MovingBodies::MovingBodies(std::vector<MovingBody> bodies) : bodies_(std::move(bodies)) {
  if (bodies_.size() > most) throw InternalError("too many moving bodies");
  std::stable_sort(bodies_.begin(), bodies_.end(),
                   [](const MovingBody& a, const MovingBody& b) { return a.element < b.element; });
  for (const MovingBody& body : bodies_) {
    if (body.stations.empty() || !((body.high_B - body.low_B).minCoeff() > 0.0))
      throw InternalError("a moving body without a station or without extent");
    Eigen::AlignedBox3d swept;
    for (const BodyStation& station : body.stations) swept.extend(station.position_W);
    const double reach = body.low_B.cwiseAbs().cwiseMax(body.high_B.cwiseAbs()).norm();
    spheres_.push_back({swept.center(), 0.5 * swept.diagonal().norm() + reach});
  }
}

void MovingBodies::cast(std::span<const Ray> rays, double range_max_m, std::span<Hit> hits) const {
  const RayCone cone(rays, range_max_m, hits);
  std::array<std::size_t, most> near;
  std::size_t count = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (!cone.misses(spheres_[i].center_W, spheres_[i].radius_m)) near[count++] = i;
  if (count == 0) return;
  for (std::size_t i = 0; i < rays.size(); ++i) cast_one(rays[i], range_max_m, std::span(near).first(count), hits[i]);
}

void MovingBodies::cast_one(const Ray& ray, double range_max_m, std::span<const std::size_t> near, Hit& hit) const {
  double nearest = hit.range_m;
  for (const std::size_t i : near) {
    const double range = hit_body(bodies_[i], ray).range_m;
    if (range <= range_max_m) nearest = std::min(nearest, range);
  }
  if (hit.range_m <= nearest + tie_m) return;  // also where nothing is hit at all
  for (const std::size_t i : near) {
    const BodyHit found = hit_body(bodies_[i], ray);
    if (found.range_m > range_max_m || found.range_m > nearest + tie_m) continue;
    const bool from_inside = found.normal_W.dot(ray.direction_W) > 0.0;
    hit = {found.range_m, bodies_[i].element, -1, from_inside ? Eigen::Vector3d(-found.normal_W) : found.normal_W};
    return;
  }
}

}  // namespace plumbline::bim
