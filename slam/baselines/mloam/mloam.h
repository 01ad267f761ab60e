// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/baselines/mloam/window.h"
#include "slam/io/method.h"
#include "slam/loam/keyframe_map.h"
#include "slam/loam/scan_to_scan.h"
#include "slam/registration/features.h"
#include "slam/scan/beams.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

struct MloamConfig {
  Beams beam_model = Beams::automatic;
  loam::FeatureConfig features;
  loam::ScanToScanConfig tracker;
  mloam::WindowConfig window;
  double keyframe_distance_m = 1.0;
  double keyframe_angle_rad = 0.01745;
  loam::KeyframeMapConfig submap{.radius_m = 30.0,
                                 .rounds = 2,
                                 .iterations = 30,
                                 .huber_m = 0.1,
                                 .residual_weight = 0.0,
                                 .least_matches = 10,
                                 .least_flats = 50,
                                 .least_eigenvalue = 100.0};
  double point_sigma_m = 0.05;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("beam_model", beam_model, beam_model_field);
    v("features", features);
    v("tracker", tracker);
    v("window", window);
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance walked after which a scan enters the map", .min = 0.01, .basic = true});
    v("keyframe_angle_rad", keyframe_angle_rad, Field{.doc = "or angle turned after which it does", .min = 1e-3});
    v("submap", submap);
    v("point_sigma_m", point_sigma_m,
      Field{.doc = "standard deviation of a point's coordinates; eigenvalues are of matrices weighed by it",
            .min = 1e-4});
    v("map", map);
  }
};

/// What one LiDAR leaves of M-LOAM [jiao2022]: LOAM features tracked from scan to scan, and a map of keyframes, with a
/// window of scans and a prior of what left it in between. No extrinsics are calibrated, and the
/// uncertainty of points is the same for all, so that it weighs nothing but the tests of degeneracy. LiDAR alone:
/// odometry and IMU are not used. LOST where a scan is matched neither with the window nor with the map: the pose then
/// stands.
[[nodiscard]] std::unique_ptr<Method> make_mloam(const MethodInput& input, const MloamConfig& config);

}  // namespace plumbline::slam
