// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "scenarios/run/method_runner.h"

namespace plumbline::scenarios {

/// Fills the next frame of sensor records; false at the end, with the frame untouched. A simulation and a recording are
/// such sources alike.
using SensorSource = std::function<bool(slam::SensorFrame&)>;

struct PipelineConfig {
  int threads = 1;               ///< how many may work at one time; 1: everything on the calling thread
  std::size_t frames_ahead = 8;  ///< how far the source may run ahead of a method
};

/// Feeds every frame of the source to every method, and collects their records, in the same order. The source is called
/// on the calling thread. No result depends on `threads`. Throws what the source throws, after all threads have
/// stopped.
[[nodiscard]] std::vector<MethodRecord> run_pipeline(const SensorSource& source,
                                                     std::vector<std::unique_ptr<MethodRunner>> methods,
                                                     const PipelineConfig& config);

}  // namespace plumbline::scenarios
