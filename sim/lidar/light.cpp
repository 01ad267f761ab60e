// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/light.h"

#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

constexpr int surfaces_max = 8;
constexpr int bounces_max = 2;
/// Less than this share of the light is not detected: half of it would be lost at 0.3 m.
constexpr double gain_min = 1e-5;
/// A ray goes on this far behind a surface; more than the distance within which faces are one.
constexpr double step_m = 2e-4;

}  // namespace

Light::Light(const bim::RayScene& scene, std::span<const Surface> surfaces, const LidarConfig& config)
    : scene_(scene),
      surfaces_(surfaces),
      reflectivity_(config.reflectivity),
      range_max_m_(slam::lidar_model(config.model).range_max_m),
      glint_cosine_(std::cos(config.glint_rad)),
      optics_(config.optics) {}

void Light::trace(std::vector<RaySegment>& segments, std::vector<bim::Hit>& hits, std::vector<Reflection>& out) {
  for (int met = 1; !segments.empty(); ++met) {
    next_.clear();
    for (std::size_t i = 0; i < segments.size(); ++i)
      if (hits[i].element >= 0) process_hit(segments[i], hits[i], out);
    segments.swap(next_);
    if (met == surfaces_max) segments.clear();
    rays_.clear();
    for (const RaySegment& segment : segments) rays_.push_back(segment.ray);
    hits.resize(segments.size());
    scene_.cast(rays_, range_max_m_, hits);
  }
}

void Light::process_hit(const RaySegment& segment, const bim::Hit& hit, std::vector<Reflection>& out) {
  const double path_m = segment.before_m + hit.range_m;
  if (path_m > range_max_m_) return;
  if (segment.inside == hit.element) {  // the far side of a pane
    RaySegment& beyond = next_.emplace_back(segment);
    beyond.ray.origin_W += (hit.range_m + step_m) * segment.ray.direction_W;
    beyond.before_m = path_m + step_m;
    beyond.inside = -1;
    return;
  }
  const Surface surface = this->surface(hit.element);
  const double cosine = std::abs(hit.normal_W.dot(segment.ray.direction_W));
  const Eigen::Vector3d point_W = segment.ray.origin_W + hit.range_m * segment.ray.direction_W;
  const auto add = [&](double strength, std::uint8_t flags) {
    if (strength >= gain_min)
      out.push_back(
          {segment.beam, path_m, strength, cosine, flags, hit.element, hit.triangle, point_W, segment.ray.direction_W});
  };
  add(segment.gain * surface.reflectivity, segment.flags);
  if (!optics_ || surface.is_diffuse()) return;
  if (surface.specular > 0.0 && segment.bounces == 0 && cosine >= glint_cosine_)
    add(segment.gain * surface.specular * retro_gain, segment.flags | light_path::glint);
  spawn_segments(segment, hit, surface);
}

/// Adds the transmitted and the mirrored segment.
void Light::spawn_segments(const RaySegment& segment, const bim::Hit& hit, const Surface& surface) {
  const double through = segment.gain * surface.transmission * surface.transmission;
  const double mirrored = segment.gain * surface.specular * surface.specular;
  const double path_m = segment.before_m + hit.range_m + step_m;
  if (through >= gain_min) {
    RaySegment& beyond = next_.emplace_back(segment);
    beyond.ray.origin_W += (hit.range_m + step_m) * segment.ray.direction_W;
    beyond.before_m = path_m;
    beyond.gain = through;
    beyond.inside = hit.element;
    beyond.flags |= light_path::through;
  }
  if (mirrored >= gain_min && segment.bounces < bounces_max) {
    RaySegment& back = next_.emplace_back(segment);
    const Eigen::Vector3d& d = segment.ray.direction_W;
    back.ray.direction_W = (d - 2.0 * d.dot(hit.normal_W) * hit.normal_W).normalized();
    back.ray.origin_W += hit.range_m * d + step_m * back.ray.direction_W;
    back.before_m = path_m;
    back.gain = mirrored;
    ++back.bounces;
    back.flags |= light_path::mirrored;
  }
}

}  // namespace plumbline::sim
