// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/lidar_height.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/config/tree.h"
#include "scenarios/app/open_recording.h"
#include "scenarios/host/terminal.h"
#include "slam/planes/mount_height.h"

namespace plumbline::scenarios {

HeightSource find_height(const EstimateArguments& options, const Degradation& degradation,
                         const slam::RecordingInfo& info, slam::MethodInput& input,
                         std::vector<std::string>& warnings) {
  if (info.mount.height_m) return HeightSource::description;
  const std::optional<double> height =
      slam::height_over_floor(*degraded(open_any_recording(options.input), degradation), input.calibration, input.seed);
  if (height) {
    input.calibration.sensor_height_m = *height;
    return HeightSource::scans;
  }
  warnings.push_back("no scan of the first half minute shows a floor: the LiDAR is taken to be " +
                     format_number(input.calibration.sensor_height_m) +
                     " m above it, as that of the simulated robot; --description gives the height");
  print_note("plumbline: warning: " + options.input.recording + ": " + warnings.back());
  return HeightSource::assumed;
}

void warn_of_height(const EstimateArguments& options, HeightSource height, double height_m, const MethodRecord& record,
                    std::vector<std::string>& warnings) {
  const auto is_sure = [](const BeliefRecord& belief) { return belief.state == slam::State::converged; };
  if (height == HeightSource::description || record.beliefs.empty() ||
      std::any_of(record.beliefs.begin(), record.beliefs.end(), is_sure))
    return;
  warnings.push_back("no pose fitted for long with the LiDAR " + format_number(std::round(100.0 * height_m) / 100.0) +
                     " m above the floor, which is not given; if that is wrong, --description gives the height");
  print_note("plumbline: warning: " + options.input.recording + ": " + warnings.back());
}

}  // namespace plumbline::scenarios
