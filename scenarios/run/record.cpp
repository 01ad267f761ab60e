// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/record.h"

#include <algorithm>
#include <utility>

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

void shift_times(MethodRecord& method, slam::Nanoseconds by) {
  slam::Estimate& estimate = method.estimate;
  for (slam::StampedPose& pose : method.causal) pose.stamp += by;
  for (slam::StampedPose& pose : estimate.trajectory) pose.stamp += by;
  for (BeliefRecord& belief : method.beliefs) belief.stamp += by;
  for (score::LostSpan& span : method.lost) span = {span.from + by, span.to + by};
  if (estimate.loops)
    for (slam::LoopEdge& loop : *estimate.loops) loop = {loop.from + by, loop.to + by, loop.X_FT};
  for (slam::SegmentedScan& scan : estimate.segmented) scan.stamp += by;
  const Tree* keyframes = estimate.graph.is_map() ? estimate.graph.find("keyframes") : nullptr;
  if (keyframes == nullptr) return;
  Tree later = Tree::list();
  for (Tree keyframe : keyframes->as_list())
    later.push(std::move(keyframe.set("stamp_ns", keyframe.find("stamp_ns")->as_int() + by)));
  estimate.graph.set("keyframes", std::move(later));
}

}  // namespace plumbline::scenarios
