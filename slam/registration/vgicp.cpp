// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/vgicp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "slam/registration/coarse_search.h"
#include "slam/registration/far_surfaces.h"
#include "slam/registration/support.h"
#include "slam/registration/sweep_twist.h"

namespace plumbline::slam {

namespace {

/// Surfels of voxels lie on a lattice that moves with the robot, as those of the map did: along their surfaces they
/// pull the robot to where it was. Chosen on a corridor with 64 rings at 20 Hz: 1 slides 6 m, 2.5 errs by 3 cm.
constexpr double lattice_slack = 2.5;

/// Of a scan with more surfels so many are registered; all of them are mapped. Chosen on a hall of 60 x 40 m with 128
/// rings at 5 Hz, whose scans have 20,000: time grows with their number, accuracy does not.
constexpr std::size_t most_registered = 5000;

/// Where things move, so many of the latest scans show it, each counting by that much less than the next: 75 to 88 % do
/// in five crowds, at most 7 % on five walks without. Between them, assumed.
constexpr double least_moving_share = 0.3, moving_memory = 0.9;

/// Of a scan's rough points so many are matched and mapped: assumed.
constexpr std::size_t most_rough = 1000;

/// At most so many of a scan's surfels or points, evenly spread over the sweep.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> kept;
  kept.reserve(most);
  for (std::size_t k = 0; k < most; ++k) kept.push_back(all[k * all.size() / most]);
  return kept;
}

/// A pose that differs from the expected one where surfaces leave it open. Where the robot comes to what it has not
/// seen yet, as along a corridor, more of a scan matches the farther it is slid back.
bool slides(const Registration& found, const Pose& expected, double sigma_m) {
  constexpr double sigmas = 3.0;
  const Vector6d off = log_se3(expected.inverse() * found.X_MR);
  return off.dot(found.open * off) > sigmas * sigmas * sigma_m * sigma_m;
}

}  // namespace

VgicpOdometry::VgicpOdometry(const VgicpConfig& config) : config_(config), edge_map_(config.edges) { set_scale(1.0); }

Registration VgicpOdometry::update(const DeskewedScan& scan, const Pose& X_OR) {
  Registration result = match(scan, {.step = X_OR_.inverse() * X_OR, .q_OR = X_OR.q});
  X_OR_ = X_OR;
  commit(result.X_MR, true);
  return result;
}

Registration VgicpOdometry::match(const DeskewedScan& scan, const OdometrySample& odometry, double usual_matched) {
  follow_scale(scan);
  scan_ = features_of(scan);
  Registration result;
  result.X_MR = X_MR_;
  const bool measured = config_.odometry_prior && odometry.valid;
  if (ready()) {
    const PosePrior prediction = predict(scan, odometry);
    const auto prior = config_.odometry_prior || config_.tilt_prior ? std::optional(prediction) : std::nullopt;
    result = align_surfaces(prediction.X_MR, prior, odometry);
    std::optional<Registration> correlated;
    if (config_.correlation && !measured && result.unobserved_directions > 0)
      correlated = align_correlated(scan, result, prior, odometry);
    result =
        correlated ? *std::move(correlated) : with_rough_points(std::move(result), prediction.X_MR, prior, odometry);
    result.from_expected = true;
    const auto starts_from_expected = std::span<const Pose>(&prediction.X_MR, 1);
    // Along a degenerate direction one start matches as well as another: only clearly more matches are better, or as
    // many that leave less open. Surfaces that a scan does not meet where it starts count as open.
    constexpr double clearly = 1.1, as_usual = 0.8, hardly = 0.5, about = 0.9;
    const auto try_from = [&](std::span<const Pose> starts) {
      Registration again = align_finely(align_coarsely(starts).X_MR, prior, odometry);
      const bool tells_more = again.unobserved_directions < result.unobserved_directions;
      if (again.matched <= (tells_more ? about : clearly) * result.matched) return;
      if (result.correlated && again.unobserved_directions > 0) return;
      // No robot comes so far: rooms of two storeys, or of one floor, are alike.
      const Pose off = prediction.X_MR.inverse() * again.X_MR;
      if (off.t.norm() > odometry.farthest_m || log_so3(off.q).norm() > odometry.farthest_rad) return;
      // What nothing measures is as well where it was expected.
      constexpr double least_slack_m = 0.1;
      const double slack_m = measured ? odometry.sigma_m : std::max(least_slack_m, odometry.sigma_m);
      if ((measured || again.unobserved_directions > 0) && slides(again, prediction.X_MR, slack_m)) return;
      again.from_expected = is_near(again.X_MR, align_coarsely(starts_from_expected).X_MR);
      result = again;
    };
    const std::array<Pose, 3> starts = {prediction.X_MR, X_MR_, Pose{prediction.X_MR.q, X_MR_.t}};
    const bool is_open = !measured && result.unobserved_directions > 0 && !result.correlated;
    if (result.matched < as_usual * usual_matched || is_open)
      try_from(measured ? std::span<const Pose>(starts).first(1) : starts);
    if (result.matched < (measured ? hardly : as_usual) * usual_matched) try_from(yaw_fan(X_MR_));
    correct_sweep(scan, prior, odometry, result);
  }
  if (!q_OM_) q_OM_ = odometry.q_OR;
  stamp_ = scan.stamp;
  if (measured) moving_share_ += (1.0 - moving_memory) * ((result.moving_R ? 1.0 : 0.0) - moving_share_);
  is_measured_ = measured || result.unobserved_directions == 0;
  if (config_.correlation && (!ready() || is_new_view(result.X_MR))) scan_.returns_R = returns_of(scan);
  return result;
}

// Within the reach of the coarsest map from one another.
bool VgicpOdometry::is_near(const Pose& a, const Pose& b) const {
  const Pose difference = a.inverse() * b;
  return difference.t.norm() < 0.5 * maps_.back().voxel_m() && log_so3(difference.q).norm() < yaw_fan_turn_rad;
}

VgicpOdometry::ScanFeatures VgicpOdometry::features_of(const DeskewedScan& scan) const {
  ScanFeatures out;
  const double far_m = correlation_range_m * scale_;
  Surfaces surfaces = find_surfaces(scan, surfels_);
  out.surfels = std::move(surfaces.surfels);
  if (config_.rough_points) out.rough_R = thinned(within(surfaces.rough_R, far_m), most_rough);
  out.fine = registration_;
  if (has_ring_image(scan))
    out.edges_R = edge_points(scan, config_.edges);
  else
    out.fine.sigma_tangent_m *= lattice_slack;
  out.registered = thinned(without_few_far(out.surfels, far_m), most_registered);
  for (std::size_t k = 0; k < out.registered.size(); k += static_cast<std::size_t>(config_.coarse_share))
    out.subsample.push_back(out.registered[k]);
  return out;
}

bool VgicpOdometry::bends(const DeskewedScan& scan) const {
  const auto [first, last] = std::minmax_element(scan.time_s.begin(), scan.time_s.end());
  const double sweep_s = static_cast<double>(*last) - static_cast<double>(*first);
  const double distance_m = std::max(config_.reference_range_m, median_distance(scan_.registered));
  return scan.twist_sigma.radps * sweep_s * distance_m > scan.twist_sigma.least_bend_m;
}

void VgicpOdometry::correct_sweep(const DeskewedScan& scan, const std::optional<PosePrior>& prior,
                                  const OdometrySample& odometry, Registration& result) {
  // On open ground a scan corrected to lie flat slides over it.
  constexpr int most_open = 1;
  if (result.degenerate_directions > most_open) return;
  if (scan.time_s.empty() || !(scan.twist_sigma.mps > 0.0) || !bends(scan)) return;
  const std::array<RegistrationConfig, 2> configs = {scan_.fine, coarser(registration_, maps_[1].voxel_m())};
  const Vector6d twist = sweep_twist(scan_.registered, std::span(maps_).first(configs.size()), result.X_MR, prior,
                                     scan.twist_sigma, configs);
  DeskewedScan corrected = scan;
  correct_motion(corrected, twist);
  ScanFeatures uncorrected = std::exchange(scan_, features_of(corrected));
  Registration again = result.correlated ? align_known(result.X_MR, result.correlated->movements, prior, odometry)
                                         : align_finely(result.X_MR, prior, odometry);
  constexpr double about = 0.9;
  if (again.matched < about * result.matched || again.residual_m > result.residual_m) {
    scan_ = std::move(uncorrected);
    return;
  }
  again.from_expected = result.from_expected;
  again.correlated = std::move(result.correlated);
  if (again.correlated) again.correlated->X_KR = again.correlated->X_KR * (result.X_MR.inverse() * again.X_MR);
  result = std::move(again);
  result.sweep_twist = twist;
}

AdditionalFactors VgicpOdometry::edges_near(const Pose& X_MR) const {
  const double information = 1.0 / (config_.edges.sigma_m * config_.edges.sigma_m);
  return [lines = edge_map_.match(scan_.edges_R, X_MR), information, huber_m = config_.edges.huber_m](const Pose& X) {
    Normal6 terms = loam::linearize(lines, X, huber_m);
    terms.h *= information;
    terms.g *= information;
    return terms;
  };
}

Registration VgicpOdometry::align_finely(const Pose& start, const std::optional<PosePrior>& prior,
                                         const OdometrySample& odometry) const {
  return with_rough_points(align_surfaces(start, prior, odometry), start, prior, odometry);
}

Registration VgicpOdometry::align_surfaces(const Pose& start, const std::optional<PosePrior>& prior,
                                           const OdometrySample& odometry) const {
  // Lines are searched at the start. Odometry's error is below the spacing of columns; without it they are searched
  // again where they led.
  const int rounds = odometry.valid ? 1 : 3;
  Registration result;
  result.X_MR = start;
  for (int round = 0; round < rounds; ++round) {
    const Pose before = result.X_MR;
    result =
        align(scan_.registered, maps_.front(), before, prior, scan_.fine, edges_near(before), odometry.sigma_m, start);
    if ((result.X_MR.t - before.t).norm() < 0.1 * config_.edges.leaf_m) break;
  }
  if (!config_.odometry_prior || !odometry.valid || !prior) return result;
  const std::optional<Eigen::Vector3d> moving_R =
      moving_direction(scan_.registered, maps_.front(), result, prior->X_MR, odometry.sigma_m, scan_.fine,
                       moving_share_ >= least_moving_share);
  if (!moving_R) return result;
  return align(scan_.registered, maps_.front(), start, prior, scan_.fine, edges_near(start), odometry.sigma_m, start,
               {}, moving_R);
}

std::vector<double> VgicpOdometry::rough_reaches(const Pose& X_MR) const {
  // As many points as this meet the map where the motion is known; elsewhere they are sought farther off first. Both
  // assumed, looked at on four open fields and lc1.
  constexpr double usual_share = 0.3;
  constexpr int doublings = 3, rounds = 3;
  const double reach_m = 3.0 * surfels_.voxel_m;
  const auto near = static_cast<double>(rough_map_.match(scan_.rough_R, X_MR, reach_m).size());
  const bool is_near = near >= usual_share * static_cast<double>(scan_.rough_R.size());
  std::vector<double> reaches;
  for (int k = is_near ? 0 : -doublings; k < rounds; ++k) reaches.push_back(reach_m * std::exp2(std::max(0, -k)));
  return reaches;
}

Registration VgicpOdometry::with_rough_points(Registration found, const Pose& expected,
                                              const std::optional<PosePrior>& prior,
                                              const OdometrySample& odometry) const {
  if (found.unobserved_directions == 0 || scan_.rough_R.empty() || rough_map_.empty()) return found;
  const std::vector<double> reaches_m = rough_reaches(found.X_MR);
  return with_rough_points_within(reaches_m, std::move(found), expected, prior, odometry);
}

Registration VgicpOdometry::with_rough_points_within(std::span<const double> reaches_m, Registration found,
                                                     const Pose& expected, const std::optional<PosePrior>& prior,
                                                     const OdometrySample& odometry) const {
  if (found.unobserved_directions == 0 || scan_.rough_R.empty() || rough_map_.empty()) return found;
  for (const double within_m : reaches_m) {
    const std::vector<RoughMatch> matches = rough_map_.match(scan_.rough_R, found.X_MR, within_m);
    found = align(
        scan_.registered, maps_.front(), found.X_MR, prior, scan_.fine, edges_near(found.X_MR), odometry.sigma_m,
        expected, [&](const Pose& X_MR) { return linearize(matches, X_MR, within_m / 3.0); }, found.moving_R);
    found.by_rough_points = !matches.empty();
  }
  return found;
}

const VgicpOdometry::Keyframe& VgicpOdometry::keyframe_apart_from(const Pose& X_MR) const {
  constexpr double apart_m = 1.2, far_m = 3.6;
  const Keyframe* latest = nullptr;
  for (auto keyframe = keyframes_.rbegin(); keyframe != keyframes_.rend(); ++keyframe) {
    const double way_m = (keyframe->X_MR.t - X_MR.t).norm();
    if (way_m >= apart_m && way_m <= far_m && keyframe->measured) return *keyframe;
    if (way_m >= apart_m && latest == nullptr) latest = &*keyframe;
  }
  return latest == nullptr ? keyframes_.back() : *latest;
}

std::vector<Eigen::Vector3d> VgicpOdometry::returns_of(const DeskewedScan& scan) const {
  return thinned_returns(scan, surfels_.min_range_m, std::min(surfels_.max_range_m, correlation_range_m * scale_));
}

std::optional<Registration> VgicpOdometry::align_correlated(const DeskewedScan& scan, const Registration& found,
                                                            const std::optional<PosePrior>& prior,
                                                            const OdometrySample& odometry) const {
  constexpr double window_m = 2.4, largest_scale = 2.0;  // a car's first step; more takes the square of the time
  constexpr double least_share = 0.5;                    // of what matched: surfaces that go along match as well
  const Keyframe& keyframe = keyframe_apart_from(found.X_MR);
  const std::vector<Vector6d> searched = movements(found.unobserved);
  const std::optional<Pose> X_KR = correlate(keyframe.returns, standing_returns(returns_of(scan), scan_.surfels),
                                             keyframe.X_MR.inverse() * found.X_MR, scan.X_RL.t, searched,
                                             window_m * std::min(scale_, largest_scale));
  if (!X_KR) return std::nullopt;
  Registration again = align_known(keyframe.X_MR * *X_KR, searched, prior, odometry);
  if (again.matched < least_share * found.matched) return std::nullopt;
  again.correlated = CorrelatedStep{keyframe.stamp, keyframe.X_MR.inverse() * again.X_MR, searched};
  return again;
}

Registration VgicpOdometry::align_known(const Pose& expected, std::span<const Vector6d> movements,
                                        const std::optional<PosePrior>& prior, const OdometrySample& odometry) const {
  constexpr double sigma_m = 0.1;                               // a third of a voxel of the correlation
  constexpr std::array<double, 3> reaches_m = {0.3, 0.3, 0.3};  // of rough points: a voxel
  OdometrySample known = odometry;
  known.sigma_m = sigma_m;
  Registration result =
      with_rough_points_within(reaches_m, align_surfaces(expected, prior, known), expected, prior, known);
  result.information += result.open / (sigma_m * sigma_m);
  result.unobserved_directions = directions_beside(result.unobserved, movements);
  return result;
}

Registration VgicpOdometry::align_coarsely(std::span<const Pose> starts) const {
  return slam::align_coarsely(scan_.subsample, maps_, registration_, starts);
}

Registration VgicpOdometry::place_in(std::span<const SurfelMap> maps, const Pose& start) const {
  const Registration near = slam::align_coarsely(scan_.subsample, maps, registration_, std::span(&start, 1));
  return align(scan_.registered, maps.front(), near.X_MR, std::nullopt, scan_.fine);
}

void VgicpOdometry::commit(const Pose& X_MR, bool mapped) {
  X_MR_ = X_MR;
  is_keyframe_ = mapped && !scan_.surfels.empty();
  if (is_keyframe_ && ready()) is_keyframe_ = is_new_view(X_MR);
  if (is_keyframe_) insert(X_MR_);
}

bool VgicpOdometry::is_new_view(const Pose& X_MR) const {
  const Pose X_KR = keyframes_.back().X_MR.inverse() * X_MR;
  return X_KR.t.norm() >= config_.keyframe_distance_m * scale_ || log_so3(X_KR.q).norm() >= config_.keyframe_angle_rad;
}

void VgicpOdometry::reset_map() {
  keyframes_.clear();
  edge_map_ = EdgeMap(config_.edges);
  rough_map_ = {};
  set_scale(scale_);
}

void VgicpOdometry::follow_scale(const DeskewedScan& scan) {
  constexpr double time_constant_s = 2.0;
  constexpr double change = 1.25;  // from which sizes follow
  if (scale_stamp_ && scan.stamp <= *scale_stamp_) return;
  const double now_m = median_range(scan);
  if (now_m <= 0.0) return;
  const double kept = median_range_m_ > 0.0
                          ? std::exp(-seconds(scan.stamp - scale_stamp_.value_or(scan.stamp)) / time_constant_s)
                          : 0.0;
  scale_stamp_ = scan.stamp;
  median_range_m_ = kept * median_range_m_ + (1.0 - kept) * now_m;
  const double scale = std::clamp(median_range_m_ / config_.reference_range_m, 1.0, config_.largest_scale);
  const bool to_the_least = scale <= 1.0 && scale_ > 1.0;
  if (scale < change * scale_ && scale_ < change * scale && !to_the_least) return;
  set_scale(scale);
}

void VgicpOdometry::set_scale(double scale) {
  scale_ = scale;
  surfels_ = config_.surfels;
  surfels_.voxel_m *= scale;
  surfels_.radius_m *= scale;
  surfels_.max_thickness_m *= scale;
  registration_ = config_.registration;
  registration_.sigma_tangent_m *= scale;
  maps_.clear();
  for (int level = 0; level <= config_.coarse_levels; ++level)
    maps_.emplace_back(config_.map_voxel_m * scale * static_cast<double>(1 << level));
  for (SurfelMap& map : maps_)
    for (const Keyframe& keyframe : keyframes_) map.add(keyframe.surfels, keyframe.X_MR);
}

PosePrior VgicpOdometry::predict(const DeskewedScan& scan, const OdometrySample& odometry) const {
  const Pose& step = odometry.step;
  PosePrior prior{X_MR_ * step, Matrix6d::Zero(), std::nullopt};
  if (config_.odometry_prior && odometry.valid) {
    const double sigma_m = config_.prior_m + config_.prior_per_m * step.t.norm() + odometry.extrapolated_m;
    const double sigma_rad =
        config_.prior_rad + config_.prior_per_rad * log_so3(step.q).norm() + odometry.extrapolated_rad;
    prior.information.diagonal().head<3>().setConstant(1.0 / (sigma_m * sigma_m));
    prior.information.diagonal().tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  }
  if (config_.tilt_prior && !scan.odometry_stale && q_OM_ && odometry.q_OR) {
    const Eigen::Vector3d up_O = Eigen::Vector3d::UnitZ();
    prior.tilt = TiltPrior{odometry.q_OR->conjugate() * up_O, q_OM_->conjugate() * up_O, config_.tilt_rad};
  }
  return prior;
}

void VgicpOdometry::insert(const Pose& X_MR) {
  for (SurfelMap& map : maps_) map.add(scan_.surfels, X_MR);
  edge_map_.add(std::move(scan_.edges_R), X_MR, static_cast<std::size_t>(config_.map_keyframes));
  if (config_.rough_points)
    rough_map_.add(std::move(scan_.rough_R), X_MR, static_cast<std::size_t>(config_.map_keyframes));
  keyframes_.push_back({std::move(scan_.surfels), X_MR, stamp_, is_measured_, ReturnVoxels(scan_.returns_R)});
  if (keyframes_.size() <= static_cast<std::size_t>(config_.map_keyframes)) return;
  for (SurfelMap& map : maps_) map.remove(keyframes_.front().surfels, keyframes_.front().X_MR);
  keyframes_.pop_front();
  if (maps_.front().holds_many_empty()) set_scale(scale_);
}

}  // namespace plumbline::slam
