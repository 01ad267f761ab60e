// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/graph/graph.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

struct FloorLayerConfig {
  double storey_step_m = 1.8;
  double robot_height_m = 0.46;  ///< R above the floor it stands on, from the calibration
  double underfoot_m = 0.2;
  double same_floor_m = 0.5;
  double level_rad = 0.08;
  double opposed_cos = 0.9;
  double min_width_m = 1.0;
  double refresh_m = 0.5;
  double room_sigma_m = 1.0;

  template <class V>
  void visit(V& v) {
    v("storey_step_m", storey_step_m,
      Field{.doc = "least height between floors of two storeys; landings are nearer", .min = 0.1});
    v("underfoot_m", underfoot_m,
      Field{.doc = "largest height of an observed floor over that underfoot: seen over stairs, or a table", .min = 0});
    v("same_floor_m", same_floor_m,
      Field{.doc = "most that a storey's floor may seem higher than it was: drift", .min = 0});
    v("level_rad", level_rad,
      Field{.doc = "largest tilt of a floor or ceiling; a flight of stairs is neither", .min = 0, .max = 1});
    // [lsg2022]
    v("opposed_cos", opposed_cos, share_field("least |n_a · n_b| of a storey's widest pair of walls"));
    v("min_width_m", min_width_m, Field{.doc = "least width between this pair", .min = 0});
    // t_f of [bavle2023].
    v("refresh_m", refresh_m, Field{.doc = "move of a floor's centre that renews the offsets of its rooms", .min = 0});
    // Weak, since rooms are not known to be fixed to it.
    v("room_sigma_m", room_sigma_m,
      Field{.doc = "standard deviation of a room's offset from its floor's centre", .min = 1e-3});
  }
};

/// Storey of the newest keyframe: that of the highest known floor not above the floor under the robot, a new one where
/// it is storey_step_m over that, the former keyframe's when the floor underfoot is not seen.
[[nodiscard]] int storey_of(const Graph& graph, const Pose& X_MR, std::span<const PlaneObservation> seen,
                            const FloorLayerConfig& config);

/// Drops horizontal planes that are not level in M.
void drop_tilted_planes(std::vector<PlaneObservation>& seen, const Pose& X_MR, const FloorLayerConfig& config);

/// Vertex of a storey's floor plane (ties: lower id), or -1.
[[nodiscard]] int floor_plane_of(const Graph& graph, int storey);
/// Height of a horizontal plane at (x, y), m.
[[nodiscard]] double height_at(const Plane& plane, const Eigen::Vector2d& p);

/// The floor layer [bavle2023, sections IV-D, V]: a floor's centre lies midway between the widest opposed pairs of its
/// walls; every room is tied to it [bavle2023, eq. 9].
class FloorLayer {
 public:
  explicit FloorLayer(const FloorLayerConfig& config) : config_(config) {}

  void update(Graph& graph, int storey, std::span<const PlaneNode> walls);

 private:
  struct RoomOffset {
    int room = 0;
    Eigen::Vector2d offset_M = Eigen::Vector2d::Zero();
  };

  FloorLayerConfig config_;
  std::vector<RoomOffset> room_offsets_;  ///< by room id, ascending
};

}  // namespace plumbline::slam
