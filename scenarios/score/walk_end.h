// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/run/finished_run.h"

namespace plumbline::scenarios::score {

/// Begins the warning of a walk whose time was up before its route was done.
inline constexpr std::string_view cut_short_mark = "the walk ended when its time was up";

/// Warnings of the walk as planned, and where its time was up before its route was done, with what was left.
[[nodiscard]] std::vector<std::string> warnings_of_walk(const FinishedRun& run);

}  // namespace plumbline::scenarios::score
