// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/hdl_slam_paper.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "bim/geometry/best_rotation.h"
#include "slam/graph/keyframe_method.h"
#include "slam/scan/kd_tree.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace hdl {

namespace {

std::vector<Eigen::Vector3d> prefiltered(const DeskewedScan& scan, const PrefilterConfig& config) {
  std::vector<Eigen::Vector3d> points_R =
      voxel_downsample(points_between(scan, config.min_range_m, config.max_range_m), config.voxel_m);
  if (config.outlier_neighbours == 0) return points_R;
  const KdTree tree(points_R);
  const auto count = static_cast<std::size_t>(config.outlier_neighbours) + 1;  // itself besides
  std::erase_if(points_R, [&](const Eigen::Vector3d& p) {
    const auto near = tree.nearest(p, count);
    return near.size() < count || near.back().distance2 > config.outlier_m * config.outlier_m;
  });
  return points_R;
}

std::unique_ptr<CloudMatcher> make_matcher(const HdlSlamPaperConfig& config) {
  return config.odometry.registration == Registration::ndt ? make_ndt(config.ndt) : make_gicp(config.gicp);
}

/// Each scan is matched with one keyframe's, from where the last one was.
class Odometry {
 public:
  explicit Odometry(const HdlSlamPaperConfig& config) : config_(config.odometry), matcher_(make_matcher(config)) {}

  /// False where nothing of the scan lies near the keyframe: the last pose stands.
  bool advance(const std::vector<Eigen::Vector3d>& points_R) {
    if (!begun_) {
      begun_ = !points_R.empty();
      if (begun_) matcher_->set_target(points_R);
      return begun_;
    }
    const CloudMatch match = matcher_->match(points_R, X_KR_);
    if (!match.converged || !(match.X_TS.t.norm() < farthest_m)) return false;
    X_KR_ = match.X_TS;
    X_OR_ = X_OK_ * X_KR_;
    X_OR_.q.normalize();
    if (!odometry_keyframe_is_due(X_KR_, config_)) return true;
    matcher_->set_target(points_R);
    X_OK_ = X_OR_;
    X_KR_ = Pose();
    return true;
  }

  [[nodiscard]] const Pose& X_OR() const { return X_OR_; }

 private:
  /// From a keyframe; farther it has diverged.
  static constexpr double farthest_m = 100.0;

  OdometryConfig config_;
  std::unique_ptr<CloudMatcher> matcher_;
  bool begun_ = false;
  Pose X_OK_, X_KR_, X_OR_;
};

class HdlSlamPaper final : public KeyframeMethod {
 public:
  HdlSlamPaper(const MethodInput& input, const HdlSlamPaperConfig& config)
      : KeyframeMethod(input.calibration, config.map, config.loop.on),
        config_(config),
        height_m_(input.calibration.sensor_height_m - input.calibration.X_RL.t.z()),
        odometry_(config),
        loop_matcher_(make_matcher(config)) {}

 private:
  [[nodiscard]] ScanPlacement track(const Scan& raw, ScanStages& stages) override;
  [[nodiscard]] bool keyframe_is_due() const;
  void add_keyframe(const DeskewedScan& scan, std::vector<Eigen::Vector3d> points_R, ScanStages& stages);
  void add_vertex(Nanoseconds stamp, const std::vector<Eigen::Vector3d>& points_R, const std::optional<Plane>& floor_R);
  void tie_to_floor(const std::optional<Plane>& floor_R);
  void close_loop();

  HdlSlamPaperConfig config_;
  double height_m_;  ///< of R above the floor
  Odometry odometry_;
  std::unique_ptr<CloudMatcher> loop_matcher_;
  std::deque<std::vector<Eigen::Vector3d>> clouds_R_;  ///< index = keyframe; a deque, since loops point at them
  std::vector<LoopKeyframe> loop_keyframes_;           ///< index = keyframe
  double last_loop_m_ = 0.0;
};

bool HdlSlamPaper::keyframe_is_due() const {
  if (graph().keyframes.empty()) return true;
  const Pose step = graph().keyframes.back().X_OR.inverse() * odometry_.X_OR();
  return step.t.norm() >= config_.keyframe_distance_m || log_so3(step.q).norm() >= config_.keyframe_angle_rad;
}

ScanPlacement HdlSlamPaper::track(const Scan& raw, ScanStages& stages) {
  const DeskewedScan scan = not_deskewed(raw);
  std::vector<Eigen::Vector3d> points_R = prefiltered(scan, config_.prefilter);
  stages.end("prefilter", Digest().add(static_cast<std::int64_t>(points_R.size())).value());
  const bool tracked = odometry_.advance(points_R);
  stages.end("odometry", Digest().add(odometry_.X_OR()).value());
  if (graph().keyframes.empty() || (tracked && keyframe_is_due())) add_keyframe(scan, std::move(points_R), stages);
  return {.X_OR = odometry_.X_OR(), .lost = !tracked};
}

void HdlSlamPaper::add_keyframe(const DeskewedScan& scan, std::vector<Eigen::Vector3d> points_R, ScanStages& stages) {
  const std::optional<Plane> floor_R =
      config_.floor.on ? detect_floor(points_R, height_m_, config_.floor) : std::nullopt;
  stages.end("floor");
  add_vertex(scan.stamp, points_R, floor_R);
  tie_to_floor(floor_R);
  clouds_R_.push_back(std::move(points_R));
  keep(scan);
  close_loop();
  stages.end("loop_closure");
  if (graph().keyframes.size() > 1) optimize(graph(), 1, config_.optimizer);
  stages.end("back_end");
  stages.add("graph", digest_of(graph()));
}

void HdlSlamPaper::add_vertex(Nanoseconds stamp, const std::vector<Eigen::Vector3d>& points_R,
                              const std::optional<Plane>& floor_R) {
  const Pose& X_OR = odometry_.X_OR();
  if (graph().keyframes.empty()) {
    // M is level by the first floor, so that the one floor plane is, too.
    Pose X_MR;
    if (floor_R) X_MR.q = rotation_between(floor_R->n, Eigen::Vector3d::UnitZ());
    graph().keyframes.push_back({stamp, X_MR, X_OR, 0});
    PlaneVertex floor;
    floor.plane_M = {Eigen::Vector3d::UnitZ(), floor_R ? floor_R->d : height_m_};
    floor.kind = PlaneKind::floor;
    floor.fixed = true;
    graph().planes.push_back(floor);
    return;
  }
  const KeyframeVertex& last = graph().keyframes.back();
  const Pose step = last.X_OR.inverse() * X_OR;
  PoseFactor factor{static_cast<int>(graph().keyframes.size()) - 1, static_cast<int>(graph().keyframes.size()), step};
  const std::vector<Eigen::Vector3d>& before_R = clouds_R_.back();
  if (!before_R.empty() && !points_R.empty())
    factor.information = fitness_information(fitness(before_R, points_R, step), config_.weights);
  graph().pose_factors.push_back(factor);
  graph().keyframes.push_back({stamp, last.X_MR * step, X_OR, 0});
}

void HdlSlamPaper::tie_to_floor(const std::optional<Plane>& floor_R) {
  if (!floor_R || graph().keyframes.size() < 2) return;
  graph().plane_factors.push_back({static_cast<int>(graph().keyframes.size()) - 1, 0, *floor_R,
                                   config_.floor.information * Eigen::Matrix3d::Identity()});
}

void HdlSlamPaper::close_loop() {
  const Pose& X_MR = graph().keyframes.back().X_MR;
  double walked_m = 0.0;
  if (!loop_keyframes_.empty()) walked_m = loop_keyframes_.back().walked_m + graph().pose_factors.back().X_FT.t.norm();
  // Where earlier keyframes are now.
  for (std::size_t k = 0; k < loop_keyframes_.size(); ++k) loop_keyframes_[k].X_MR = graph().keyframes[k].X_MR;
  loop_keyframes_.push_back({X_MR, walked_m, &clouds_R_.back()});
  if (!config_.loop.on) return;
  const std::optional<HdlLoop> loop = detect_loop(loop_keyframes_, last_loop_m_, config_.loop, *loop_matcher_);
  if (!loop) return;
  last_loop_m_ = walked_m;
  graph().pose_factors.push_back({static_cast<int>(loop->keyframe), static_cast<int>(graph().keyframes.size()) - 1,
                                  loop->X_FT, fitness_information(loop->fitness_m2, config_.weights), true});
}

}  // namespace

bool odometry_keyframe_is_due(const Pose& step, const OdometryConfig& config) {
  const double half_angle = std::acos(std::clamp(std::abs(step.q.w()), 0.0, 1.0));
  return step.t.norm() > config.keyframe_distance_m || half_angle > config.keyframe_half_angle_rad;
}

}  // namespace hdl

std::unique_ptr<Method> make_hdl_slam_paper(const MethodInput& input, const HdlSlamPaperConfig& config) {
  return std::make_unique<hdl::HdlSlamPaper>(input, config);
}

}  // namespace plumbline::slam
