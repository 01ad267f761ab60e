// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/baselines/lego_loam/lego_features.h"

namespace plumbline::slam::lego {

struct TwoStepConfig {
  double max_distance2_m2 = 25.0;
  int max_rings = 2;
  int iterations = 25;
  double step_share = 0.05;
  int renewed_every = 5;
  int least_matches = 10;
  int least_edges = 10;
  int least_flats = 100;
  double least_eigenvalue = 10.0;

  template <class V>
  void visit(V& v) {
    v("max_distance2_m2", max_distance2_m2, Field{.doc = "largest squared distance to a match", .min = 0.01});
    v("max_rings", max_rings, Field{.doc = "most rings between the points that make a line or plane", .min = 1});
    v("iterations", iterations, Field{.doc = "most iterations of each step", .min = 1, .max = 1000});
    v("step_share", step_share,
      plain_field("share of each Gauss-Newton step that is made; the reference makes a twentieth",
                  {.min = 1e-3, .max = 1.0}));
    v("renewed_every", renewed_every, Field{.doc = "iterations from which matches are sought anew", .min = 1});
    v("least_matches", least_matches, Field{.doc = "least matches of a step", .min = 3});
    v("least_edges", least_edges, Field{.doc = "least edges of the former scan, exclusive", .min = 0});
    v("least_flats", least_flats, Field{.doc = "least flat points of the former scan, exclusive", .min = 0});
    v("least_eigenvalue", least_eigenvalue,
      plain_field("eigenvalue of the normal matrix below which a direction is left as it is", {.min = 0.0}));
  }
};

/// Motion over a scan: of R at its end in R at its beginning. Linear in time, in angles and translation.
struct Motion {
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw: Rz(yaw) Ry(pitch) Rx(roll)
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Pose at this share of the time.
  [[nodiscard]] Pose at(double share) const;
};

/// A point of the former scan, at its end.
struct FormerPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  int row = 0;
};

struct FormerScan {
  std::vector<FormerPoint> edges, flats;  ///< by row
};

/// Points as they would have been seen at the end of the scan.
[[nodiscard]] std::vector<FormerPoint> at_end(const std::vector<ImagePoint>& points, const Motion& motion);

struct TwoStepResult {
  Motion motion;
  bool by_ground = false;  ///< roll, pitch and z were found
  bool by_edges = false;   ///< yaw, x and y were found
  int degenerate = 0;      ///< of six directions, those that nothing held
};

/// From flat points on the ground roll, pitch and z, then from edges yaw, x and y [shan2018, section III-D]. What a
/// step does not find stays to the bit.
[[nodiscard]] TwoStepResult two_step(const Features& now, const FormerScan& former, const Motion& guess,
                                     const TwoStepConfig& config);

}  // namespace plumbline::slam::lego
