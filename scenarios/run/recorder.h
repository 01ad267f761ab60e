// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/resolve.h"
#include "sim/world.h"
#include "slam/io/recording_writer.h"

namespace plumbline::scenarios {

/// Writes a run's sensor records as they come.
class Recorder {
 public:
  /// Writes into `dir`, which is made where it does not exist. Throws EnvironmentError.
  Recorder(const std::string& dir, const ResolvedScenario& resolved);
  void add(const sim::WorldFrame& frame);
  /// Completes the files.
  void finish();

 private:
  slam::RecordingWriter writer_;
};

}  // namespace plumbline::scenarios
