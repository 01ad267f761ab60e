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

bool said_lost(const MethodRecord& method, slam::Nanoseconds stamp) {
  const auto belief = std::lower_bound(method.beliefs.begin(), method.beliefs.end(), stamp,
                                       [](const BeliefRecord& said, slam::Nanoseconds at) { return said.stamp < at; });
  if (belief != method.beliefs.end() && belief->stamp == stamp) return belief->state == slam::State::lost;
  return std::any_of(method.lost.begin(), method.lost.end(),
                     [&](const score::LostSpan& span) { return span.from <= stamp && stamp <= span.to; });
}

}  // namespace plumbline::scenarios
