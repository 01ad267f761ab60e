// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"
#include "slam/localize/search.h"
#include "slam/localize/tracker.h"
#include "slam/odometry/map_cloud.h"

namespace plumbline::slam {

struct LocalizationConfig {
  double update_m = 0.2;      ///< way walked between two updates; scans of one place are not news
  double update_rad = 0.2;    ///< or angle turned
  int particles_shown = 500;  ///< most that an Output carries
  double mass_shown = 0.02;   ///< least of a hypothesis in an Output
  PlaneDetectorConfig planes;
  ViewConfig view;
  PlanIndexConfig index;
  SearchConfig search;
  TrackerConfig tracker;
  MapCloudConfig map;
};

/// Localization in an architectural plan from an unknown position: a particle filter on the plan's walls and rooms
/// until one place is left, then a graph whose walls and rooms are the plan's own [BIM-Loc Fig. 1]. Throws InputError
/// when there is no plan, no such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_s_graph_localization(const MethodInput& input,
                                                                const LocalizationConfig& config = {});

}  // namespace plumbline::slam
