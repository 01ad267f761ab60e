// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "bim/config/visit.h"
#include "slam/io/method.h"
#include "slam/localization/global_localizer.h"
#include "slam/localization/tracker.h"
#include "slam/plan_method/plan_localization.h"
#include "slam/planes/observe.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

/// Withdraws a convergence when beams penetrate more of the plan than one wall that may be missing, and when another
/// hypothesis explains the last scans better, or when the robot leaves all rooms through a wall. It detects a kidnapped
/// robot, one that converged to the wrong one of two poses, or the plan of another building.
struct KidnapMonitorConfig {
  double lost_penetration_ratio = 0.15;
  int lost_updates = 8;
  double every_m = 1.5;
  int scans = 12;
  double log_ratio = 20.0;
  double drop_ratio = 30.0;
  double penetration_ratio_margin = 0.03;
  double off_floor_m = 0.3;
  double misfit = 12.0;
  int outside_updates = 4;
  double carried_s = 5.0;
  double lift_s = 3.0;
  double after_lift_m = 10.0;

  template <class V>
  void visit(V& v) {
    // Measured: up to 0.09 on construction sites, 0.11 to 0.9 at wrong poses.
    v("lost_penetration_ratio", lost_penetration_ratio,
      share_field("share of penetrating beams, without those of one change, above which a scan contradicts",
                  {.basic = true, .former = "lost_through"}));
    v("lost_updates", lost_updates,
      Field{.doc = "contradicting updates in a row that withdraw a convergence", .min = 1, .basic = true});
    v("every_m", every_m,
      Field{.doc = "distance walked between two searches for a better hypothesis", .min = 0, .basic = true});
    v("scans", scans,
      Field{.doc = "latest scans by which hypotheses are compared", .min = 1, .max = 1000, .former = "views"});
    v("log_ratio", log_ratio,
      plain_field("log-likelihood ratio by which another hypothesis must be better", {.min = 0, .basic = true}));
    v("drop_ratio", drop_ratio,
      plain_field("log-likelihood ratio to the best above which a hypothesis is dropped", {.min = 0}));
    v("penetration_ratio_margin", penetration_ratio_margin,
      share_field("margin by which the other's penetration ratio may be larger: its noise",
                  {.former = "through_margin"}));
    // Right poses on construction sites: at most 6.8 on 15 walks; c4f0 and se1 in their mirror images: up to 24.
    v("misfit", misfit,
      plain_field("sum of scans that do not fit, less those that do, which withdraws a convergence", {.min = 0}));
    // Thicker than any wall of a house, at update_m; assumed.
    v("outside_updates", outside_updates,
      Field{.doc = "scans in a row in no room of the plan, after the robot went through a wall, that withdraw a "
                   "convergence",
            .min = 1});
    // Assumed: in less nobody lifts a robot, carries it to another room and sets it down.
    v("carried_s", carried_s,
      Field{.doc = "time without scans and odometry after which a convergence is withdrawn where another pose explains "
                   "the next scan about as well",
            .unit = "s",
            .min = 0});
    // Both assumed.
    v("lift_s", lift_s,
      Field{.doc = "time in which a robot went less than update_m, after which it may be on another storey",
            .unit = "s",
            .min = 0});
    v("after_lift_m", after_lift_m,
      Field{.doc = "distance walked since within which a lost robot is searched on all storeys", .min = 0});
    v("off_floor_m", off_floor_m,
      Field{.doc = "height over or under a storey's floor from which the robot is on a stair", .min = 0.05});
  }
};

struct LocalizationConfig : PlanUpdateConfig {
  LocalizationConfig() {
    update_m = 0.2;           // scans from one position are not independent
    index.furniture = false;  // it may have moved
    mass_shown = 0.005;       // less than exp(-search.convergence.log_ratio): what keeps it from CONVERGED is listed
  }

  double update_s = 1.0;  // assumed
  PlaneDetectorConfig planes;
  RinglessRansacConfig ransac_without_rings;
  LocalizationScanConfig scan;
  PlanIndexConfig index;
  GlobalLocalizerConfig search;
  TrackerConfig tracker;
  KidnapMonitorConfig monitor;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    PlanUpdateConfig::visit(v);
    v("update_s", update_s,
      Field{.doc = "or time since the last, for a robot that stands while its pose is tracked; 0: never", .min = 0});
    v("planes", planes);
    v("ransac_without_rings", ransac_without_rings, Field{.advanced = true});
    v("scan", scan, Field{.former = "view"});
    v("index", index);
    v("search", search);
    v("tracker", tracker);
    v("monitor", monitor, Field{.former = "watch"});
    v("map", map);
  }
};

/// The same without the room factor.
struct LocalizationNoRoomsConfig : LocalizationConfig {
  LocalizationNoRoomsConfig() { tracker.room_factor = false; }
};

/// Localization in an architectural plan from an unknown position: a particle filter on the plan's walls and rooms
/// until one hypothesis is left, then a graph whose walls and rooms are the plan's own [shaheer2023, Fig. 1]. Throws
/// InputError when there is no plan, no such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_s_graph_localization(const MethodInput& input,
                                                                const LocalizationConfig& config = {});

}  // namespace plumbline::slam
