// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/pcl_registration/pcl_registration.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "slam/odometry/odometry_method.h"
#include "slam/scan/motion.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

std::vector<Eigen::Vector3d> thinned_returns(const DeskewedScan& scan, const PclLocalMapConfig& config) {
  return voxel_downsample(points_between(scan, config.min_range_m, config.max_range_m), config.scan_voxel_m);
}

/// The latest keyframes as the target of a matcher, in the frame K of the newest: PCL's floats are fine near the
/// origin, and covariances of points far from it are not.
class LocalMap {
 public:
  LocalMap(const PclLocalMapConfig& config, std::unique_ptr<PclMatcher> matcher)
      : config_(config), matcher_(std::move(matcher)) {}

  [[nodiscard]] bool empty() const { return keyframes_.empty(); }
  void clear() { keyframes_.clear(); }

  /// X_MR, from a guess of it; T is M.
  [[nodiscard]] PclMatch match(const std::vector<Eigen::Vector3d>& points_R, const Pose& X_MR) {
    const Pose& X_MK = keyframes_.back().X_MR;
    PclMatch match = matcher_->match(points_R, X_MK.inverse() * X_MR);
    match.X_TS = X_MK * match.X_TS;
    return match;
  }

  /// Takes a scan in, if it is far enough from the newest keyframe.
  void add(const std::vector<Eigen::Vector3d>& points_R, const Pose& X_MR) {
    if (!keyframes_.empty()) {
      const Pose step = keyframes_.back().X_MR.inverse() * X_MR;
      if (step.t.norm() < config_.keyframe_distance_m && log_so3(step.q).norm() < config_.keyframe_angle_rad) return;
    }
    keyframes_.push_back({X_MR, points_R});
    if (keyframes_.size() > static_cast<std::size_t>(config_.keyframes)) keyframes_.pop_front();
    const Pose X_KM = X_MR.inverse();
    VoxelMeans means(config_.map_voxel_m);
    for (const Keyframe& keyframe : keyframes_) {
      const Pose X_KR = X_KM * keyframe.X_MR;
      for (const Eigen::Vector3d& p_R : keyframe.points_R) means.add(X_KR * p_R);
    }
    matcher_->set_target(means.means());
  }

 private:
  struct Keyframe {
    Pose X_MR;
    std::vector<Eigen::Vector3d> points_R;
  };

  const PclLocalMapConfig config_;
  std::unique_ptr<PclMatcher> matcher_;
  std::deque<Keyframe> keyframes_;
};

/// The robot's poses as they were found, and where its motion leads from them.
class Motion {
 public:
  Motion(PclGuess guess, bool has_odometry, const Calibration& calibration)
      : guess_(guess), has_odometry_(has_odometry), calibration_(calibration) {}

  void add(const Odometry& odometry) { odometry_.add(odometry); }

  /// The scan without the motion during it, by odometry or as if the last motion went on.
  [[nodiscard]] DeskewedScan deskewed(const Scan& scan) const {
    if (has_odometry_) return deskew(scan, odometry_, calibration_);
    const Nanoseconds dt = any_ ? std::max<Nanoseconds>(scan.stamp - stamp_, 1) : 1;
    MotionBuffer steady;
    steady.add({scan.stamp - dt, Pose{}});
    steady.add({scan.stamp, continued(dt)});
    return deskew(scan, steady, calibration_);
  }

  /// X_MR at the scan's stamp. Odometry's motion over a gap in its records is not used.
  [[nodiscard]] Pose guess(const DeskewedScan& scan) {
    Pose X_MR = X_MR_ * continued(scan.stamp - stamp_);
    if (has_odometry_) {
      const Pose X_OR = odometry_.at(scan.stamp);
      const bool continuous = X_OR_ && !stale_ && !scan.odometry_stale;
      if (guess_ == PclGuess::odometry && continuous) X_MR = X_MR_ * (X_OR_->inverse() * X_OR);
      X_OR_ = X_OR;
      stale_ = scan.odometry_stale;
      odometry_.forget_before(scan.stamp);
    }
    X_MR.q.normalize();
    return X_MR;
  }

  /// X_MR as it was found. registered: else its motion says nothing of the next.
  void keep(Nanoseconds stamp, const Pose& X_MR, bool registered) {
    dt_ = registered && any_ ? stamp - stamp_ : 0;
    step_ = X_MR_.inverse() * X_MR;
    X_MR_ = X_MR;
    stamp_ = stamp;
    any_ = true;
  }

 private:
  [[nodiscard]] Pose continued(Nanoseconds dt) const {
    constexpr double most_steps = 3.0;  // farther ahead the last one's noise dominates
    if (dt_ <= 0 || dt <= 0) return {};
    return interpolate(Pose{}, step_, std::min(seconds(dt) / seconds(dt_), most_steps));
  }

  PclGuess guess_;
  bool has_odometry_;
  Calibration calibration_;
  MotionBuffer odometry_;
  std::optional<Pose> X_OR_;  ///< at the last scan
  bool stale_ = false, any_ = false;
  Nanoseconds stamp_ = 0, dt_ = 0;
  Pose X_MR_, step_;  ///< step_: over dt_, which is 0 where it is not known
};

/// Whether answers are believed, with hysteresis.
class Fit {
 public:
  explicit Fit(const PclFitConfig& config) : config_(config) {}

  /// True: take the answer. correction: from the guess to it.
  [[nodiscard]] bool assess(const PclMatch& match, const Pose& correction) {
    return count(match.converged && match.matched >= config_.min_matched &&
                 correction.t.norm() <= config_.max_correction_m &&
                 log_so3(correction.q).norm() <= config_.max_correction_rad);
  }
  void nothing_seen() { (void)count(false); }

  [[nodiscard]] bool lost() const { return lost_; }
  /// True once after so many bad scans that the map is of no use.
  [[nodiscard]] bool wants_restart() const { return bad_ > 0 && bad_ % config_.restart_scans == 0; }

 private:
  bool count(bool good) {
    good_ = good ? good_ + 1 : 0;
    bad_ = good ? 0 : bad_ + 1;
    if (bad_ >= config_.bad_scans) lost_ = true;
    if (good_ >= config_.good_scans) lost_ = false;
    return good;
  }

  const PclFitConfig config_;
  int good_ = 0, bad_ = 0;  ///< in a row
  bool lost_ = false;
};

class PclRegistrationMethod final : public OdometryMethod {
 public:
  PclRegistrationMethod(const MethodInput& input, const PclLocalMapConfig& config, const MapCloudConfig& map,
                        std::unique_ptr<PclMatcher> matcher)
      : OdometryMethod(map),
        config_(config),
        motion_(config.guess, input.has_odometry, input.calibration),
        local_map_(config, std::move(matcher)),
        fit_(config.fit) {}

  void on_odometry(const Odometry& odometry) override { motion_.add(odometry); }

 private:
  [[nodiscard]] DeskewedScan deskewed(const Scan& raw) override { return motion_.deskewed(raw); }

  /// Registers the scan, and takes it into the local map where it fits. The pose is the guess, where it does not.
  [[nodiscard]] OdometryAnswer track(const Scan&, DeskewedScan& scan) override {
    const std::vector<Eigen::Vector3d> points_R = thinned_returns(scan, config_);
    OdometryAnswer answer{.X_MR = motion_.guess(scan), .accepted = false};
    double matched = 0.0;
    const bool begun = !local_map_.empty(), enough = points_R.size() >= PclMatcher::least_points;
    if (begun) {
      const PclMatch match = local_map_.match(points_R, answer.X_MR);
      matched = match.matched;
      answer.accepted = fit_.assess(match, answer.X_MR.inverse() * match.X_TS);
      if (answer.accepted) answer.X_MR = match.X_TS;
      if (!answer.accepted && fit_.wants_restart()) local_map_.clear();
    } else if (!enough) {
      fit_.nothing_seen();
    }
    if (answer.accepted || (!begun && enough)) local_map_.add(points_R, answer.X_MR);
    motion_.keep(scan.stamp, answer.X_MR, answer.accepted);
    answer.lost = fit_.lost();
    answer.digest = Digest().add(answer.X_MR).add(matched).value();
    return answer;
  }

  const PclLocalMapConfig config_;
  Motion motion_;
  LocalMap local_map_;
  Fit fit_;
};

}  // namespace

std::unique_ptr<Method> make_pcl_gicp_method(const MethodInput& input, const PclGicpMethodConfig& config) {
  return std::make_unique<PclRegistrationMethod>(input, config.local_map, config.map,
                                                 make_pcl_gicp(config.gicp, config.local_map.fit.matched_m));
}

std::unique_ptr<Method> make_pcl_ndt_method(const MethodInput& input, const PclNdtMethodConfig& config) {
  return std::make_unique<PclRegistrationMethod>(input, config.local_map, config.map,
                                                 make_pcl_ndt(config.ndt, config.local_map.fit.matched_m));
}

}  // namespace plumbline::slam
