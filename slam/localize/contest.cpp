// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/contest.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

namespace {

/// Farther than this beyond a return the plan is not looked at: the beam has long gone through.
constexpr double look_beyond_m = 2.0;

PlanRay ray_of(const Sight& sight, const View& view, const Beam& beam) {
  const Eigen::Matrix2d R_IH = sight.X_IH.rotation();
  return {R_IH * view.sensor_H + sight.X_IH.t, R_IH * beam.direction_H, sight.storey->floor_z + view.sensor_height,
          beam.slope};
}

/// Negative log-likelihood of a range where the plan has `expected`.
double cost(double range, double expected, double incidence, const ContestConfig& config) {
  const double e = (range - expected) * incidence / config.sigma_m;
  return std::min(0.5 * e * e, e > 0.0 ? config.long_cap : config.short_cap);
}

/// Cost of beam i of the sweep, by the best of what it and its neighbours on the ring should meet.
double beam_cost(const View& view, const Sight& sight, std::size_t i, const ContestConfig& config) {
  if (sight.cost[i] >= 0.0) return sight.cost[i];
  const int columns = view.sweep_columns;
  const double range = view.sweep[i].range, step = 2.0 * std::numbers::pi / columns;
  const int aside = std::max(1, static_cast<int>(std::lround((config.edge_m / range + config.edge_rad) / step)));
  const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) - column;
  double best = cost(range, sight.expected[i], sight.incidence[i], config);
  for (int shift = -aside; shift <= aside; ++shift) {
    const auto k = static_cast<std::size_t>(row + (column + shift + columns) % columns);
    if (view.sweep[k].range > 0.0) best = std::min(best, cost(range, sight.expected[k], sight.incidence[k], config));
  }
  return sight.cost[i] = best;
}

/// The beam ends at a leaf or pane in an opening of the plan, which says nothing of the place.
bool ends_in_opening(const View& view, const Sight& sight, const Beam& beam, const ContestConfig& config) {
  return sight.storey->grid.crosses_opening(sight.storey->segments, ray_of(sight, view, beam),
                                            beam.range - config.opening_depth_m, beam.range + config.sigma_m);
}

Cause cause_of(const Sight& sight, std::size_t i, const View& view, const ContestConfig& config) {
  const Beam& beam = view.sweep[i];
  const int segment = sight.segment[i];
  if (segment < 0) {
    const PlanRay ray = ray_of(sight, view, beam);
    const Eigen::Vector2d cell = ((ray.origin + beam.range * ray.direction) / config.thing_m).array().floor();
    return {Cause::Kind::unplanned, static_cast<int>(cell.x()), static_cast<int>(cell.y())};
  }
  if (sight.expected[i] >= beam.range) return {Cause::Kind::before_face, segment};
  return {Cause::Kind::not_built, sight.storey->segments[static_cast<std::size_t>(segment)].element};
}

}  // namespace

Sight sight(const StoreyIndex& storey, const Pose2& X_IH, const View& view, const ContestConfig& config) {
  Sight sight{&storey, X_IH, {}, {}, {}, std::vector<double>(view.sweep.size(), -1.0)};
  sight.segment.assign(view.sweep.size(), -1);
  sight.expected.assign(view.sweep.size(), 0.0);
  sight.incidence.assign(view.sweep.size(), 1.0);
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  PlanRay ray{R_IH * view.sensor_H + X_IH.t, {}, storey.floor_z + view.sensor_height, 0.0};
  const int cell = storey.grid.cell_at(ray.origin);
  for (std::size_t i = 0; i < view.sweep.size(); ++i) {
    const Beam& beam = view.sweep[i];
    if (beam.range <= 0.0) continue;
    ray.direction = R_IH * beam.direction_H;
    ray.slope = beam.slope;
    double reach = beam.range + look_beyond_m;
    if (beam.slope < 0.0) reach = std::min(reach, -view.sensor_height / beam.slope);
    if (beam.slope > 0.0) reach = std::min(reach, (storey.ceiling_z - ray.z) / beam.slope);
    const PlanHit hit = storey.grid.cast(storey.segments, ray, std::max(reach, 0.0), cell);
    sight.expected[i] = hit.distance;
    sight.segment[i] = hit.segment;
    if (hit.segment < 0) continue;
    const double incidence = std::abs(storey.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction));
    sight.incidence[i] = std::max(incidence, config.min_incidence);
  }
  return sight;
}

void Objections::add(const Objections& more, double scale) {
  for (const auto& [cause, sum] : more.sums_) sums_[cause] += scale * sum;
}

double Objections::total(double cap) const {
  double sum = 0.0;
  for (const auto& [cause, one] : sums_) sum += std::min(one, cap);
  return sum;
}

Contest contest(const View& view, const Sight& a, const Sight& b, const ContestConfig& config) {
  Contest result;
  for (std::size_t i = 0; i < view.sweep.size(); ++i) {
    const Beam& beam = view.sweep[i];
    if (beam.range <= 0.0) continue;
    const double apart = std::abs(a.expected[i] - b.expected[i]) * std::max(a.incidence[i], b.incidence[i]);
    if (apart <= config.gate_m) continue;
    const double gain = config.weight * (beam_cost(view, b, i, config) - beam_cost(view, a, i, config));
    if (gain == 0.0) continue;
    const Sight& worse = gain > 0.0 ? b : a;
    if (worse.expected[i] > beam.range && ends_in_opening(view, worse, beam, config)) continue;
    Objections& against = gain > 0.0 ? result.against_b : result.against_a;
    against.add(cause_of(worse, i, view, config), std::abs(gain));
    result.ratio += gain;
  }
  return result;
}

}  // namespace plumbline::slam
