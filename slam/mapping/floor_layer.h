// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/graph/graph.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

struct FloorLayerConfig {
  double storey_step_m = 1.8;  ///< a floor this far above or below those of all storeys is another storey's; landings
                               ///< are nearer
  double stand_m = 0.46;       ///< R above the floor it stands on, from the calibration
  double underfoot_m = 0.2;   ///< a floor this far from there is not the robot's storey's: seen over stairs, or a table
  double same_floor_m = 0.5;  ///< a storey's floor may seem this much higher than it was: drift
  double level_rad = 0.08;    ///< tilt up to which a plane is a floor or ceiling: a flight of stairs is neither
  double opposed_cos = 0.9;   ///< least |n_a . n_b| of a widest pair [facts: slam 3.5]
  double min_width_m = 1.0;
  double refresh_m = 0.5;     ///< t_f: a floor centre that moves further renews the rooms' places on it
  double room_sigma_m = 1.0;  ///< of a room's place on its floor; weak, rooms are not known to be fixed to it

  template <class V>
  void visit(V& v) {
    v("storey_step_m", storey_step_m, Field{.doc = "height between storeys, at least", .min = 0.1});
    v("underfoot_m", underfoot_m, Field{.doc = "of a floor seen to the one the robot stands on", .min = 0});
    v("same_floor_m", same_floor_m, Field{.doc = "error of a floor's height", .min = 0});
    v("level_rad", level_rad, Field{.doc = "tilt of a floor or ceiling, at most", .min = 0, .max = 1});
    v("opposed_cos", opposed_cos, Field{.doc = "of the widest pair of walls", .min = 0, .max = 1});
    v("min_width_m", min_width_m, Field{.doc = "of the widest pair of walls", .min = 0});
    v("refresh_m", refresh_m, Field{.doc = "move of a floor's centre that renews its factors", .min = 0});
    v("room_sigma_m", room_sigma_m, Field{.doc = "of a room's place on its floor", .min = 1e-3});
  }
};

/// Storey of the newest keyframe: that of the highest known floor not above the floor under the robot, a new one where
/// it is storey_step_m over that, the former keyframe's when the floor underfoot is not seen.
[[nodiscard]] int storey_of(const Graph& graph, const Pose& X_MR, std::span<const PlaneObservation> seen,
                            const FloorLayerConfig& config);

/// Drops horizontal planes that are not level in M.
void keep_level(std::vector<PlaneObservation>& seen, const Pose& X_MR, const FloorLayerConfig& config);

/// Vertex of a storey's floor plane (ties: lower id), or -1.
[[nodiscard]] int floor_plane_of(const Graph& graph, int storey);
/// Height of a horizontal plane at (x, y), m.
[[nodiscard]] double height_at(const Plane& plane, const Eigen::Vector2d& p);

/// The floor layer [S-Graphs+ sections IV-D, V]: a floor's centre lies midway between the widest opposed pairs of its
/// walls; every room is tied to it [eq. 9].
class FloorLayer {
 public:
  explicit FloorLayer(const FloorLayerConfig& config) : config_(config) {}

  void update(Graph& graph, int storey, std::span<const PlaneNode> walls);

 private:
  struct Place {
    int room = 0;
    Eigen::Vector2d offset_M = Eigen::Vector2d::Zero();
  };

  FloorLayerConfig config_;
  std::vector<Place> places_;  ///< by room id, ascending
};

}  // namespace plumbline::slam
