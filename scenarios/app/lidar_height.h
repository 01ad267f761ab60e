// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/app/degraded_recording.h"
#include "scenarios/app/estimate_command.h"
#include "scenarios/app/estimate_description.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// The height of the LiDAR above the floor, set in the calibration, and what to say where it is assumed.
HeightSource find_height(const EstimateArguments& options, const Degradation& degradation,
                         const slam::RecordingInfo& info, slam::MethodInput& input, std::vector<std::string>& warnings);

/// A height that is off keeps the true pose from fitting the plan's sills and door heads.
void warn_of_height(const EstimateArguments& options, HeightSource height, double height_m, const MethodRecord& record,
                    std::vector<std::string>& warnings);

}  // namespace plumbline::scenarios
