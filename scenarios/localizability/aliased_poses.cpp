// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/aliased_poses.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace plumbline::scenarios {

namespace {

/// Gauss-Newton step on (x, y, yaw) of seen points against the planes that the plan's view predicts, and how many
/// points lie within the gate of them.
struct PlaneFit {
  Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  int near = 0;
  int seen = 0;
};

PlaneFit fit_planes(const std::vector<Eigen::Vector3d>& directions, const View& seen, const View& expected,
                    const Place& place, double gate) {
  PlaneFit fit;
  const Pose X_WS = place.pose();
  for (std::size_t i = 0; i < seen.range_m.size(); ++i) {
    if (!std::isfinite(seen.range_m[i])) continue;
    ++fit.seen;
    if (!std::isfinite(expected.range_m[i])) continue;
    const Eigen::Vector3d d_W = X_WS.q * directions[i];
    const Eigen::Vector3d& n = expected.normal_W[i];
    const double e = n.dot(d_W) * (seen.range_m[i] - expected.range_m[i]);
    if (std::abs(e) > gate) continue;
    ++fit.near;
    const Eigen::Vector3d arm = seen.range_m[i] * d_W;
    const Eigen::Vector3d J(n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y());
    fit.H += J * J.transpose();
    fit.g += J * e;
  }
  return fit;
}

}  // namespace

TwinFinder::TwinFinder(const PlaceIndex& index, const bim::RayScene& as_planned, const bim::RayScene& as_built)
    : index_(index),
      as_planned_(as_planned),
      as_built_(as_built),
      coarse_(identify_constants.refine_azimuths, identify_constants.refine_elevations_deg) {}

Look TwinFinder::look(const Place& place) const {
  Look look{place, viewer_.look(as_built_, place).range_m, 0.0};
  if (&as_built_ != &as_planned_) look.own = viewer_.cost(look.range_m, viewer_.look(as_planned_, place).range_m);
  return look;
}

double TwinFinder::llr(const Look& look, const Place& other) const {
  return viewer_.cost(look.range_m, viewer_.look(as_planned_, other).range_m) - look.own;
}

bool TwinFinder::plainly_unlike(const Look& look, const Place& other) const {
  // The fifth ring alone, every fifth beam of it: llr there is a fortieth of that of all beams.
  constexpr double sure = 4.0;
  constexpr int stride = 5;
  const auto n = static_cast<std::size_t>(viewer_.azimuths());
  std::vector<bim::Ray> rays;
  for (std::size_t a = 0; a < n; a += stride)
    rays.push_back({other.position_W, other.pose().q * viewer_.directions()[4 * n + a]});
  std::vector<bim::Hit> hits(rays.size());
  as_planned_.cast(rays, identify_constants.range_max_m, hits);
  double sum = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) sum += beam_cost(look.range_m[4 * n + i * stride], hits[i].range_m);
  return sum * 8.0 * stride - look.own > sure * identify_constants.drop_llr;
}

bool TwinFinder::refine(const View& seen, Place& place) const {
  constexpr double gate_min_m = 0.1, gate_factor = 0.7;
  // A twin may differ in about one beam of a hundred. On the way there more do, within a narrowing gate.
  constexpr int early = 3, late = 6;
  constexpr double early_share = 0.6, late_share = 0.85;
  double gate = 1.0;
  for (int iteration = 0; iteration < identify_constants.refine_iterations; ++iteration) {
    const View expected = coarse_.look(as_planned_, place);
    const PlaneFit fit = fit_planes(coarse_.directions(), seen, expected, place, gate);
    const double share = iteration < early ? 0.0 : iteration < late ? early_share : late_share;
    if (fit.near < share * fit.seen) return false;
    const Eigen::Vector3d step = fit.H.ldlt().solve(-fit.g);
    if (!step.allFinite()) return false;
    place.position_W.head<2>() += step.head<2>();
    place.yaw = wrap_angle(place.yaw + step.z());
    if (gate == gate_min_m && step.norm() < 1e-6) break;
    gate = std::max(gate_min_m, gate_factor * gate);
  }
  return true;
}

std::vector<FoundTwin> TwinFinder::find(const Look& look, const TwinSearch& search,
                                        std::span<const Place> known) const {
  const View seen = coarse_.look(as_built_, look.place);
  const Signature signature = signature_of(index_.viewer(), as_built_, look.place.position_W);
  std::vector<Place> taken(known.begin(), known.end());
  taken.push_back(look.place);
  std::vector<Place> tried;
  std::vector<FoundTwin> twins;
  const auto near_any = [](const std::vector<Place>& places, const Place& place, double metres, double degrees) {
    return std::any_of(places.begin(), places.end(),
                       [&](const Place& other) { return same_place(place, other, metres, degrees); });
  };
  int in_vain = 0;
  for (Place place : index_.like(signature, look.place.yaw, search.storey, search.yaw_known)) {
    if (near_any(taken, place, identify_constants.basin_m, identify_constants.basin_deg) ||
        near_any(tried, place, 0.5 * identify_constants.basin_m, 0.5 * identify_constants.basin_deg))
      continue;
    if (++in_vain > identify_constants.give_up_after) break;
    const bool sound = refine(seen, place);
    tried.push_back(place);
    if (!sound) continue;
    if (search.yaw_known &&
        std::abs(wrap_angle(place.yaw - look.place.yaw)) > identify_constants.known_yaw_deg * rad_per_deg)
      continue;
    if (same_place(place, look.place, identify_constants.distinct_m, identify_constants.distinct_deg) ||
        near_any(taken, place, 0.3, 6.0))
      continue;
    if (plainly_unlike(look, place)) continue;
    const double llr = this->llr(look, place);
    if (llr > identify_constants.drop_llr) continue;
    taken.push_back(place);
    in_vain = 0;
    twins.push_back({place, llr});
  }
  return twins;
}

}  // namespace plumbline::scenarios
