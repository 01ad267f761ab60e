// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/hdl_slam_paper.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "slam/graph/graph_json.h"
#include "slam/io/stopwatch.h"
#include "slam/scan/kd_tree.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace hdl {

namespace {

std::vector<Eigen::Vector3d> prefiltered(const DeskewedScan& scan, const PrefilterConfig& config) {
  std::vector<Eigen::Vector3d> points_R;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] >= config.min_range_m && scan.range_m[i] <= config.max_range_m)
      points_R.push_back(scan.point_R[i]);
  points_R = voxel_downsample(points_R, config.voxel_m);
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

class HdlSlamPaper final : public Method {
 public:
  HdlSlamPaper(const MethodInput& input, const HdlSlamPaperConfig& config)
      : config_(config),
        calibration_(input.calibration),
        height_m_(input.calibration.sensor_height_m - input.calibration.X_RL.t.z()),
        odometry_(config),
        loop_matcher_(make_matcher(config)) {
    still_.add({0, Pose()});
  }

  [[nodiscard]] Output on_scan(const Scan& raw) override;
  [[nodiscard]] Estimate finish() override;

 private:
  struct TrackedScan {
    Nanoseconds stamp = 0;
    std::size_t keyframe = 0;
    Pose X_OR;
  };

  [[nodiscard]] bool keyframe_is_due() const;
  void add_keyframe(const DeskewedScan& scan, std::vector<Eigen::Vector3d> points_R, Output& output);
  void add_vertex(Nanoseconds stamp, const std::vector<Eigen::Vector3d>& points_R, const std::optional<Plane>& floor_R);
  void tie_to_floor(const std::optional<Plane>& floor_R);
  void close_loop();
  [[nodiscard]] Pose corrected(const TrackedScan& scan) const {
    const KeyframeVertex& keyframe = graph_.keyframes[scan.keyframe];
    return keyframe.X_MR * keyframe.X_OR.inverse() * scan.X_OR;
  }

  HdlSlamPaperConfig config_;
  Calibration calibration_;
  double height_m_;  ///< of R above the floor
  MotionBuffer still_;
  Odometry odometry_;
  std::unique_ptr<CloudMatcher> loop_matcher_;
  Graph graph_;
  std::vector<TrackedScan> scans_;
  std::deque<std::vector<Eigen::Vector3d>> clouds_R_;  ///< index = keyframe; a deque, since loops point at them
  std::vector<LoopKeyframe> loop_keyframes_;           ///< index = keyframe
  double last_loop_m_ = 0.0;
  std::vector<CloudKeyframe> map_;
  std::vector<std::size_t> map_scans_;
};

bool HdlSlamPaper::keyframe_is_due() const {
  if (graph_.keyframes.empty()) return true;
  const Pose step = graph_.keyframes.back().X_OR.inverse() * odometry_.X_OR();
  return step.t.norm() >= config_.keyframe_distance_m || log_so3(step.q).norm() >= config_.keyframe_angle_rad;
}

Output HdlSlamPaper::on_scan(const Scan& raw) {
  Output output;
  output.stamp = raw.stamp;
  Stopwatch stopwatch;
  const auto record = [&](const char* stage, std::uint64_t digest) {
    output.times.push_back({stage, stopwatch.cpu_ms()});
    output.digests.push_back({stage, digest});
    stopwatch.restart();
  };
  const DeskewedScan scan = deskew(raw, still_, calibration_);
  std::vector<Eigen::Vector3d> points_R = prefiltered(scan, config_.prefilter);
  record("prefilter", Digest().add(static_cast<std::int64_t>(points_R.size())).value());
  const bool tracked = odometry_.advance(points_R);
  record("odometry", Digest().add(odometry_.X_OR()).value());
  if (!tracked) output.state = State::lost;
  if (graph_.keyframes.empty() || (tracked && keyframe_is_due())) add_keyframe(scan, std::move(points_R), output);
  scans_.push_back({raw.stamp, graph_.keyframes.size() - 1, odometry_.X_OR()});
  output.X_FR = corrected(scans_.back());
  return output;
}

void HdlSlamPaper::add_keyframe(const DeskewedScan& scan, std::vector<Eigen::Vector3d> points_R, Output& output) {
  Stopwatch stopwatch;
  const std::optional<Plane> floor_R =
      config_.floor.on ? detect_floor(points_R, height_m_, config_.floor) : std::nullopt;
  output.times.push_back({"floor", stopwatch.cpu_ms()});
  stopwatch.restart();
  add_vertex(scan.stamp, points_R, floor_R);
  tie_to_floor(floor_R);
  clouds_R_.push_back(std::move(points_R));
  map_.push_back({Pose(), thin_scan(scan, config_.map), {}});
  map_scans_.push_back(scans_.size());
  close_loop();
  output.times.push_back({"loop_closure", stopwatch.cpu_ms()});
  stopwatch.restart();
  if (graph_.keyframes.size() > 1) optimize(graph_, 1, config_.optimizer);
  output.times.push_back({"back_end", stopwatch.cpu_ms()});
  output.digests.push_back({"graph", digest_of(graph_)});
}

void HdlSlamPaper::add_vertex(Nanoseconds stamp, const std::vector<Eigen::Vector3d>& points_R,
                              const std::optional<Plane>& floor_R) {
  const Pose& X_OR = odometry_.X_OR();
  if (graph_.keyframes.empty()) {
    // M is level by the first floor, so that the one floor plane is, too.
    Pose X_MR;
    if (floor_R) X_MR.q = Eigen::Quaterniond::FromTwoVectors(floor_R->n, Eigen::Vector3d::UnitZ());
    graph_.keyframes.push_back({stamp, X_MR, X_OR, 0});
    PlaneVertex floor;
    floor.plane_M = {Eigen::Vector3d::UnitZ(), floor_R ? floor_R->d : height_m_};
    floor.kind = PlaneKind::floor;
    floor.fixed = true;
    graph_.planes.push_back(floor);
    return;
  }
  const KeyframeVertex& last = graph_.keyframes.back();
  const Pose step = last.X_OR.inverse() * X_OR;
  PoseFactor factor{static_cast<int>(graph_.keyframes.size()) - 1, static_cast<int>(graph_.keyframes.size()), step};
  const std::vector<Eigen::Vector3d>& before_R = clouds_R_.back();
  if (!before_R.empty() && !points_R.empty())
    factor.information = fitness_information(fitness(before_R, points_R, step), config_.weights);
  graph_.pose_factors.push_back(factor);
  graph_.keyframes.push_back({stamp, last.X_MR * step, X_OR, 0});
}

void HdlSlamPaper::tie_to_floor(const std::optional<Plane>& floor_R) {
  if (!floor_R || graph_.keyframes.size() < 2) return;
  graph_.plane_factors.push_back({static_cast<int>(graph_.keyframes.size()) - 1, 0, *floor_R,
                                  config_.floor.information * Eigen::Matrix3d::Identity()});
}

void HdlSlamPaper::close_loop() {
  const Pose& X_MR = graph_.keyframes.back().X_MR;
  double walked_m = 0.0;
  if (!loop_keyframes_.empty()) walked_m = loop_keyframes_.back().walked_m + graph_.pose_factors.back().X_FT.t.norm();
  // Where earlier keyframes are now.
  for (std::size_t k = 0; k < loop_keyframes_.size(); ++k) loop_keyframes_[k].X_MR = graph_.keyframes[k].X_MR;
  loop_keyframes_.push_back({X_MR, walked_m, &clouds_R_.back()});
  if (!config_.loop.on) return;
  const std::optional<HdlLoop> loop = detect_loop(loop_keyframes_, last_loop_m_, config_.loop, *loop_matcher_);
  if (!loop) return;
  last_loop_m_ = walked_m;
  graph_.pose_factors.push_back({static_cast<int>(loop->keyframe), static_cast<int>(graph_.keyframes.size()) - 1,
                                 loop->X_FT, fitness_information(loop->fitness_m2, config_.weights), true});
}

Estimate HdlSlamPaper::finish() {
  Estimate estimate;
  for (const TrackedScan& scan : scans_) estimate.trajectory.push_back({scan.stamp, corrected(scan)});
  for (std::size_t k = 0; k < map_.size(); ++k) map_[k].X_FR = estimate.trajectory[map_scans_[k]].X_FR;
  estimate.map_F = map_cloud(map_, config_.map);
  if (config_.loop.on) estimate.loops = loop_edges(graph_);
  if (!graph_.keyframes.empty()) estimate.graph = graph_tree(graph_);
  return estimate;
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
