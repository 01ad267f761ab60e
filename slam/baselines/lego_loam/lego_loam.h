// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/baselines/lego_loam/lego_features.h"
#include "slam/baselines/lego_loam/lego_loop.h"
#include "slam/baselines/lego_loam/range_image.h"
#include "slam/baselines/lego_loam/two_step.h"
#include "slam/graph/optimize.h"
#include "slam/io/method.h"
#include "slam/loam/keyframe_map.h"
#include "slam/scan/beams.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

struct LegoLoamConfig {
  Beams beam_model = Beams::automatic;
  lego::RangeImageConfig image;
  lego::FeatureConfig features;
  lego::TwoStepConfig odometry;
  double mapping_s = 0.3;
  double keyframe_distance_m = 0.3;
  loam::KeyframeMapConfig submap;
  lego::LoopConfig loop;
  OptimizerConfig optimizer{.max_iterations = 50, .relative_decrease = 1e-6, .loop_huber = 1e6};
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("beam_model", beam_model, beam_model_field);
    v("image", image);
    v("features", features);
    v("odometry", odometry);
    v("mapping_s", mapping_s, Field{.doc = "time from one scan that is matched with the map to the next", .min = 0.0});
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance walked after which a scan enters the map; turning alone adds none", .min = 0.01});
    v("submap", submap);
    v("loop", loop);
    v("optimizer", optimizer);
    v("map", map);
  }
};

/// In rooms the map's normal matrix holds height and tilt by fewer than the 100 points that the reference asks for.
struct LegoLoamIndoorConfig : LegoLoamConfig {
  LegoLoamIndoorConfig() { submap.least_eigenvalue = 10.0; }
};

/// LeGO-LOAM [shan2018]: ground and segments of a range image, odometry in two steps, then a map of keyframes. LiDAR
/// alone: odometry and IMU are not used. LOST where ground or edges do not tell the motion and the map does not tell
/// the pose: it then moves only by what was told.
[[nodiscard]] std::unique_ptr<Method> make_lego_loam(const MethodInput& input, const LegoLoamConfig& config);

}  // namespace plumbline::slam
