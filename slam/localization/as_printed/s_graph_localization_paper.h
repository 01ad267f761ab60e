// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/localization/as_printed/paper_filter.h"
#include "slam/localization/tracker.h"
#include "slam/plan_method/plan_method.h"
#include "slam/planes/ransac.h"

namespace plumbline::slam {

struct LocalizationPaperConfig {
  PaperSwitches switches;
  PaperFilterConfig filter;
  RansacConfig ransac;
  PlaneDetectorConfig noise;
  LocalizationScanConfig scan;
  TrackerConfig tracker;
  PlanMethodConfig plan;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("switches", switches);
    v("filter", filter);
    v("ransac", ransac);
    v("noise", noise);
    v("scan", scan, Field{.former = "view"});
    v("tracker", tracker);
    v("plan", plan);
    v("map", map);
  }
};

/// The paper's ablation [shaheer2023, tables 5 to 7].
struct LocalizationWithoutRoomsConfig : LocalizationPaperConfig {
  LocalizationWithoutRoomsConfig() { switches.rooms = false; }
};

/// The plan localization of [shaheer2023] as printed: particles on the plan's walls and rooms until the best is where
/// all are on average, then an S-Graph whose walls and rooms are the plan's [shaheer2023, section 3.4]. A convergence
/// is final: it never reports LOST. PaperSwitches documents what is not as printed, and why. Throws InputError when
/// there is no plan, no such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_s_graph_localization_paper(const MethodInput& input,
                                                                      const LocalizationPaperConfig& config = {});

}  // namespace plumbline::slam
