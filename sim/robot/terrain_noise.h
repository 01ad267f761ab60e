// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "bim/random/stream.h"
#include "sim/robot/collision.h"
#include "sim/robot/model.h"

namespace plumbline::sim {

/// Tilted plates on the floor, at most one in each cell of a grid.
struct TerrainNoiseConfig {
  double cell_m = 0.3;
  int window = 7;              ///< cells along a side of the square around the robot whose plates exist
  double start_clear_m = 0.9;  ///< around the start there is none
  double half_min_m = 0.06;    ///< of a plate's sides, uniform
  double half_max_m = 0.14;
  double off_center_m = 0.05;  ///< of its middle from that of its cell, uniform to both sides
  double thickness_m = 0.1;    ///< mostly below the floor

  [[nodiscard]] int plates() const { return window * window; }
};

/// The plates near the robot. Which plate lies where depends on the seed and the cell alone.
class TerrainNoise {
 public:
  /// height_m: of the highest corner a plate can have above the floor, > 0. geoms: TerrainNoiseConfig().plates() boxes.
  TerrainNoise(double height_m, const Eigen::Vector2d& start_W, std::vector<int> geoms, std::uint64_t seed);

  /// Puts the plates around p_W into the model, on the floor at floor_z.
  void refresh(mjModel_& model, const Eigen::Vector2d& p_W, double floor_z);
  /// Plate of a cell on a floor at height 0; none near the start.
  [[nodiscard]] std::optional<CollisionBox> plate(const Eigen::Vector2i& cell) const;

 private:
  struct Window {
    Eigen::Vector2i cell;
    double floor_z = 0.0;
    bool operator==(const Window&) const = default;
  };

  TerrainNoiseConfig config_;
  double height_m_;
  Eigen::Vector2d start_W_;
  std::vector<int> geoms_;
  Stream stream_;
  std::optional<Window> window_;  ///< of the last refresh
};

}  // namespace plumbline::sim
