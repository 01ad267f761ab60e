// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/bags/bag.h"
#include "slam/io/recordings/motion_files.h"
#include "slam/io/recordings/recording.h"

namespace plumbline::scenarios {

struct RecordingArguments {
  std::string recording;    ///< recording or run directory, capture, bag, or folder of point clouds
  std::string description;  ///< a recording.yaml in place of the recording's own; empty: none
  slam::BagTopics topics;
  slam::MotionFiles motion;  ///< odometry and IMU of a recording that has none
};

/// Throws InputError for what is none of these, and for topics of what is no bag.
[[nodiscard]] std::unique_ptr<slam::Recording> open_any_recording(const RecordingArguments& arguments);

}  // namespace plumbline::scenarios
