// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/kiss_icp.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "slam/baselines/kiss_icp/adaptive_threshold.h"
#include "slam/baselines/kiss_icp/robust_icp.h"
#include "slam/baselines/kiss_icp/scan_points.h"
#include "slam/baselines/kiss_icp/voxel_hash_map.h"
#include "slam/odometry/odometry_method.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

namespace {

constexpr double least_voxel_m = 0.01;
// Of the local map's voxels; the reference's program has no keys for them.
constexpr double map_thinning = 0.5, registration_thinning = 1.5;
// Of sigma.
constexpr double gate_sigmas = 3.0;

class KissIcp final : public OdometryMethod {
 public:
  KissIcp(const MethodInput& input, const KissIcpConfig& config)
      : OdometryMethod(config.map),
        config_(config),
        voxel_m_(config.map_voxel_m()),
        X_RL_(input.calibration.X_RL),
        threshold_(config.initial_threshold_m, config.min_motion_m, config.max_range_m),
        local_map_(voxel_m_, config.max_points_per_voxel),
        X_ML_(X_RL_) {}

 private:
  [[nodiscard]] DeskewedScan deskewed(const Scan& raw) override {
    kiss::ScanPoints points = kiss::deskewed_points(raw, twist_within(raw), config_.min_range_m, config_.max_range_m);
    DeskewedScan scan = deskewed_scan(raw, points);
    points_L_ = std::move(points.points_L);
    return scan;
  }

  [[nodiscard]] OdometryAnswer track(const Scan& raw, DeskewedScan&) override {
    const bool first = trajectory().empty();
    OdometryAnswer answer;
    answer.lost = !advance(points_L_);
    if (!first) answer.X_MR = X_ML_ * X_RL_.inverse();
    interval_ = first ? 0 : raw.stamp - trajectory().back().stamp;
    answer.accepted = answer.X_MR.t.lpNorm<Eigen::Infinity>() < map_reach_m();
    answer.digest = Digest().add(answer.X_MR).add(threshold_.sigma_m()).value();
    return answer;
  }

  /// How far from M's origin the robot may be for its returns to fit into the grid of the map that is scored.
  [[nodiscard]] double map_reach_m() const { return 1e6 * config_.map.voxel_m - 2.0 * config_.max_range_m; }

  [[nodiscard]] kiss::ConstantTwist twist_within(const Scan& scan) const {
    const Nanoseconds duration = kiss::sweep_duration(scan);
    if (!config_.deskew || duration == 0) return {};
    if (!config_.deskew_by_interval) return {motion_, duration};
    // The same scan twice, or stamps that are none.
    if (duration > 2 * interval_) return {};
    return {motion_, interval_};
  }

  [[nodiscard]] DeskewedScan deskewed_scan(const Scan& scan, const kiss::ScanPoints& points) const {
    DeskewedScan deskewed;
    deskewed.stamp = scan.stamp;
    deskewed.rings = std::max(1, scan.rings);
    deskewed.columns = scan.columns;
    deskewed.range_m.assign(scan.size(), 0.0);
    deskewed.point_R.assign(scan.size(), Eigen::Vector3d::Zero());
    deskewed.X_RL = X_RL_;
    const Eigen::Matrix3d R_RL = X_RL_.rotation();
    for (std::size_t k = 0; k < points.slots.size(); ++k) {
      deskewed.range_m[points.slots[k]] = scan.range_m[points.slots[k]];
      deskewed.point_R[points.slots[k]] = R_RL * points.points_L[k] + X_RL_.t;
    }
    return deskewed;
  }

  /// One scan; false where it has nothing to be registered to.
  bool advance(const std::vector<Eigen::Vector3d>& points_L) {
    const std::vector<Eigen::Vector3d> map_points_L = kiss::first_of_voxels(points_L, map_thinning * voxel_m_);
    const Pose guess = X_ML_ * motion_;
    const bool empty_map = local_map_.empty();
    const kiss::RobustIcpResult result = kiss::register_points(
        config_.second_thinning ? kiss::first_of_voxels(map_points_L, registration_thinning * voxel_m_) : map_points_L,
        local_map_, guess,
        {.max_distance_m = gate_sigmas * threshold_.sigma_m(),
         .kernel_m = threshold_.sigma_m(),
         .max_iterations = config_.max_iterations,
         .convergence = config_.convergence});
    const double farthest_m = result.X_ML.t.lpNorm<Eigen::Infinity>();
    if (!(farthest_m < local_map_.reach_m() - 2.0 * config_.max_range_m)) {  // diverged: stay
      motion_ = {};
      return false;
    }
    threshold_.add(guess.inverse() * result.X_ML);
    motion_ = X_ML_.inverse() * result.X_ML;
    X_ML_ = result.X_ML;
    for (const Eigen::Vector3d& p_L : map_points_L) local_map_.add(X_ML_ * p_L);
    local_map_.drop_beyond(X_ML_.t, config_.max_range_m);
    return result.matched > 0 || (empty_map && !map_points_L.empty());
  }

  KissIcpConfig config_;
  double voxel_m_;
  Pose X_RL_;
  kiss::AdaptiveThreshold threshold_;
  kiss::VoxelHashMap local_map_;
  std::vector<Eigen::Vector3d> points_L_;  ///< of the newest scan, deskewed
  Pose X_ML_;
  Pose motion_;               ///< of L between the last two scans
  Nanoseconds interval_ = 0;  ///< that it took
};

}  // namespace

std::unique_ptr<Method> make_kiss_icp(const MethodInput& input, const KissIcpConfig& config) {
  if (config.map_voxel_m() < least_voxel_m) {
    const Tree* voxel = input.config.is_null() ? nullptr : input.config.find("voxel_m");
    throw InputError(voxel == nullptr ? Mark{} : voxel->mark,
                     "voxel_m is 0, for a hundredth of max_range_m, or at least 0.01");
  }
  return std::make_unique<KissIcp>(input, config);
}

}  // namespace plumbline::slam
