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

/// How a pose is fitted to what its beams should have met: registration of the points with their projections
/// [Umeyama 1991], or Gauss-Newton on the distances to the faces.
enum class MeshSolver { umeyama, gauss_newton };

}  // namespace plumbline::slam

namespace plumbline {
template <>
struct EnumNames<slam::MeshSolver> {
  static constexpr std::array<std::string_view, 2> names = {"umeyama", "gauss_newton"};
};
}  // namespace plumbline

namespace plumbline::slam {

struct MeshCorrectConfig {
  MeshSolver solver = MeshSolver::gauss_newton;
  int rays = 720;
  int inner_steps = 5;  ///< for each cast of the rays [facts: localization 2.3]
  double max_distance_m = 1.0;
  double shrink = 0.75;         ///< of the distance up to which a beam counts, with every cast ...
  double min_distance_m = 0.1;  ///< ... down to this
  double min_range_m = 0.5;
  double max_range_m = 25.0;
  double inlier_m = 0.1;
  double sigma_m = 0.05;  ///< of a beam's distance, for weighing places against each other ...
  double cap = 3.0;       ///< ... and the sigmas beyond which it says nothing more

  template <class V>
  void visit(V& v) {
    v("solver", solver, Field{.doc = "how a pose is fitted"});
    v("rays", rays, Field{.doc = "of a scan, evenly spread", .min = 16, .max = 200000});
    v("inner_steps", inner_steps, Field{.doc = "for each cast of the rays", .min = 1, .max = 1000});
    v("max_distance_m", max_distance_m, Field{.doc = "of a beam's end from its face, to count", .min = 0.01});
    v("shrink", shrink, Field{.doc = "of that, with every cast", .min = 0.01, .max = 1});
    v("min_distance_m", min_distance_m, Field{.doc = "where it stops shrinking", .min = 0.001});
    v("min_range_m", min_range_m, Field{.min = 0});
    v("max_range_m", max_range_m, Field{.min = 1});
    v("inlier_m", inlier_m, Field{.doc = "distance up to which a beam agrees with the plan", .min = 0.001});
    v("sigma_m", sigma_m, Field{.doc = "of a beam's distance, for weighing places", .min = 1e-3});
    v("cap", cap, Field{.doc = "sigmas beyond which a beam says nothing more", .min = 0.1});
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
  double inliers = 0.0;  ///< share of the beams that end within inlier_m of the face they meet, 0 to 1
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
  [[nodiscard]] std::vector<float> look_round(const Eigen::Vector3d& p_I, int count) const;

 private:
  /// What a beam should have met.
  struct Meeting {
    Eigen::Vector3d p_I, m_I, n_I;  ///< its end, the point on the face, the face's normal
    bool hit = false;
  };
  void cast(const MeshBeams& beams, const Pose& X_IR, std::vector<Meeting>& meetings) const;
  [[nodiscard]] Pose fit(const MeshBeams& beams, const std::vector<Meeting>& meetings, Pose X_IR,
                         double distance) const;
  void judge(const std::vector<Meeting>& meetings, MeshCorrection& correction) const;

  MeshCorrectConfig config_;
  bim::RayScene scene_;
};

}  // namespace plumbline::slam
