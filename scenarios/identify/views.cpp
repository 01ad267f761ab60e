// SPDX-License-Identifier: Apache-2.0
#include "scenarios/identify/views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {
constexpr double rad = std::numbers::pi / 180.0;
constexpr const IdentifyConstants& k = identify_constants;
}  // namespace

bool same_place(const Place& a, const Place& b, double metres, double degrees) {
  return (a.position_W - b.position_W).norm() <= metres && std::abs(wrap_angle(a.yaw - b.yaw)) <= degrees * rad;
}

Viewer::Viewer(int azimuths, std::span<const double> elevations_deg) : azimuths_(azimuths) {
  for (const double elevation : elevations_deg)
    for (int a = 0; a < azimuths; ++a) {
      const double azimuth = 2.0 * std::numbers::pi * a / azimuths;
      directions_.emplace_back(std::cos(elevation * rad) * std::cos(azimuth),
                               std::cos(elevation * rad) * std::sin(azimuth), std::sin(elevation * rad));
    }
}

View Viewer::look(const bim::RayScene& scene, const Place& place) const {
  const double c = std::cos(place.yaw);
  const double s = std::sin(place.yaw);
  std::vector<bim::Ray> rays;
  rays.reserve(directions_.size());
  for (const auto& d : directions_)
    rays.push_back({place.position_W, {c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z()}});
  std::vector<bim::Hit> hits(rays.size());
  scene.cast(rays, k.range_max_m, hits);
  View view;
  view.range_m.reserve(hits.size());
  view.normal_W.reserve(hits.size());
  view.element.reserve(hits.size());
  for (const auto& hit : hits) {
    view.range_m.push_back(hit.range_m);
    view.normal_W.push_back(hit.normal_W);
    view.element.push_back(hit.element);
  }
  return view;
}

double beam_cost(double seen_m, double expected_m) {
  constexpr double variance = k.sensor_sigma_m * k.sensor_sigma_m + k.model_sigma_m * k.model_sigma_m;
  constexpr double cap = k.residual_cap_sigma * k.residual_cap_sigma;
  if (seen_m == expected_m) return 0.0;  // also two misses
  const double dr = seen_m - expected_m;
  return 0.5 * (std::isfinite(dr) ? std::min(dr * dr / variance, cap) : cap) / k.correlation;
}

double Viewer::cost(const std::vector<double>& seen, const std::vector<double>& expected) const {
  if (seen.size() != directions_.size() || expected.size() != directions_.size())
    throw InternalError("identify: views of another size");
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) sum += beam_cost(seen[i], expected[i]);
  return sum;
}

}  // namespace plumbline::scenarios
