// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "bim/model/building_options.h"
#include "slam/io/method.h"

namespace plumbline::slam {

/// Where the LiDAR sits, in R.
struct MountSpec {
  std::vector<double> position_m = {0.0, 0.0, 0.0};
  std::vector<double> quaternion_xyzw = {0.0, 0.0, 0.0, 1.0};
  std::optional<double> height_m;
  template <class V>
  void visit(V& v) {
    v("position_m", position_m, Field{.doc = "origin of the LiDAR in the robot's frame, m: [x, y, z]"});
    v("quaternion_xyzw", quaternion_xyzw,
      Field{.doc = "attitude of the LiDAR in the robot's frame: [x, y, z, w], x forward, z up"});
    v("height_m", height_m,
      Field{.doc = "height of the LiDAR above the floor when the robot stands, m; measured by the first scans when not "
                   "given",
            .min = 0.0,
            .max = 100.0});
  }
};

/// How the packets become scans.
struct MessageSpec {
  std::optional<int> packets_per_message;
  bool vertical_offsets = true;
  double period_s = 0.1;
  template <class V>
  void visit(V& v) {
    v("packets_per_message", packets_per_message,
      Field{.doc = "one turn, rounded up, as drivers split it; found from the packets when not given",
            .min = 1,
            .max = 2000});
    v("vertical_offsets", vertical_offsets, Field{.doc = "lasers start up to 11.2 mm above or below the origin"});
    v("period_s", period_s,
      Field{.doc = "seconds from one cloud to the next, for a folder of clouds, which have no stamps",
            .min = 0.001,
            .max = 60.0});
  }
};

/// The robot's prior at the start.
struct RecordingPrior {
  std::optional<double> yaw_rad;
  double yaw_sigma_rad = 0.05;
  std::optional<std::string> storey;
  template <class V>
  void visit(V& v) {
    v("yaw_rad", yaw_rad, Field{.doc = "compass: heading in the plan at the start, rad", .min = -7.0, .max = 7.0});
    v("yaw_sigma_rad", yaw_sigma_rad, Field{.doc = "standard deviation of the compass, rad", .min = 1e-4, .max = 7.0});
    v("storey", storey, Field{.doc = "storey of the start"});
  }
};

/// recording.yaml: what a recording's owner knows besides the sensors' records. No truth.
struct RecordingInfo {
  int version = 1;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> walk;
  MessageSpec lidar;
  MountSpec mount;
  RecordingPrior prior;
  bim::BuildingOptions plan;
  template <class V>
  void visit(V& v) {
    v("recording", version, Field{.doc = "version of this format", .min = 1, .max = 1, .required = true});
    v("seed", seed, Field{.doc = "of the run, from which those of the methods derive", .min = 0, .max = 9.2e18});
    v("walk", walk, Field{.doc = "digest of the simulated sensors' records, by which runs recognise their estimates"});
    v("lidar", lidar, Field{.doc = "how packets become scans"});
    v("mount", mount, Field{.doc = "where the LiDAR sits"});
    v("prior", prior, Field{.doc = "the prior of plan localization", .former = "told"});
    v("plan", plan, Field{.doc = "how the plan is taken, as the run had it"});
  }
};

/// Throws InputError on text that is no recording.yaml, a position not of 3 numbers, or a quaternion not of norm 1.
[[nodiscard]] RecordingInfo read_recording_info(std::string_view text, const std::string& file);
[[nodiscard]] std::string write_recording_info(const RecordingInfo& info);

[[nodiscard]] Calibration calibration_of(const RecordingInfo& info);
[[nodiscard]] Prior prior_of(const RecordingInfo& info);
/// The inverse of the two above.
[[nodiscard]] RecordingInfo recording_info(std::uint64_t seed, const Calibration& calibration, const Prior& prior);

}  // namespace plumbline::slam
