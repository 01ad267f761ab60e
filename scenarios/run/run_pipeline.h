// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "scenarios/run/method_runner.h"
#include "sim/world.h"

namespace plumbline::scenarios {

/// Fills the next frame; false at the end, with the frame untouched.
using FrameSource = std::function<bool(sim::WorldFrame&)>;
using FrameObserver = std::function<void(const sim::WorldFrame&)>;

struct PipelineConfig {
  int threads = 1;               ///< how many may work at one time; 1: everything on the calling thread
  std::size_t frames_ahead = 8;  ///< how far the source may run ahead of a participant
};

/// Feeds every frame of the source to the observer and to every participant, and collects what they leave. The
/// observer runs on the calling thread. No result depends on `threads`. Throws what source and observer throw, after
/// all threads have stopped.
[[nodiscard]] std::vector<MethodRecord> run_pipeline(const FrameSource& source, const FrameObserver& observe,
                                                     std::vector<std::unique_ptr<Participant>> participants,
                                                     const PipelineConfig& config);

}  // namespace plumbline::scenarios
