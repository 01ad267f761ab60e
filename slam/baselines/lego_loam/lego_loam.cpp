// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/lego_loam.h"

#include <cmath>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "slam/graph/keyframe_method.h"

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

/// Variances of the reference's factors: rotation 1e-6, translation 1e-8 forward and to the left and 1e-6 upwards.
Matrix6d step_information() {
  Vector6d information;
  information << 1e8, 1e8, 1e6, 1e6, 1e6, 1e6;
  return information.asDiagonal();
}

class LegoLoam final : public KeyframeMethod {
 public:
  LegoLoam(const MethodInput& input, const LegoLoamConfig& config)
      : KeyframeMethod(input.calibration, config.map, config.loop.on),
        config_(config),
        beams_(config.beam_model),
        map_(config.submap) {}

 private:
  [[nodiscard]] ScanPlacement track(const Scan& scan, ScanStages& stages) override;
  [[nodiscard]] bool advance(const Features& features);
  [[nodiscard]] bool refine(Nanoseconds stamp, const std::vector<FormerPoint>& outliers, bool told);
  void add_keyframe(Nanoseconds stamp, loam::MapFeatures features);
  void close_loop();

  LegoLoamConfig config_;
  BeamsOfRecording beams_;
  FormerScan former_;
  Motion motion_;
  Pose X_MR_;
  int degenerate_ = 0;
  Nanoseconds mapped_ = 0;
  loam::KeyframeMap map_;
  std::vector<Nanoseconds> keyframe_stamps_;
};

/// The motion that one step alone tells is made; what the other one should tell stands.
Motion told_of(const TwoStepResult& found) {
  Motion motion;
  if (found.by_ground) {
    motion.rpy.head<2>() = found.motion.rpy.head<2>();
    motion.t.z() = found.motion.t.z();
  }
  if (found.by_edges) {
    motion.rpy.z() = found.motion.rpy.z();
    motion.t.head<2>() = found.motion.t.head<2>();
  }
  return motion;
}

/// False where the scan does not tell all of the motion.
bool LegoLoam::advance(const Features& features) {
  const bool first = keyframe_stamps_.empty();
  const TwoStepResult found = two_step(features, former_, motion_, config_.odometry);
  degenerate_ = found.degenerate;
  const Motion motion = told_of(found);
  const Pose moved = X_MR_ * motion.at(1.0);
  const bool possible = motion.t.norm() < longest_step_m && moved.t.norm() < farthest_m;
  motion_ = possible ? motion : Motion();
  if (possible) X_MR_ = moved;
  X_MR_.q.normalize();
  former_ = {at_end(features.less_sharp, motion_), at_end(features.less_flat, motion_)};
  return first || (possible && found.by_ground && found.by_edges);
}

/// False where the map does not tell the pose, or is not asked. It gets no scan whose pose nothing told.
bool LegoLoam::refine(Nanoseconds stamp, const std::vector<FormerPoint>& outliers, bool told) {
  if (!keyframe_stamps_.empty() && seconds(stamp - mapped_) < config_.mapping_s) return false;
  mapped_ = stamp;
  loam::MapFeatures features{places(former_.edges), places(former_.flats)};
  const std::vector<Eigen::Vector3d> more = places(outliers);
  features.flats_R.insert(features.flats_R.end(), more.begin(), more.end());
  features = loam::thinned(features, config_.submap);
  bool matched = false;
  if (map_.size() > 0) {
    const loam::MapAlignment found = map_.align(features, X_MR_);
    matched = found.found && (found.X_MR.t - X_MR_.t).norm() < longest_step_m;
    if (matched) {
      X_MR_ = found.X_MR;
      degenerate_ = found.degenerate;
    }
    if ((map_.pose(map_.size() - 1).t - X_MR_.t).norm() < config_.keyframe_distance_m) return matched;
  }
  if (told || matched) add_keyframe(stamp, std::move(features));
  return matched;
}

void LegoLoam::add_keyframe(Nanoseconds stamp, loam::MapFeatures features) {
  if (map_.size() > 0) {
    const int last = static_cast<int>(map_.size()) - 1;
    graph().pose_factors.push_back(
        {last, last + 1, map_.pose(map_.size() - 1).inverse() * X_MR_, step_information(), false});
  }
  map_.add(X_MR_, std::move(features));
  keyframe_stamps_.push_back(stamp);
  graph().keyframes.push_back({stamp, X_MR_, X_MR_, 0});
  if (config_.loop.on && map_.size() > 1) close_loop();
}

// Without a loop the chain of factors is solved by its own values.
void LegoLoam::close_loop() {
  const std::optional<Loop> loop = find_loop(map_, keyframe_stamps_, config_.loop);
  if (!loop) return;
  graph().pose_factors.push_back({static_cast<int>(loop->keyframe), static_cast<int>(map_.size()) - 1, loop->X_FT,
                                  Matrix6d::Identity() / std::max(loop->fitness_m2, 1e-6), true});
  optimize(graph(), 1, config_.optimizer);
  for (std::size_t k = 0; k < map_.size(); ++k) map_.set_pose(k, graph().keyframes[k].X_MR);
  X_MR_ = graph().keyframes.back().X_MR;
}

ScanPlacement LegoLoam::track(const Scan& scan, ScanStages& stages) {
  const SegmentedCloud cloud = segmented_cloud(scan, calibration().X_RL, config_.image, beams_.of(scan));
  const Features features = find_features(cloud, config_.features);
  stages.end("features", Digest()
                             .add(static_cast<std::int64_t>(features.less_sharp.size()))
                             .add(static_cast<std::int64_t>(features.less_flat.size()))
                             .value());
  const bool told = advance(features);
  stages.end("odometry", Digest().add(X_MR_).value());
  const bool matched = refine(scan.stamp, at_end(cloud.outliers, motion_), told);
  const bool placed = told || matched;
  if (placed) keep_if_far(not_deskewed(scan), X_MR_);
  stages.end("mapping", Digest().add(X_MR_).add(static_cast<std::int64_t>(map_.size())).value());
  // Keyframes keep the pose that they had at first as X_OR.
  const KeyframeVertex& last = graph().keyframes.back();
  return {.X_OR = last.X_OR * last.X_MR.inverse() * X_MR_, .lost = !placed, .degenerate_directions = degenerate_};
}

}  // namespace

}  // namespace lego

std::unique_ptr<Method> make_lego_loam(const MethodInput& input, const LegoLoamConfig& config) {
  return std::make_unique<lego::LegoLoam>(input, config);
}

}  // namespace plumbline::slam
