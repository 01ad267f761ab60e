// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/range_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bim/errors.h"

namespace plumbline::scenarios {

bool same_pose(const SensorPose& a, const SensorPose& b, double metres, double degrees) {
  return (a.position_W - b.position_W).norm() <= metres && std::abs(wrap_angle(a.yaw - b.yaw)) <= degrees * rad_per_deg;
}

RangeImager::RangeImager(int azimuths, std::span<const double> elevations_deg) : azimuths_(azimuths) {
  for (const double elevation : elevations_deg)
    for (int a = 0; a < azimuths; ++a) {
      const double azimuth = 2.0 * std::numbers::pi * a / azimuths;
      directions_.emplace_back(std::cos(elevation * rad_per_deg) * std::cos(azimuth),
                               std::cos(elevation * rad_per_deg) * std::sin(azimuth),
                               std::sin(elevation * rad_per_deg));
    }
}

RangeImage RangeImager::cast(const bim::RayScene& scene, const SensorPose& place) const {
  const double c = std::cos(place.yaw);
  const double s = std::sin(place.yaw);
  std::vector<bim::Ray> rays;
  rays.reserve(directions_.size());
  for (const auto& d : directions_)
    rays.push_back({place.position_W, {c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z()}});
  std::vector<bim::Hit> hits(rays.size());
  scene.cast(rays, localizability_constants.range_max_m, hits);
  RangeImage view;
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
  constexpr double variance = localizability_constants.sensor_sigma_m * localizability_constants.sensor_sigma_m +
                              localizability_constants.model_sigma_m * localizability_constants.model_sigma_m;
  constexpr double cap = localizability_constants.residual_cap_sigma * localizability_constants.residual_cap_sigma;
  if (seen_m == expected_m) return 0.0;  // also two misses
  const double dr = seen_m - expected_m;
  return 0.5 * (std::isfinite(dr) ? std::min(dr * dr / variance, cap) : cap) / localizability_constants.correlation;
}

double beam_evidence(double seen_m, double own_m, double other_m, bool loose) {
  const double own = beam_cost(seen_m, own_m), other = beam_cost(seen_m, other_m);
  if (!loose) return other - own;
  const double own_passed = seen_m > own_m ? own : 0.0, other_passed = seen_m > other_m ? other : 0.0;
  return std::max(other_passed - own_passed, 0.0) + std::min(other - own, 0.0);
}

double beam_evidence(const bim::RayScene& as_planned, const SensorPose& other, const Eigen::Vector3d& direction,
                     double seen_m, double own_m, double other_m, bool loose) {
  constexpr double negligible = 0.01;
  double least = beam_evidence(seen_m, own_m, other_m, loose);
  const double range = std::min(seen_m, other_m);
  if (least < negligible || !std::isfinite(range)) return least;
  const double turn = localizability_constants.model_sigma_m / std::max(range, 0.1);
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(direction).normalized(), up = direction.cross(left);
  bool passes = other_m > seen_m;
  std::array<Eigen::Vector3d, 4> beside = {left, -left, up, -up};
  for (Eigen::Vector3d& side : beside) {
    side = other.pose().q * (direction + turn * side).normalized();
    const bim::Hit hit = as_planned.cast({other.position_W, side, 0.0}, localizability_constants.range_max_m);
    least = std::min(least, beam_evidence(seen_m, own_m, hit.range_m, loose));
    passes = passes || hit.range_m > seen_m;
  }
  if (least < negligible || !passes || !std::isfinite(seen_m)) return std::max(least, 0.0);
  // Along a row of edges the beam may pass those before and end on this one.
  const double start_m =
      std::max(seen_m - localizability_constants.residual_cap_sigma * localizability_constants.model_sigma_m, 0.0);
  for (const Eigen::Vector3d& side : beside) {
    const bim::Hit hit =
        as_planned.cast({other.position_W + start_m * side, side, 0.0}, localizability_constants.range_max_m);
    least = std::min(least, beam_evidence(seen_m, own_m, start_m + hit.range_m, loose));
  }
  return std::max(least, 0.0);
}

double RangeImager::cost(const std::vector<double>& seen, const std::vector<double>& expected) const {
  if (seen.size() != directions_.size() || expected.size() != directions_.size())
    throw InternalError("identify: views of another size");
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) sum += beam_cost(seen[i], expected[i]);
  return sum;
}

}  // namespace plumbline::scenarios
