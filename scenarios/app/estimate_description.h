// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/app/degraded_recording.h"
#include "scenarios/app/recording_summary.h"
#include "scenarios/spec/method_names.h"
#include "slam/io/method.h"

namespace plumbline::scenarios {

/// From where the height of the LiDAR above the floor is known.
enum class HeightSource { description, scans, assumed };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(HeightSource) {
  return {"description", "scans", "assumed"};
}

/// What an estimate was made of besides the recording itself.
struct EstimateDescription {
  std::string method;
  std::uint64_t seed = 1;
  Sensors sensors = Sensors::all;
  Degradation degradation;
  ScansRead scans;
  std::optional<Eigen::Vector3d> plan_moved_by;  ///< see bim::Building
  std::vector<std::string> altered;              ///< files of the recording
  std::vector<std::string> warnings;             ///< that were printed, besides what was left out and assumed
  std::string recording, plan, command;          ///< names without their folders; plan empty: none
  std::string plan_furniture;                    ///< none or as_planned; empty without a plan
  std::string storey;                            ///< of the prior, by its name; empty: unknown
  HeightSource height = HeightSource::description;
};

/// estimate.yaml: which walk the answer is of, and what it depends on besides recording and plan.
[[nodiscard]] std::string describe(const EstimateDescription& description, const slam::Recording& recording,
                                   const slam::MethodInput& input);

}  // namespace plumbline::scenarios
