// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "bim/config/visit.h"
#include "slam/io/method.h"
#include "slam/localization/global_localizer.h"
#include "slam/localization/tracker.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

/// Takes a convergence back: when light goes through more of the plan than one wall that may be missing, and when
/// another place has explained the last way better, which a robot that was carried away, or that took the wrong one of
/// two places, would not notice by itself.
struct WatchConfig {
  double lost_through = 0.15;  ///< share of beams through walls but the one that most go through, of those that do not
                               ///< end before one; measured up to 0.09 on construction sites, 0.11 to 0.9 when wrong
  int lost_updates = 8;        ///< so many in a row
  double every_m = 1.5;        ///< way walked between two looks
  int views = 12;              ///< of the last way, by which places are judged
  double log_ratio = 20.0;     ///< by which the other place must be better
  double drop_ratio = 30.0;    ///< behind the best, from which a place is looked at no longer
  double through_margin = 0.03;  ///< by which more light may go through the plan there: the noise of that share

  template <class V>
  void visit(V& v) {
    v("lost_through", lost_through,
      Field{.doc =
                "share of beams through walls but one, of those that do not end before one, that takes a convergence "
                "back",
            .min = 0,
            .max = 1});
    v("lost_updates", lost_updates, Field{.doc = "so many in a row", .min = 1});
    v("every_m", every_m, Field{.doc = "way walked between two looks for a better place", .min = 0});
    v("views", views, Field{.doc = "of the last way, by which places are judged", .min = 1, .max = 1000});
    v("log_ratio", log_ratio, Field{.doc = "by which the other place must be better", .min = 0});
    v("drop_ratio", drop_ratio, Field{.doc = "behind the best, from which a place is looked at no longer", .min = 0});
    v("through_margin", through_margin,
      Field{.doc = "by which more light may go through the plan there", .min = 0, .max = 1});
  }
};

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
  WatchConfig watch;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("update_m", update_m, Field{.doc = "way walked between two updates; scans of one place are not news", .min = 0});
    v("update_rad", update_rad, Field{.doc = "or angle turned", .min = 0});
    v("particles_shown", particles_shown, Field{.doc = "most that an Output carries", .min = 1, .max = 500});
    v("mass_shown", mass_shown, Field{.doc = "least of a hypothesis in an Output", .min = 0, .max = 1});
    v("planes", planes);
    v("view", view);
    v("index", index);
    v("search", search);
    v("tracker", tracker);
    v("watch", watch);
    v("map", map);
  }
};

/// Localization in an architectural plan from an unknown position: a particle filter on the plan's walls and rooms
/// until one place is left, then a graph whose walls and rooms are the plan's own [BIM-Loc Fig. 1]. Throws InputError
/// when there is no plan, no such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_s_graph_localization(const MethodInput& input,
                                                                const LocalizationConfig& config = {});

}  // namespace plumbline::slam
