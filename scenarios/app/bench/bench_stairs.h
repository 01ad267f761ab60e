// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenarios/app/bench/bench.h"

namespace plumbline::scenarios {

/// Walks from one storey to the next and back, each from another start: how many were not walked to their end, and how
/// long one took.
[[nodiscard]] std::vector<BenchRow> bench_stairs(const BenchSetting& setting);

}  // namespace plumbline::scenarios
