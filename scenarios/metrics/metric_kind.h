// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline::scenarios {

/// Whether a metric is asked of methods of this kind, those that localize in the plan or those of SLAM. Map and walls
/// are of both.
[[nodiscard]] constexpr bool is_metric_of(std::string_view metric, bool localizes) {
  if (metric.starts_with("map_") || metric.starts_with("walls.")) return true;
  return metric.starts_with("localization.") == localizes;
}

}  // namespace plumbline::scenarios
