// SPDX-License-Identifier: Apache-2.0
#include "scenarios/identify/views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::scenarios {

namespace {
constexpr double rad = std::numbers::pi / 180.0;
constexpr const IdentifyConstants& k = identify_constants;
}  // namespace

Viewer::Viewer(int azimuths) : azimuths_(azimuths) {
  for (const double elevation : k.elevations_deg)
    for (int a = 0; a < azimuths; ++a) {
      const double azimuth = 2.0 * std::numbers::pi * a / azimuths;
      directions_.emplace_back(std::cos(elevation * rad) * std::cos(azimuth),
                               std::cos(elevation * rad) * std::sin(azimuth), std::sin(elevation * rad));
    }
}

View Viewer::look(const bim::RayScene& scene, const Eigen::Vector3d& position_W, double yaw) const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  std::vector<bim::Ray> rays;
  rays.reserve(directions_.size());
  for (const auto& d : directions_) rays.push_back({position_W, {c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z()}});
  std::vector<bim::Hit> hits(rays.size());
  scene.cast(rays, k.range_max_m, hits);
  View view;
  view.range_m.reserve(hits.size());
  view.normal_W.reserve(hits.size());
  for (const auto& hit : hits) {
    view.range_m.push_back(hit.range_m);
    view.normal_W.push_back(hit.normal_W);
  }
  return view;
}

double Viewer::cost(const View& seen, const View& expected, int shift) const {
  const double variance = k.sensor_sigma_m * k.sensor_sigma_m + k.model_sigma_m * k.model_sigma_m;
  const double cap = k.residual_cap_sigma * k.residual_cap_sigma;
  const int n = azimuths_;
  const int turn = ((shift % n) + n) % n;
  double sum = 0.0;
  for (std::size_t ring = 0; ring < k.elevations_deg.size(); ++ring) {
    const std::size_t base = ring * static_cast<std::size_t>(n);
    for (int a = 0; a < n; ++a) {
      const int b = a + turn < n ? a + turn : a + turn - n;
      const double r0 = seen.range_m[base + static_cast<std::size_t>(a)];
      const double r1 = expected.range_m[base + static_cast<std::size_t>(b)];
      if (r0 == r1) continue;  // also two misses
      const double dr = r0 - r1;
      sum += std::isfinite(dr) ? std::min(dr * dr / variance, cap) : cap;
    }
  }
  return 0.5 * sum / k.correlation;
}

}  // namespace plumbline::scenarios
