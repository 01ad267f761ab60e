// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/aliased_poses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/geometry/symmetric.h"

namespace plumbline::scenarios {

namespace {

constexpr int stride = 5;                  ///< of the beams that tell clearly different views apart
constexpr std::size_t most_composed = 64;  ///< aliases whose compositions are looked at; assumed
constexpr std::size_t places_a_beam = 50;  ///< of the index compared in the time of a beam; assumed

/// Gauss-Newton step on (x, y, yaw) of seen points against the planes that the plan's view predicts, and how many
/// points lie within the gate of them.
struct PlaneFit {
  Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  int near = 0;
  int seen = 0;
};

PlaneFit fit_planes(const std::vector<Eigen::Vector3d>& directions, const RangeImage& seen, const RangeImage& expected,
                    const SensorPose& place, double gate) {
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

AliasFinder::AliasFinder(const PlaceIndex& index, const bim::RayScene& as_planned, const bim::RayScene& as_built,
                         std::span<const char> loose, std::span<const Pose> isometries)
    : index_(index),
      as_planned_(as_planned),
      as_built_(as_built),
      loose_(loose),
      isometries_(isometries),
      coarse_(localizability_constants.refine_azimuths, localizability_constants.refine_elevations_deg) {}

bool AliasFinder::is_loose(int element) const {
  return element >= 0 && !loose_.empty() && loose_[static_cast<std::size_t>(element)] != 0;
}

ReferenceScan AliasFinder::scan_at(const SensorPose& place) const {
  work_ += (&as_built_ == &as_planned_ ? 1 : 2) * imager_.directions().size();
  RangeImage seen = imager_.cast(as_built_, place);
  ReferenceScan scan{place, std::move(seen.range_m), {}, {}};
  if (&as_built_ == &as_planned_) return scan;
  scan.predicted_m = imager_.cast(as_planned_, place).range_m;
  if (!loose_.empty())
    for (const int element : seen.element) scan.loose.push_back(is_loose(element));
  return scan;
}

double AliasFinder::evidence(const ReferenceScan& scan, std::size_t beam, double other_m) const {
  const double own_m = scan.predicted_m.empty() ? scan.range_m[beam] : scan.predicted_m[beam];
  return beam_evidence(scan.range_m[beam], own_m, other_m, !scan.loose.empty() && scan.loose[beam]);
}

double AliasFinder::evidence(const ReferenceScan& scan, std::size_t beam, const SensorPose& other,
                             double other_m) const {
  const double own_m = scan.predicted_m.empty() ? scan.range_m[beam] : scan.predicted_m[beam];
  return beam_evidence(as_planned_, other, imager_.directions()[beam], scan.range_m[beam], own_m, other_m,
                       !scan.loose.empty() && scan.loose[beam]);
}

double AliasFinder::llr(const ReferenceScan& scan, const SensorPose& other) const {
  work_ += imager_.directions().size();
  const std::vector<double> expected = imager_.cast(as_planned_, other).range_m;
  double sum = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) sum += evidence(scan, i, other, expected[i]);
  return sum;
}

std::uint64_t AliasFinder::work_of_llr() const {
  return imager_.directions().size() + static_cast<std::size_t>(imager_.azimuths()) / stride;
}

bool AliasFinder::clearly_different(const ReferenceScan& scan, const SensorPose& other) const {
  // The fifth ring alone, every fifth beam of it: llr there is a fortieth of that of all beams.
  constexpr double sure = 4.0;
  const auto n = static_cast<std::size_t>(imager_.azimuths());
  work_ += n / stride;
  std::vector<bim::Ray> rays;
  for (std::size_t a = 0; a < n; a += stride)
    rays.push_back({other.position_W, other.pose().q * imager_.directions()[4 * n + a]});
  std::vector<bim::Hit> hits(rays.size());
  as_planned_.cast(rays, localizability_constants.range_max_m, hits);
  constexpr double enough = sure * localizability_constants.drop_llr / (8.0 * stride);
  double sum = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) sum += evidence(scan, 4 * n + i * stride, hits[i].range_m);
  if (sum <= enough) return false;
  // Those that run along edges tell nothing.
  sum = 0.0;
  for (std::size_t i = 0; i < hits.size() && sum <= enough; ++i)
    sum += evidence(scan, 4 * n + i * stride, other, hits[i].range_m);
  return sum > enough;
}

std::vector<AliasFinder::View> AliasFinder::views_of(const SensorPose& place) const {
  const auto view = [&](const bim::RayScene& scene) {
    return View{signature_of(index_.imager(), scene, place.position_W), coarse_.cast(scene, place)};
  };
  // The plan's first: where it is symmetric, its aliases are exact, whatever stands about.
  if (&as_built_ == &as_planned_) return {view(as_built_)};
  return {view(as_planned_), view(as_built_)};
}

std::vector<SensorPose> AliasFinder::images_of(const SensorPose& place, int storey) const {
  constexpr double floor_m = 0.3;  // storeys that are alike may lie this much off their distance; assumed
  std::vector<SensorPose> images;
  for (const Pose& isometry : isometries_) {
    const Pose X = isometry * place.pose();
    for (std::size_t s = 0; s < index_.storeys().size(); ++s) {
      const SearchArea& area = index_.storeys()[s];
      if (area.empty() || (storey >= 0 && static_cast<int>(s) != storey)) continue;
      const double z = area.sensor_z_W(X.t.head<2>());
      if (std::abs(z - X.t.z()) > floor_m) continue;
      images.push_back({{X.t.x(), X.t.y(), z}, X.yaw()});
      break;
    }
  }
  return images;
}

bool AliasFinder::refine(const RangeImage& seen, const SearchArea& storey, SensorPose& place) const {
  constexpr double gate_min_m = 0.1, gate_factor = 0.7;
  // An alias may differ in about one beam of a hundred. On the way there more do, within a narrowing gate.
  constexpr int early = 3, late = 6;
  constexpr double early_share = 0.6, late_share = 0.85;
  double gate = 1.0;
  for (int iteration = 0; iteration < localizability_constants.refine_iterations; ++iteration) {
    work_ += coarse_.directions().size();
    const RangeImage expected = coarse_.cast(as_planned_, place);
    const PlaneFit fit = fit_planes(coarse_.directions(), seen, expected, place, gate);
    const double share = iteration < early ? 0.0 : iteration < late ? early_share : late_share;
    if (fit.near < share * fit.seen) return false;
    const Eigen::Vector3d step = solve_ldlt(fit.H, Eigen::Vector3d(-fit.g));
    if (!step.allFinite()) return false;
    place.position_W.head<2>() += step.head<2>();
    place.position_W.z() = storey.sensor_z_W(place.position_W.head<2>());
    place.yaw = wrap_angle(place.yaw + step.z());
    if (gate == gate_min_m && step.norm() < 1e-6) break;
    gate = std::max(gate_min_m, gate_factor * gate);
  }
  return true;
}

std::vector<FoundAlias> AliasFinder::find(const ReferenceScan& scan, const AliasSearch& search,
                                          std::span<const SensorPose> known) const {
  std::vector<SensorPose> taken(known.begin(), known.end());
  taken.push_back(scan.place);
  std::vector<FoundAlias> aliases;
  const int give_up_after =
      search.thorough ? localizability_constants.give_up_after_of_run : localizability_constants.give_up_after;
  const auto near_any = [](const std::vector<SensorPose>& places, const SensorPose& place, double metres,
                           double degrees) {
    return std::any_of(places.begin(), places.end(),
                       [&](const SensorPose& other) { return same_pose(place, other, metres, degrees); });
  };
  const auto is_taken = [&](const SensorPose& place) {
    const auto near = [&](const FoundAlias& alias) {
      return same_pose(place, alias.place, localizability_constants.basin_m, localizability_constants.basin_deg);
    };
    return near_any(taken, place, localizability_constants.basin_m, localizability_constants.basin_deg) ||
           std::any_of(aliases.begin(), aliases.end(), near);
  };
  const double near_m = localizability_constants.same_alias_m, near_deg = localizability_constants.same_alias_deg;
  const auto judge = [&](const SensorPose& place) {
    if (search.yaw_known &&
        std::abs(wrap_angle(place.yaw - scan.place.yaw)) > localizability_constants.known_yaw_deg * rad_per_deg)
      return false;
    if (same_pose(place, scan.place, localizability_constants.distinct_m, localizability_constants.distinct_deg) ||
        near_any(taken, place, near_m, near_deg))
      return false;
    // Of two that are near each other the better one stays: a search may end beside an exact image.
    const auto near = std::find_if(aliases.begin(), aliases.end(), [&](const FoundAlias& alias) {
      return same_pose(place, alias.place, near_m, near_deg);
    });
    if (near != aliases.end() && near->llr <= localizability_constants.marginal_llr) return false;
    if (clearly_different(scan, place)) return false;
    const double llr = this->llr(scan, place);
    if (llr > (near == aliases.end() ? localizability_constants.drop_llr : near->llr)) return false;
    if (near != aliases.end()) {
      *near = {place, llr};
      return false;
    }
    aliases.push_back({place, llr});
    return true;
  };
  for (const SensorPose& image : images_of(scan.place, search.storey)) judge(image);
  for (const View& view : views_of(scan.place)) {
    std::vector<SensorPose> tried;
    const auto is_tried = [&](const SensorPose& place) {
      return near_any(tried, place, 0.5 * localizability_constants.basin_m, 0.5 * localizability_constants.basin_deg);
    };
    int in_vain = 0;
    work_ += index_.imager().directions().size() + coarse_.directions().size() + index_.size() / places_a_beam;
    for (auto [place, storey] : index_.like(view.signature, scan.place.yaw, search.storey, search.yaw_known)) {
      if (is_taken(place) || is_tried(place)) continue;
      const bool sound = refine(view.image, index_.storeys()[static_cast<std::size_t>(storey)], place);
      if (!(search.thorough && is_tried(place)) && ++in_vain > give_up_after) break;
      tried.push_back(place);
      if (sound && judge(place)) in_vain = 0;
    }
  }
  // Isometries of a plan are a group: two that fit lead to others, which the search may have missed.
  const Pose X_W0 = scan.place.pose().inverse();
  for (std::size_t a = 0; a < aliases.size() && aliases.size() < most_composed; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      if (std::max(aliases[a].llr, aliases[b].llr) > localizability_constants.marginal_llr) continue;
      const Pose X_Wa = aliases[a].place.pose(), X_Wb = aliases[b].place.pose();
      for (const Pose& X : {X_Wa * X_W0 * X_Wb, X_Wb * X_W0 * X_Wa}) judge({X.t, X.yaw()});
    }
  return aliases;
}

}  // namespace plumbline::scenarios
