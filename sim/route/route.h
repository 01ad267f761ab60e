// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bim/geometry/grid_frame.h"
#include "bim/model/building.h"

namespace plumbline::sim {

struct RouteConfig {
  double radius_m = 0.35;  ///< of the robot seen from above while it walks
  double turn_m = 0.55;    ///< the same while it turns round: 1.0 m long from nose to knees and 0.4 m wide
  double cell_m = 0.05;
  double band_low_m = 0.05;        ///< what ends below this above the floor is stepped over
  double band_high_m = 1.0;        ///< what begins above this is walked under
  double sill_max_m = 0.05;        ///< openings with a higher sill are not passed
  double head_min_m = 1.2;         ///< nor those with a lower head
  double comfort_m = 0.8;          ///< more clearance than this is worth no detour
  double shortcut_m = 0.6;         ///< straight lines pass walls nearer than this only where the path around did too
  double crowding = 3.0;           ///< a metre at `radius` clearance counts as 1 + this many at `comfort`
  double floor_below_m = 0.35;     ///< a slab's top this far below the storey (floor covering) still carries it
  double furniture_max_m2 = 10.0;  ///< no piece of furniture is larger, seen from above
  double weld_m = 1e-5;            ///< vertices this close are joined for the test whether a solid is closed
  double floor_gap_m = 0.3;        ///< gaps in the floor up to twice this (between slabs, under walls) are stepped over
};

/// Where a robot's centre can be on one storey of the as-built building. Walls stand where they are not opened by a
/// passable door or void; columns, obstacles and edges of the floor count as walls.
class ClearanceMap {
 public:
  /// Throws InputError when the storey is too large for a grid of this cell size (2^24 cells).
  ClearanceMap(const bim::Building& as_built, int storey, const RouteConfig& config = {});

  /// Clearance of at least the radius, to half a cell.
  [[nodiscard]] bool free(const Eigen::Vector2d& p) const;
  /// Distance to the nearest obstacle or edge of the floor, m; 0 inside one and off the grid.
  [[nodiscard]] double clearance(const Eigen::Vector2d& p) const;
  /// Short path from a to b that keeps the radius clear and to the middle of narrow passages, as few waypoints as that
  /// allows, a and b included; empty when b cannot be reached from a.
  [[nodiscard]] std::vector<Eigen::Vector2d> path(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Those of the points that a path reaches.
  [[nodiscard]] std::vector<Eigen::Vector2d> reachable(const Eigen::Vector2d& from,
                                                       const std::vector<Eigen::Vector2d>& points) const;
  /// The point of a room with the most clearance (ties: lowest cell), or none where the robot cannot turn round: a
  /// robot that enters such a room cannot leave it.
  [[nodiscard]] std::vector<Eigen::Vector2d> room_target(const Polygon2& room) const;
  /// The same of the largest connected walkable area, for buildings without rooms.
  [[nodiscard]] std::vector<Eigen::Vector2d> open_target() const;

 private:
  [[nodiscard]] double clearance_min() const { return config_.radius_m - 0.5 * config_.cell_m; }
  [[nodiscard]] bool passable(std::size_t cell) const { return clearance_[cell] >= clearance_min(); }
  [[nodiscard]] bool turnable(std::size_t cell) const {
    return clearance_[cell] >= config_.turn_m - 0.5 * config_.cell_m;
  }
  /// Cost of a tenth of a cell walked in a cell.
  [[nodiscard]] std::int64_t step_cost(std::size_t cell) const;
  /// Removes floor that is enclosed by hollow obstacles, such as the inside of a cupboard.
  void close_pockets(const std::vector<Polygon2>& hollow_obstacles);
  /// Cells that can be walked to from this one, in the order found; marks them.
  [[nodiscard]] std::vector<std::size_t> region(std::size_t from, std::vector<char>& seen) const;
  [[nodiscard]] std::vector<std::size_t> search(std::size_t from, std::size_t to) const;
  [[nodiscard]] bool clear_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double clearance_m) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> shortened(const std::vector<Eigen::Vector2d>& points) const;

  RouteConfig config_;
  GridFrame grid_;
  std::vector<double> clearance_;  ///< by cell, at its centre
};

}  // namespace plumbline::sim
