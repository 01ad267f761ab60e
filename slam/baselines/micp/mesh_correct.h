// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "bim/rays/ray_scene.h"
#include "slam/plan_map/plan_index.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// How a pose is fitted to the faces that its beams should hit: registration of the points with their projections
/// [umeyama1991], or Gauss-Newton on the distances to the faces.
enum class MeshSolver { umeyama, gauss_newton };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(MeshSolver) { return {"umeyama", "gauss_newton"}; }

struct MeshCorrectConfig {
  MeshSolver solver = MeshSolver::gauss_newton;
  int rays = 720;
  int inner_steps = 5;
  double max_distance_m = 1.0;
  double shrink = 0.75;
  double min_distance_m = 0.1;
  double min_range_m = 0.5;
  double max_range_m = 25.0;
  double inlier_m = 0.1;
  double sigma_m = 0.05;
  double cap = 3.0;

  template <class V>
  void visit(V& v) {
    v("solver", solver, Field{.doc = "solver that fits a pose to the beams"});
    v("rays", rays, Field{.doc = "rays cast for a scan, evenly spread", .min = 16, .max = 200000, .basic = true});
    // [mock2024]
    v("inner_steps", inner_steps, Field{.doc = "solver steps for each cast of the rays", .min = 1, .max = 1000});
    v("max_distance_m", max_distance_m,
      Field{.doc = "largest distance of a beam's end from the face it should hit, at the first cast",
            .min = 0.01,
            .basic = true});
    v("shrink", shrink, plain_field("factor by which this distance shrinks with every cast", {.min = 0.01, .max = 1}));
    v("min_distance_m", min_distance_m, Field{.doc = "distance at which it stops shrinking", .min = 0.001});
    v("min_range_m", min_range_m, Field{.doc = "least range of a beam that is used", .min = 0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a beam that is used", .min = 1});
    v("inlier_m", inlier_m,
      Field{.doc = "distance from its face up to which a beam agrees with the plan", .min = 0.001});
    v("sigma_m", sigma_m,
      Field{.doc = "standard deviation of a beam's distance, for weighing hypotheses", .min = 1e-3});
    v("cap", cap, plain_field("standard deviations at which a beam's cost is capped", {.min = 0.1}));
  }
};

/// Beams of one scan, to be cast again.
struct MeshBeams {
  Eigen::Vector3d sensor_R = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> ends_R;
};
[[nodiscard]] MeshBeams pick_beams(const DeskewedScan& scan, const MeshCorrectConfig& config);

struct MeshCorrection {
  Pose X_IR;
  double inliers = 0.0;  ///< share of the beams that end within inlier_m of the face they hit, 0 to 1
  double cost = 0.0;     ///< mean of min(d / sigma, cap)^2 / 2
};

/// Mesh ICP in the manner of MICP-L on a storey of the plan. Frame I.
class MeshCorrector {
 public:
  MeshCorrector(const StoreyIndex& storey, const MeshCorrectConfig& config);

  /// Casts the beams `casts` times, from a largest distance on, and fits the pose after each. Without beams the start.
  [[nodiscard]] MeshCorrection correct(const MeshBeams& beams, const Pose& start, int casts, double distance_m) const;
  /// Horizontal ranges to the walls round a point, `count` of them counter-clockwise from I's x axis; max_range_m where
  /// there are none.
  [[nodiscard]] std::vector<float> range_profile(const Eigen::Vector3d& p_I, int count) const;

 private:
  /// A beam's end and the point that it should have hit.
  struct Correspondence {
    Eigen::Vector3d p_I, m_I, n_I;  ///< its end, the point on the face, the face's normal
    bool hit = false;
  };
  void cast(const MeshBeams& beams, const Pose& X_IR, std::vector<Correspondence>& correspondences) const;
  [[nodiscard]] Pose fit(const MeshBeams& beams, const std::vector<Correspondence>& correspondences, Pose X_IR,
                         double distance) const;
  void evaluate(const std::vector<Correspondence>& correspondences, MeshCorrection& correction) const;

  MeshCorrectConfig config_;
  bim::RayScene scene_;
};

}  // namespace plumbline::slam
