// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/keyframe_method.h"

#include "slam/graph/graph_json.h"

namespace plumbline::slam {

void ScanStages::end(const char* stage) {
  output_.times.push_back({stage, stopwatch_.cpu_ms()});
  stopwatch_.restart();
}

void ScanStages::end(const char* stage, std::uint64_t digest) {
  add(stage, digest);
  end(stage);
}

Output KeyframeMethod::on_scan(const Scan& scan) {
  Output output;
  output.stamp = scan.stamp;
  ScanStages stages(output);
  const ScanPlacement tracked = track(scan, stages);
  scans_.push_back({scan.stamp, graph_.keyframes.size() - 1, tracked.X_OR});
  output.X_FR = corrected(scans_.back());
  if (tracked.lost) output.state = State::lost;
  output.degenerate_directions = tracked.degenerate_directions;
  return output;
}

Pose KeyframeMethod::corrected(const TrackedScan& scan) const {
  const KeyframeVertex& keyframe = graph_.keyframes[scan.keyframe];
  return keyframe.X_MR * keyframe.X_OR.inverse() * scan.X_OR;
}

void KeyframeMethod::keep(const DeskewedScan& scan) {
  map_.keep(scan, Pose());
  map_scans_.push_back(scans_.size());
}

void KeyframeMethod::keep_if_far(const DeskewedScan& scan, const Pose& X_MR) {
  if (map_.add(scan, X_MR)) map_scans_.push_back(scans_.size());
}

Estimate KeyframeMethod::finish() {
  Estimate estimate;
  for (const TrackedScan& scan : scans_) estimate.trajectory.push_back({scan.stamp, corrected(scan)});
  std::vector<CloudKeyframe> clouds(map_.keyframes().begin(), map_.keyframes().end());
  for (std::size_t k = 0; k < clouds.size(); ++k) clouds[k].X_FR = estimate.trajectory[map_scans_[k]].X_FR;
  estimate.map_F = map_cloud(clouds, map_config_);
  if (has_loops_) estimate.loops = loop_edges(graph_);
  if (!graph_.keyframes.empty()) estimate.graph = graph_tree(graph_);
  return estimate;
}

}  // namespace plumbline::slam
