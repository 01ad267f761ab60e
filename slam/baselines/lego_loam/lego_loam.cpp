// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/lego_loam.h"

#include <cmath>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "slam/graph/graph_json.h"
#include "slam/io/stopwatch.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

namespace lego {

namespace {

/// A longer step is none, and M ends there.
constexpr double longest_step_m = 10.0, farthest_m = 1e5;

std::vector<Eigen::Vector3d> places(const std::vector<FormerPoint>& points) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const FormerPoint& point : points) result.push_back(point.p);
  return result;
}

/// Variances of the reference's factors: rotation 1e-6, translation 1e-8 across and 1e-6 along the way.
Matrix6d step_information() {
  Vector6d information;
  information << 1e6, 1e8, 1e8, 1e6, 1e6, 1e6;
  return information.asDiagonal();
}

class LegoLoam final : public Method {
 public:
  LegoLoam(const MethodInput& input, const LegoLoamConfig& config)
      : config_(config), calibration_(input.calibration), map_(config.submap), cloud_(config.map) {
    still_.add({0, Pose()});
  }

  [[nodiscard]] Output on_scan(const Scan& scan) override;
  [[nodiscard]] Estimate finish() override;

 private:
  struct TrackedScan {
    Nanoseconds stamp = 0;
    std::size_t keyframe = 0;
    Pose X_KR;  ///< in the last keyframe
  };

  [[nodiscard]] bool advance(const Features& features);
  void refine(Nanoseconds stamp, const std::vector<FormerPoint>& outliers);
  void add_keyframe(Nanoseconds stamp, loam::MapFeatures features);
  void close_loop();

  LegoLoamConfig config_;
  Calibration calibration_;
  MotionBuffer still_;
  FormerScan former_;
  Motion motion_;
  Pose X_MR_;
  int degenerate_ = 0;
  Nanoseconds mapped_ = 0;
  loam::KeyframeMap map_;
  std::vector<Nanoseconds> keyframe_stamps_;
  Graph graph_;
  std::vector<TrackedScan> scans_;
  MapCloudRecorder cloud_;
  std::vector<std::size_t> cloud_scans_;
};

/// False where the scan does not tell the motion.
bool LegoLoam::advance(const Features& features) {
  const bool first = scans_.empty();
  const TwoStepResult found = two_step(features, former_, motion_, config_.odometry);
  degenerate_ = found.degenerate;
  const Pose X_LR = found.motion.at(1.0);
  const Pose moved = X_MR_ * X_LR;
  const bool told = found.by_ground && found.by_edges && X_LR.t.norm() < longest_step_m && moved.t.norm() < farthest_m;
  motion_ = told ? found.motion : Motion();
  if (told) X_MR_ = moved;
  X_MR_.q.normalize();
  former_ = {at_end(features.less_sharp, motion_), at_end(features.less_flat, motion_)};
  return told || first;
}

void LegoLoam::refine(Nanoseconds stamp, const std::vector<FormerPoint>& outliers) {
  if (!keyframe_stamps_.empty() && seconds(stamp - mapped_) < config_.mapping_s) return;
  mapped_ = stamp;
  loam::MapFeatures features{places(former_.edges), places(former_.flats)};
  const std::vector<Eigen::Vector3d> more = places(outliers);
  features.flats_R.insert(features.flats_R.end(), more.begin(), more.end());
  features = loam::thinned(features, config_.submap);
  if (map_.size() > 0) {
    const loam::MapAlignment found = map_.align(features, X_MR_);
    if (found.found && (found.X_MR.t - X_MR_.t).norm() < longest_step_m) {
      X_MR_ = found.X_MR;
      degenerate_ = found.degenerate;
    }
    if ((map_.pose(map_.size() - 1).t - X_MR_.t).norm() < config_.keyframe_distance_m) return;
  }
  add_keyframe(stamp, std::move(features));
}

void LegoLoam::add_keyframe(Nanoseconds stamp, loam::MapFeatures features) {
  if (map_.size() > 0) {
    const int last = static_cast<int>(map_.size()) - 1;
    graph_.pose_factors.push_back(
        {last, last + 1, map_.pose(map_.size() - 1).inverse() * X_MR_, step_information(), false});
  }
  map_.add(X_MR_, std::move(features));
  keyframe_stamps_.push_back(stamp);
  graph_.keyframes.push_back({stamp, X_MR_, X_MR_, 0});
  if (config_.loop.on && map_.size() > 1) close_loop();
}

// Without a loop the chain of factors is solved by its own values.
void LegoLoam::close_loop() {
  const std::optional<Loop> loop = find_loop(map_, keyframe_stamps_, config_.loop);
  if (!loop) return;
  graph_.pose_factors.push_back({static_cast<int>(loop->keyframe), static_cast<int>(map_.size()) - 1, loop->X_FT,
                                 Matrix6d::Identity() / std::max(loop->fitness_m2, 1e-6), true});
  optimize(graph_, 1, config_.optimizer);
  for (std::size_t k = 0; k < map_.size(); ++k) map_.set_pose(k, graph_.keyframes[k].X_MR);
  X_MR_ = graph_.keyframes.back().X_MR;
}

Output LegoLoam::on_scan(const Scan& scan) {
  Output output;
  output.stamp = scan.stamp;
  Stopwatch stopwatch;
  const auto record = [&](const char* stage, std::uint64_t digest) {
    output.times.push_back({stage, stopwatch.cpu_ms()});
    output.digests.push_back({stage, digest});
    stopwatch.restart();
  };
  const SegmentedCloud cloud = segmented_cloud(scan, calibration_.X_RL, config_.image);
  const Features features = find_features(cloud, config_.features);
  record("features", Digest()
                         .add(static_cast<std::int64_t>(features.less_sharp.size()))
                         .add(static_cast<std::int64_t>(features.less_flat.size()))
                         .value());
  const bool told = advance(features);
  record("odometry", Digest().add(X_MR_).value());
  if (!told) output.state = State::lost;
  if (told) refine(scan.stamp, at_end(cloud.outliers, motion_));
  record("mapping", Digest().add(X_MR_).add(static_cast<std::int64_t>(map_.size())).value());
  output.X_FR = X_MR_;
  output.degenerate_directions = degenerate_;
  const std::size_t keyframe = map_.size() > 0 ? map_.size() - 1 : 0;
  scans_.push_back({scan.stamp, keyframe, map_.size() > 0 ? map_.pose(keyframe).inverse() * X_MR_ : X_MR_});
  if (told && cloud_.add(deskew(scan, still_, calibration_), X_MR_)) cloud_scans_.push_back(scans_.size() - 1);
  return output;
}

Estimate LegoLoam::finish() {
  Estimate estimate;
  for (const TrackedScan& scan : scans_)
    estimate.trajectory.push_back({scan.stamp, map_.size() > 0 ? map_.pose(scan.keyframe) * scan.X_KR : scan.X_KR});
  std::vector<CloudKeyframe> clouds(cloud_.keyframes().begin(), cloud_.keyframes().end());
  for (std::size_t k = 0; k < clouds.size(); ++k) clouds[k].X_FR = estimate.trajectory[cloud_scans_[k]].X_FR;
  estimate.map_F = map_cloud(clouds, config_.map);
  if (config_.loop.on) estimate.loops = loop_edges(graph_);
  if (!graph_.keyframes.empty()) estimate.graph = graph_tree(graph_);
  return estimate;
}

}  // namespace

}  // namespace lego

std::unique_ptr<Method> make_lego_loam(const MethodInput& input, const LegoLoamConfig& config) {
  return std::make_unique<lego::LegoLoam>(input, config);
}

}  // namespace plumbline::slam
