// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/localization/as_printed/paper_filter.h"
#include "slam/localization/tracker.h"
#include "slam/plan_method/plan_baseline.h"
#include "slam/planes/ransac.h"

namespace plumbline::slam {

struct LocalizationPaperConfig {
  PaperSwitches switches;
  PaperFilterConfig filter;
  RansacConfig ransac;
  PlaneDetectorConfig noise;
  ViewConfig view;
  TrackerConfig tracker;
  PlanBaselineConfig plan;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("switches", switches);
    v("filter", filter);
    v("ransac", ransac);
    v("noise", noise);
    v("view", view);
    v("tracker", tracker);
    v("plan", plan);
    v("map", map);
  }
};

/// The paper's ablation [tables 5 to 7].
struct LocalizationWithoutRoomsConfig : LocalizationPaperConfig {
  LocalizationWithoutRoomsConfig() { switches.rooms = false; }
};

/// The plan localization of [BIM-Loc] as printed: particles on the plan's walls and rooms until the best is where all
/// are on average, then an S-Graph whose walls and rooms are the plan's [section 3.4]. Nothing is taken back: it never
/// says LOST. What is not as printed, and why, PaperSwitches says. Throws InputError when there is no plan, no such
/// storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_s_graph_localization_paper(const MethodInput& input,
                                                                      const LocalizationPaperConfig& config = {});

}  // namespace plumbline::slam
