// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/run/digest_log.h"
#include "scenarios/spec/resolve.h"
#include "sim/world.h"
#include "slam/io/bags/bag.h"
#include "slam/io/recordings/recording_writer.h"

namespace plumbline::scenarios {

/// Writes a run's sensor records as they come.
class Recorder {
 public:
  /// Writes into `dir`, which is made where it does not exist. Throws EnvironmentError; and InputError for a LiDAR that
  /// sends no packets unless it goes `to_bag`, which add_bag() is to be called for: lidar.pcap is then left out.
  Recorder(const std::string& dir, const ResolvedScenario& resolved, bool to_bag = false);
  /// Also writes a bag: recording.bag, recording.mcap or the folder rosbag2. Call before the first frame, for each
  /// format once. compression: of MCAP.
  void add_bag(const slam::BagProfile& profile, bool with_truth, slam::BagFormat format = slam::BagFormat::ros1,
               std::string_view compression = {});
  /// To the bags of ROS 2, for viewers: the building as planned, and the plan of the storey of the start.
  void add_building(const ResolvedScenario& resolved);
  void add(const sim::WorldFrame& frame);
  /// Completes the files.
  void finish();

 private:
  std::string dir_;
  bool packets_;                   ///< whether the LiDAR sends any
  slam::Calibration calibration_;  ///< as methods are told
  slam::RecordingWriter writer_;
  std::vector<std::unique_ptr<slam::BagWriter>> bags_;
  bool truth_in_bag_ = false;
  DigestLog digests_;
};

}  // namespace plumbline::scenarios
