// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/baselines/micp/mesh_correct.h"
#include "slam/plan_method/plan_method.h"
#include "slam/scan/scan_slice.h"

namespace plumbline::slam {

/// A pose in W to start from, on the storey of the prior.
struct MicpStart {
  bool given = false;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v("given", given, Field{.doc = "start at the pose below; else the whole plan is searched", .basic = true});
    v("x_m", x_m, Field{.doc = "x of the start in the plan's frame", .min = -1e6, .max = 1e6, .basic = true});
    v("y_m", y_m, Field{.doc = "y of the start in the plan's frame", .min = -1e6, .max = 1e6, .basic = true});
    v("yaw_deg", yaw_deg,
      Field{.doc = "heading of the start, counter-clockwise from x", .min = -360, .max = 360, .basic = true});
  }
};

/// Covariance of (x, y, yaw) that MICP-L publishes: (1 - progress + pose_noise) for each coordinate of the position, in
/// m^2, and a quarter of that for each angle. Progress is that of the correction in which a scan ended: the share of
/// beams that agree, less for a shift or a turn.
[[nodiscard]] Eigen::Matrix3d micp_covariance(const Pose& correction, double inliers, double pose_noise);

struct MicpConfig {
  MicpStart start;
  double grid_m = 0.5;
  int yaw_steps = 72;
  int candidates = 24;
  double gap_m = 0.75;
  double gap_rad = 0.35;
  int start_casts = 20;
  int casts = 5;
  double track_distance_m = 0.5;
  double evidence_rays = 30.0;
  double drop_ratio = 10.0;
  double lost_inliers = 0.5;
  int lost_updates = 8;
  double pose_noise = 0.01;
  ScanSliceConfig slice{.min_height_m = 0.5, .max_height_m = 0.9};
  MeshCorrectConfig correct;
  PlanMethodConfig plan{{.update_m = 0.1, .update_rad = 0.1}};
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("start", start);
    // Within the basin of attraction, docs/methods/baselines.md
    v("grid_m", grid_m, Field{.doc = "spacing of the grid of start positions", .min = 0.1, .basic = true});
    v("yaw_steps", yaw_steps,
      Field{.doc = "headings of a full turn that are tried at each start position", .min = 4, .max = 720});
    v("candidates", candidates,
      Field{.doc = "best starts that are corrected and tracked; 1: the best is taken at once",
            .min = 1,
            .max = 1000,
            .basic = true});
    v("gap_m", gap_m, Field{.doc = "least distance between two candidates", .min = 0, .former = "apart_m"});
    v("gap_rad", gap_rad, Field{.doc = "or least angle between two candidates", .min = 0, .former = "apart_rad"});
    v("start_casts", start_casts, Field{.doc = "casts of the rays that correct a start", .min = 1, .max = 1000});
    v("casts", casts,
      Field{.doc = "casts of the rays for each scan after the start", .min = 1, .max = 1000, .basic = true});
    v("track_distance_m", track_distance_m,
      Field{.doc = "largest distance of a beam's end from its face, after the start", .min = 0.01});
    v("evidence_rays", evidence_rays, plain_field("beams of a scan that count as independent", {.min = 1}));
    v("drop_ratio", drop_ratio,
      plain_field("log-likelihood ratio to the best below which a candidate is dropped", {.min = 0}));
    v("lost_inliers", lost_inliers, share_field("share of agreeing beams below which a scan does not fit"));
    v("lost_updates", lost_updates,
      Field{.doc = "scans in a row without a fit after which the state is LOST", .min = 1});
    v("pose_noise", pose_noise,
      Field{.doc = "least variance of a coordinate of the position; a quarter of it for angles",
            .unit = "m²",
            .min = 1e-12});
    v("slice", slice);
    v("correct", correct);
    v("plan", plan);
    v("map", map);
  }
};

/// Mesh ICP: the pose is corrected so that beams cast in the plan agree with what was measured, in the style of MICP-L,
/// from the start that is given. Where none is, level ranges of a grid over the rooms are compared with the scan's, the
/// best poses are corrected and tracked side by side, AMBIGUOUS until the beams have ruled out all but one. LOST while
/// the beams of scan after scan do not fit; nothing is searched for again. Its covariance is MICP-L's: wide while
/// corrections are large or beams do not agree. Throws InputError when there is no plan, no
/// such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_micp(const MethodInput& input, const MicpConfig& config = {});

}  // namespace plumbline::slam
