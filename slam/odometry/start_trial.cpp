// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/start_trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "slam/registration/correlation.h"

namespace plumbline::slam {

namespace {

/// From the first on, of which the last are judged: by then a map that is built from a wrong start contradicts itself.
/// Chosen on three starts at 4 to 10 m/s, at 5 and 10 Hz: from the right one 0.61 to 0.89 match, from a standstill 0.46
/// to 0.49. After two scans it is 0.42 to 0.71 and 0.54 to 0.68.
constexpr std::size_t trial_scans = 6, judged_scans = 3;

constexpr double same_place_m = 0.6;  ///< of two places: two voxels of the correlation

/// Mean share of matches; scans that were not accepted match nothing.
double matched_by(const std::vector<Registration>& results) {
  double sum = 0.0;
  for (std::size_t k = results.size() - judged_scans; k < results.size(); ++k)
    sum += results[k].accepted ? results[k].matched : 0.0;
  return sum / static_cast<double>(judged_scans);
}

/// Whether surfaces hold the way along a direction of M in every scan that is judged. Where they leave it open, as in a
/// wide hall, any velocity goes on by itself, and what matches more or less says nothing of it.
bool tell_way_along(const std::vector<Registration>& results, const Eigen::Vector3d& direction_M) {
  constexpr double most_open = 0.5;  // share of the direction: at 45 degrees to it
  return std::all_of(results.end() - judged_scans, results.end(), [&](const Registration& result) {
    double open = 0.0;
    for (const Vector6d& increment : result.unobserved)
      open += std::pow((result.X_MR.q * increment.head<3>()).dot(direction_M), 2);
    return open <= most_open;
  });
}

std::vector<Vector6d> horizontal_movements(const Eigen::Vector3d& up) {
  const Eigen::Vector3d x = (Eigen::Vector3d::UnitX() - up.x() * up).normalized();
  std::vector<Vector6d> out(2, Vector6d::Zero());
  out[0].head<3>() = x;
  out[1].head<3>() = up.cross(x);
  return out;
}

}  // namespace

std::optional<StartTrial::Tracked> StartTrial::add(const Scan& raw, const ScanTracker& tracker,
                                                   const Registration& result) {
  if (result.began) end();
  if (result.began) began_.emplace(tracker);
  if (!began_) return std::nullopt;
  scans_.push_back(raw);
  results_.push_back(result);
  if (scans_.size() < trial_scans) return std::nullopt;
  std::optional<Tracked> better = better_start();
  end();
  return better;
}

void StartTrial::end() {
  began_.reset();
  scans_.clear();
  results_.clear();
}

std::vector<Eigen::Vector3d> StartTrial::other_velocities() const {
  constexpr double most_window_m = 8.0;  // bounds the time: assumed
  const SurfelConfig& config = config_.vgicp.surfels;
  const double max_range_m = std::min(config.max_range_m, correlation_range_m * config_.vgicp.largest_scale);
  const auto returns_of = [&](const Scan& scan) {
    return thinned_returns(as_deskewed(scan, calibration_), config.min_range_m, max_range_m);
  };
  const std::vector<Surfel> surfels = make_surfels(as_deskewed(scans_.front(), calibration_), config);
  const ReturnVoxels first(returns_of(scans_.front()));
  const std::vector<Vector6d> movements = horizontal_movements(up_of(surfels));
  std::vector<Eigen::Vector3d> velocities;
  // Of a slow motion only a later scan tells; a fast one leaves the window by then.
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
    const double dt_s = seconds(scans_[k].stamp - scans_.front().stamp);
    const double window_m = std::min(most_window_m, config_.health.max_start_speed_mps * dt_s);
    const std::optional<Eigen::Vector3d> way_m = correlation_peak(
        first, standing_returns(returns_of(scans_[k]), surfels), calibration_.X_RL.t, movements, window_m);
    if (!way_m) continue;
    const auto leads_there = [&](const Eigen::Vector3d& mps) { return (mps * dt_s - *way_m).norm() < same_place_m; };
    const Eigen::Vector3d found_mps = (results_.front().X_MR.inverse() * results_[k].X_MR).t / dt_s;
    if (!leads_there(found_mps) && std::none_of(velocities.begin(), velocities.end(), leads_there))
      velocities.push_back(*way_m / dt_s);
  }
  return velocities;
}

std::optional<StartTrial::Tracked> StartTrial::better_start() const {
  constexpr double clearly = 1.1;  // as that of another start in VgicpOdometry
  double most = std::max(config_.health.measuring_share, clearly * matched_by(results_));
  std::optional<Tracked> best;
  if (most >= 1.0) return best;
  for (const Eigen::Vector3d& mps : other_velocities()) {
    Tracked tracked{*began_, {}, {}};
    tracked.tracker.assume_velocity(mps);
    std::vector<Registration> results = {results_.front()};
    for (std::size_t k = 1; k < scans_.size(); ++k) {
      tracked.scan = tracked.tracker.deskewed(scans_[k]);
      results.push_back(tracked.tracker.track(scans_[k], tracked.scan));
    }
    const double matched = matched_by(results);
    if (!tell_way_along(results, results_.front().X_MR.q * mps.normalized())) continue;
    if (matched <= most || (results.back().X_MR.t - results_.back().X_MR.t).norm() < same_place_m) continue;
    most = matched;
    tracked.result = std::move(results.back());
    best = std::move(tracked);
  }
  if (best) {
    const Nanoseconds dt = scans_.back().stamp - scans_[scans_.size() - 2].stamp;
    best->result.information = unknown_information(config_.health, dt, config_.health.max_start_speed_mps);
  }
  return best;
}

}  // namespace plumbline::slam
