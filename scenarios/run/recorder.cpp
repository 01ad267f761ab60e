// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/recorder.h"

#include <filesystem>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

const std::string& made(const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directory(dir, error);
  if (error) throw EnvironmentError(dir + ": cannot be created: " + error.message());
  return dir;
}

}  // namespace

Recorder::Recorder(const std::string& dir, const ResolvedScenario& resolved)
    : writer_(made(dir), slam::recording_info(resolved.scenario.seed, sim::World::calibration(), resolved.prior)) {}

void Recorder::add(const sim::WorldFrame& frame) { writer_.add(frame.packets, frame.odometry, frame.imu); }

void Recorder::finish() { writer_.finish(); }

}  // namespace plumbline::scenarios
