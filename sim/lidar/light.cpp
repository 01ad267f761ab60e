// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/light.h"

#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

constexpr int surfaces_max = 8;
constexpr int bounces_max = 2;
/// Less than this of the light cannot be seen: half of it would be lost at 0.3 m.
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

void Light::follow(std::vector<Leg>& legs, std::vector<bim::Hit>& hits, std::vector<Reflection>& out) {
  for (int met = 1; !legs.empty(); ++met) {
    next_.clear();
    for (std::size_t i = 0; i < legs.size(); ++i)
      if (hits[i].element >= 0) arrive(legs[i], hits[i], out);
    legs.swap(next_);
    if (met == surfaces_max) legs.clear();
    rays_.clear();
    for (const Leg& leg : legs) rays_.push_back(leg.ray);
    hits.resize(legs.size());
    scene_.cast(rays_, range_max_m_, hits);
  }
}

void Light::arrive(const Leg& leg, const bim::Hit& hit, std::vector<Reflection>& out) {
  const double path_m = leg.before_m + hit.range_m;
  if (path_m > range_max_m_) return;
  if (leg.inside == hit.element) {  // the far side of a pane
    Leg& beyond = next_.emplace_back(leg);
    beyond.ray.origin_W += (hit.range_m + step_m) * leg.ray.direction_W;
    beyond.before_m = path_m + step_m;
    beyond.inside = -1;
    return;
  }
  const Surface surface = this->surface(hit.element);
  const double cosine = std::abs(hit.normal_W.dot(leg.ray.direction_W));
  const Eigen::Vector3d point_W = leg.ray.origin_W + hit.range_m * leg.ray.direction_W;
  const auto add = [&](double strength, std::uint8_t flags) {
    if (strength >= gain_min)
      out.push_back(
          {leg.beam, path_m, strength, cosine, flags, hit.element, hit.triangle, point_W, leg.ray.direction_W});
  };
  add(leg.gain * surface.reflectivity, leg.flags);
  if (!optics_ || surface.plain()) return;
  if (surface.specular > 0.0 && leg.bounces == 0 && cosine >= glint_cosine_)
    add(leg.gain * surface.specular * retro_gain, leg.flags | light_path::glint);
  go_on(leg, hit, surface);
}

/// Sends on what a surface lets through and what it mirrors.
void Light::go_on(const Leg& leg, const bim::Hit& hit, const Surface& surface) {
  const double through = leg.gain * surface.transmission * surface.transmission;
  const double mirrored = leg.gain * surface.specular * surface.specular;
  const double path_m = leg.before_m + hit.range_m + step_m;
  if (through >= gain_min) {
    Leg& beyond = next_.emplace_back(leg);
    beyond.ray.origin_W += (hit.range_m + step_m) * leg.ray.direction_W;
    beyond.before_m = path_m;
    beyond.gain = through;
    beyond.inside = hit.element;
    beyond.flags |= light_path::through;
  }
  if (mirrored >= gain_min && leg.bounces < bounces_max) {
    Leg& back = next_.emplace_back(leg);
    const Eigen::Vector3d& d = leg.ray.direction_W;
    back.ray.direction_W = (d - 2.0 * d.dot(hit.normal_W) * hit.normal_W).normalized();
    back.ray.origin_W += hit.range_m * d + step_m * back.ray.direction_W;
    back.before_m = path_m;
    back.gain = mirrored;
    ++back.bounces;
    back.flags |= light_path::mirrored;
  }
}

}  // namespace plumbline::sim
