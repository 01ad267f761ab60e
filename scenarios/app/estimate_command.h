// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scenarios/app/degradation_options.h"
#include "scenarios/app/open_recording.h"

namespace plumbline::scenarios {

/// The command line of `plumbline estimate`.
struct EstimateArguments {
  RecordingArguments input;
  std::string method;
  bool is_process = false;  ///< a process of the user's, named by `method` once it is known
  std::string plan;
  std::string plan_furniture = "as_planned";
  std::string config;
  std::string sensors = "all";
  DegradationOptions degradation;
  std::string out;
  std::uint64_t seed = 1;
  double yaw_deg = 0.0;
  std::string storey;
  bool force = false, unchecked = false;
  std::optional<Argument> seed_option, yaw_option, furniture_option, sensors_option;
};

/// A file or folder without the folders that it is in.
[[nodiscard]] std::string name_of_path(const std::string& path);

/// The command that makes the estimate again, for a shell: paths without their folders, the command of a process as
/// COMMAND. has_config: --config says more than the defaults.
[[nodiscard]] std::string repeating_command(const EstimateArguments& options, bool has_config);

}  // namespace plumbline::scenarios
