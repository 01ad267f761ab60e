// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/report/estimate/estimate_page.h"

namespace plumbline::scenarios {

/// How the scans came: how often, where they paused, when SLAM was lost. A plot where there is something to see.
[[nodiscard]] std::string draw_scans(const EstimatePage& page);

}  // namespace plumbline::scenarios
