// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/baselines/micp/mesh_correct.h"
#include "slam/plan_method/plan_baseline.h"
#include "slam/scan/scan_slice.h"

namespace plumbline::slam {

/// A pose in W to start from, on the storey told.
struct MicpStart {
  bool given = false;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v("given", given, Field{.doc = "start here; else all of the plan is tried"});
    v("x_m", x_m, Field{.doc = "in the plan's frame"});
    v("y_m", y_m, Field{.doc = "in the plan's frame"});
    v("yaw_deg", yaw_deg, Field{.doc = "counter-clockwise from x"});
  }
};

struct MicpConfig {
  MicpStart start;
  double grid_m = 0.5;  ///< basin of attraction [facts: localization 2.3]
  int yaw_steps = 72;   ///< of a turn
  int candidates = 24;
  double apart_m = 0.75;
  double apart_rad = 0.35;
  int start_casts = 20;
  int casts = 5;
  double track_distance_m = 0.5;
  double evidence_rays = 30.0;
  double drop_ratio = 10.0;
  double lost_inliers = 0.5;
  int lost_updates = 8;
  ScanSliceConfig slice{.min_height_m = 0.5, .max_height_m = 0.9};
  MeshCorrectConfig correct;
  PlanBaselineConfig plan{.update_m = 0.1, .update_rad = 0.1};
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("start", start);
    v("grid_m", grid_m, Field{.doc = "between starts that are tried", .min = 0.1});
    v("yaw_steps", yaw_steps, Field{.doc = "of a turn, tried at each", .min = 4, .max = 720});
    v("candidates", candidates,
      Field{.doc = "best starts that are corrected and followed; 1: believes the best at once", .min = 1, .max = 1000});
    v("apart_m", apart_m, Field{.doc = "between candidates", .min = 0});
    v("apart_rad", apart_rad, Field{.doc = "or this", .min = 0});
    v("start_casts", start_casts, Field{.doc = "of the rays, for a start", .min = 1, .max = 1000});
    v("casts", casts, Field{.doc = "of the rays, for each scan after it", .min = 1, .max = 1000});
    v("track_distance_m", track_distance_m, Field{.doc = "of a beam's end, after the start", .min = 0.01});
    v("evidence_rays", evidence_rays, Field{.doc = "beams of a scan that count as independent", .min = 1});
    v("drop_ratio", drop_ratio, Field{.doc = "log-ratio to the best below which a candidate is dropped", .min = 0});
    v("lost_inliers", lost_inliers, Field{.doc = "share of beams below which a scan does not fit", .min = 0, .max = 1});
    v("lost_updates", lost_updates, Field{.doc = "so many in a row: LOST", .min = 1});
    v("slice", slice);
    v("correct", correct);
    v("plan", plan);
    v("map", map);
  }
};

/// Mesh ICP: the pose is corrected so that beams cast in the plan meet what was measured, in the style of MICP-L, from
/// the start that is given. Where none is, level ranges of a grid over the rooms are compared with the scan's, the
/// best places are corrected and followed side by side, AMBIGUOUS until the beams have ruled out all but one. LOST
/// while the beams of scan after scan do not fit; nothing is searched for again. Throws InputError when there is no
/// plan, no such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_micp(const MethodInput& input, const MicpConfig& config = {});

}  // namespace plumbline::slam
