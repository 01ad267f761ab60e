// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/mloam/mloam.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bim/digest/digest.h"
#include "slam/baselines/mloam/uncertainty.h"
#include "slam/odometry/odometry_method.h"

namespace plumbline::slam {

namespace {

/// A longer step is none, and M ends there.
constexpr double longest_step_m = 10.0, farthest_m = 1e5;

std::vector<Eigen::Vector3d> places(const std::vector<loam::FeaturePoint>& points) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const loam::FeaturePoint& point : points) result.push_back(point.p_R);
  return result;
}

/// The reference weighs residuals by 1 / trace of their point's covariance. With one LiDAR of known mount that is one
/// number for all, so the thresholds of eigenvalues are scaled instead.
MloamConfig with_scaled_thresholds(MloamConfig config, const Calibration& calibration) {
  const Eigen::Matrix3d of_point = config.point_sigma_m * config.point_sigma_m * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d covariance =
      mloam::point_covariance(calibration.X_RL, Matrix6d::Zero(), Eigen::Vector3d::Zero(), of_point);
  config.window.least_eigenvalue *= covariance.trace();
  config.submap.least_eigenvalue *= covariance.trace();
  return config;
}

class Mloam final : public OdometryMethod {
 public:
  Mloam(const MethodInput& input, const MloamConfig& config)
      : OdometryMethod(config.map),
        config_(with_scaled_thresholds(config, input.calibration)),
        calibration_(input.calibration),
        beams_(config.beam_model),
        window_(config_.window),
        submap_(config_.submap) {}

 private:
  /// As if the last motion went on.
  [[nodiscard]] DeskewedScan deskewed(const Scan& raw) override {
    constexpr double most_steps = 3.0;
    const Nanoseconds dt = trajectory().empty() ? 0 : raw.stamp - trajectory().back().stamp;
    MotionBuffer steady;
    steady.add({raw.stamp - std::max<Nanoseconds>(dt, 1), Pose()});
    if (dt > 0 && interval_ > 0)
      steady.add({raw.stamp, interpolate(Pose(), X_LR_, std::min(seconds(dt) / seconds(interval_), most_steps))});
    return deskew(raw, steady, calibration_);
  }

  [[nodiscard]] OdometryAnswer track(const Scan& raw, DeskewedScan& scan) override {
    const std::optional<DeskewedScan> in_rings = beams_.in_rings(scan);
    loam::Features features = loam::find_features(in_rings ? *in_rings : scan, config_.features);
    const bool first = trajectory().empty();
    OdometryAnswer answer{.X_MR = X_MR_};
    bool matched = first;
    if (first)
      (void)window_.add(thin(features), X_OR_);
    else
      matched = advance(features, answer);
    X_LR_ = matched ? X_MR_.inverse() * answer.X_MR : Pose();
    interval_ = first ? 0 : raw.stamp - trajectory().back().stamp;
    X_MR_ = answer.X_MR;
    answer.lost = !matched;
    answer.accepted = matched;
    if (matched) map(features);
    last_ = std::move(features);
    answer.digest = Digest().add(answer.X_MR).add(answer.degenerate_directions).value();
    return answer;
  }

  /// Scan to scan, in the window, then in the map. False where neither of these matches: the pose stands.
  bool advance(const loam::Features& features, OdometryAnswer& answer) {
    const Pose step = loam::align_scans(features, last_, X_LR_, config_.tracker);
    const Pose guess = X_MR_ * step;
    if (!is_near(guess)) return stand();
    const loam::MapFeatures thinned = thin(features);
    // The window has a frame of its own, O: the map's corrections do not reach its scans.
    Pose X_OR = X_OR_ * step;
    const std::optional<Pose> in_window = config_.window.on ? window_.add(thinned, X_OR) : std::nullopt;
    if (in_window && is_near(X_MR_ * X_OR_.inverse() * *in_window)) X_OR = *in_window;
    const Pose start = X_MR_ * X_OR_.inverse() * X_OR;
    X_OR_ = X_OR;
    const loam::MapAlignment in_map = submap_.align(thinned, start);
    const bool told = in_map.found && is_near(in_map.X_MR);
    if (!told && !in_window) return stand();
    answer.X_MR = told ? in_map.X_MR : start;
    answer.degenerate_directions = in_map.degenerate;
    return true;
  }

  bool stand() {
    window_.clear();
    X_OR_ = Pose();
    return false;
  }

  [[nodiscard]] bool is_near(const Pose& X_MR) const {
    return (X_MR.t - X_MR_.t).norm() < longest_step_m && X_MR.t.norm() < farthest_m;
  }

  void map(const loam::Features& features) {
    if (submap_.size() > 0) {
      const Pose step = submap_.pose(submap_.size() - 1).inverse() * X_MR_;
      if (step.t.norm() < config_.keyframe_distance_m && log_so3(step.q).norm() < config_.keyframe_angle_rad) return;
    }
    submap_.add(X_MR_, thin(features));
  }

  [[nodiscard]] loam::MapFeatures thin(const loam::Features& features) const {
    return loam::thinned({places(features.less_sharp), places(features.less_flat)}, config_.submap);
  }

  MloamConfig config_;
  Calibration calibration_;
  BeamsOfRecording beams_;
  mloam::Window window_;
  loam::KeyframeMap submap_;
  loam::Features last_;
  Pose X_MR_;
  Pose X_OR_;                 ///< in the window's frame
  Pose X_LR_;                 ///< the last step
  Nanoseconds interval_ = 0;  ///< that it took
};

}  // namespace

std::unique_ptr<Method> make_mloam(const MethodInput& input, const MloamConfig& config) {
  return std::make_unique<Mloam>(input, config);
}

}  // namespace plumbline::slam
