// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/record.h"

#include <algorithm>

namespace plumbline::scenarios {

void add_time(std::vector<StageTimes>& times, const slam::StageTime& call) {
  const auto found =
      std::find_if(times.begin(), times.end(), [&](const StageTimes& stage) { return stage.stage == call.stage; });
  StageTimes& stage = found != times.end() ? *found : times.emplace_back(StageTimes{call.stage, {}});
  stage.cpu_ms.push_back(static_cast<float>(call.cpu_ms));
}

}  // namespace plumbline::scenarios
