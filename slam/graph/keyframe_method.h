// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/graph/graph.h"
#include "slam/io/method.h"
#include "slam/io/stopwatch.h"
#include "slam/scan/map_cloud.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Times and digests of the stages of one scan, one after the other.
class ScanStages {
 public:
  explicit ScanStages(Output& output) : output_(output) {}
  /// A stage is over, the next one begins.
  void end(const char* stage);
  void end(const char* stage, std::uint64_t digest);
  /// A digest of what is no stage.
  void add(const char* name, std::uint64_t digest) { output_.digests.push_back({name, digest}); }

 private:
  Output& output_;
  Stopwatch stopwatch_;
};

/// Where a scan is.
struct ScanPlacement {
  Pose X_OR;  ///< by odometry, in the frame of the keyframes' X_OR
  bool lost = false;
  int degenerate_directions = 0;  ///< as in Output
};

/// SLAM by a graph of keyframes with LiDAR alone, scans as they are: the pose of each scan hangs on the newest keyframe
/// and moves with it, and some scans make the map from where they are at the end. The first scan must become a
/// keyframe.
class KeyframeMethod : public Method {
 public:
  KeyframeMethod(const Calibration& calibration, const MapCloudConfig& map, bool has_loops)
      : calibration_(calibration), map_config_(map), map_(map), has_loops_(has_loops) {
    still_.add({0, Pose()});
  }

  [[nodiscard]] Output on_scan(const Scan& scan) final;
  [[nodiscard]] Estimate finish() final;

 protected:
  /// The pose of a scan; may add keyframes and factors to graph().
  [[nodiscard]] virtual ScanPlacement track(const Scan& raw, ScanStages& stages) = 0;
  /// Puts the scan that is being tracked into the map.
  void keep(const DeskewedScan& scan);
  /// The same where the last one in it is far enough from X_MR.
  void keep_if_far(const DeskewedScan& scan, const Pose& X_MR);
  /// The scan as if the robot had stood still.
  [[nodiscard]] DeskewedScan not_deskewed(const Scan& raw) const { return deskew(raw, still_, calibration_); }
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  [[nodiscard]] Graph& graph() { return graph_; }
  [[nodiscard]] const Graph& graph() const { return graph_; }

 private:
  struct TrackedScan {
    Nanoseconds stamp = 0;
    std::size_t keyframe = 0;
    Pose X_OR;
  };
  [[nodiscard]] Pose corrected(const TrackedScan& scan) const;

  Calibration calibration_;
  MapCloudConfig map_config_;
  MapCloudRecorder map_;
  bool has_loops_;
  MotionBuffer still_;
  Graph graph_;
  std::vector<TrackedScan> scans_;
  std::vector<std::size_t> map_scans_;  ///< of each keyframe of the map, its scan
};

}  // namespace plumbline::slam
