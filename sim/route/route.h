// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "bim/geometry/grid_frame.h"
#include "bim/model/building.h"
#include "bim/model/walked_floors.h"

namespace plumbline::sim {

struct RouteConfig {
  double radius_m = 0.35;  ///< of the robot seen from above while it walks
  double turn_m = 0.55;    ///< the same while it turns round: 1.0 m long from nose to knees and 0.4 m wide
  double inside_m = 0.5;   ///< a place this far inside a room is well inside it, as `rooms.visited` has it
  double cell_m = 0.05;
  double band_low_m = 0.05;         ///< what ends below this above the floor is stepped over
  double band_high_m = 1.0;         ///< what begins above this is walked under
  double climb_m = 0.20;            ///< highest step between two floors
  double flat_m = 0.05;             ///< no higher than this is no step
  double step_before_m = 0.7;       ///< preferred between a step and where the robot lines up with it,
  double step_before_min_m = 0.45;  ///< and the least
  double step_detour_m = 2.0;       ///< a step counts as so much more way
  double sill_max_m = 0.05;         ///< openings with a higher sill are not passed
  double head_min_m = 1.2;          ///< nor those with a lower head
  double comfort_m = 0.8;           ///< more clearance than this is worth no detour
  double shortcut_m = 0.6;          ///< straight lines pass walls nearer than this only where the path around did too
  double crowding = 3.0;            ///< a metre at `radius` clearance counts as 1 + this many at `comfort`
  double floor_below_m =
      bim::WalkedFloorConfig()
          .bare_slab_m;            ///< a slab's top this far below the storey (floor covering) still carries it
  double furniture_max_m2 = 10.0;  ///< no piece of furniture is larger, seen from above
  double weld_m = 1e-5;            ///< vertices this close are joined for the test whether a solid is closed
  double overhead_low_m = 1.8;     ///< what lies between this
  double overhead_high_m = 12.0;   ///< and this above the floor is a ceiling or a roof
  double inside_min_m2 = 10.0;     ///< less covered floor than this is no inside
  double floor_gap_m = 0.3;        ///< gaps in the floor up to twice this (between slabs, under walls) are stepped over
};

/// A part of a path: over the floor, or straight up or down one step.
struct PathPart {
  std::vector<Eigen::Vector2d> points;
  double height_m = 0.0;  ///< of the floor at its end, over ClearanceMap::ground_W
  bool step = false;
};

/// Where a robot's centre can be on one storey of the as-built building. Walls stand where they are not opened by a
/// passable door or void; columns, obstacles and edges of the floor count as walls, and so do steps to raised floors
/// that are too high to climb or have no room before and behind them. Not for several threads at once.
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
  /// The same in parts, so that the robot can line up with each step.
  [[nodiscard]] std::vector<PathPart> parts(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Height in W of the lowest floor that is walked, see WalkedFloors.
  [[nodiscard]] double ground_W() const { return ground_W_; }
  /// Height of the floor over ground_W, m; 0 off the grid.
  [[nodiscard]] double height(const Eigen::Vector2d& p) const;
  [[nodiscard]] double cell_height(std::size_t cell) const {
    return heights_.empty() ? 0.0 : static_cast<double>(heights_[cell]);
  }
  /// Whether the floors of two neighbouring cells differ in height by a step.
  [[nodiscard]] bool is_step(std::size_t cell, std::size_t next) const;
  /// Whether the robot gets from a passable cell to a passable neighbour.
  [[nodiscard]] bool joined(std::size_t cell, std::size_t next) const;
  /// Those of the points that a path reaches.
  [[nodiscard]] std::vector<Eigen::Vector2d> reachable(const Eigen::Vector2d& from,
                                                       const std::vector<Eigen::Vector2d>& points) const;
  /// Number of the piece of walkable floor that a point lies on: a path joins two points of a piece, none joins two
  /// pieces. -1 where the robot cannot be. Numbered from 0 in the order of the lowest cells.
  [[nodiscard]] int region(const Eigen::Vector2d& p) const;
  /// Of each piece of walkable floor in a room the point with the most clearance (ties: lowest cell). Where that lies
  /// on the edge of a room without walls, the freest of the innermost ones, if that has as much clearance or enough for
  /// comfort. None where the robot cannot turn round: a robot that enters such a room cannot leave it. First comes a
  /// piece that leads out of the room, of such the one with the most floor in it: the outline of a room around a shaft
  /// holds the shaft.
  [[nodiscard]] std::vector<Eigen::Vector2d> room_targets(const bim::Room& room) const;
  /// In the piece of floor of such a point the freest place of those furthest inside the room, up to inside_m; the
  /// point itself where that place has less clearance than it and less than is comfortable.
  [[nodiscard]] Eigen::Vector2d inner_target(const bim::Room& room, const Eigen::Vector2d& target) const;
  /// The cell of the first of these; where there is none, that with the most clearance, which is too little; none where
  /// no cell's centre lies in the room.
  [[nodiscard]] std::optional<std::size_t> freest_cell(const bim::Room& room) const;
  /// The freest place of the largest connected walkable area, for buildings without rooms.
  [[nodiscard]] std::vector<Eigen::Vector2d> open_target() const;

  [[nodiscard]] const RouteConfig& config() const { return config_; }
  [[nodiscard]] const GridFrame& grid() const { return grid_; }
  [[nodiscard]] double cell_clearance(std::size_t cell) const { return clearance_[cell]; }
  /// Whether a floor carries the robot in a cell, whatever stands on it.
  [[nodiscard]] bool has_floor(std::size_t cell) const { return floor_[cell] != 0; }
  /// Clearance of at least the radius, to half a cell, at the centre of a cell.
  [[nodiscard]] bool passable(std::size_t cell) const { return clearance_[cell] >= clearance_min(); }
  /// Cost of a tenth of a cell walked in a passable cell.
  [[nodiscard]] std::int64_t step_cost(std::size_t cell) const;

 private:
  [[nodiscard]] double clearance_min() const { return config_.radius_m - 0.5 * config_.cell_m; }
  [[nodiscard]] bool turnable(std::size_t cell) const {
    return clearance_[cell] >= config_.turn_m - 0.5 * config_.cell_m;
  }
  template <class Use>
  void for_cells_around(const bim::Room& room, const Use& use) const;
  [[nodiscard]] std::vector<std::size_t> target_cells(const bim::Room& room) const;
  [[nodiscard]] std::size_t innermost(const bim::Room& room, std::size_t freest) const;
  /// The place in a room for the freest one of a piece of floor, which may lie on the edge of one without walls.
  [[nodiscard]] std::size_t well_inside(const bim::Room& room, std::size_t freest) const;
  /// Removes floor that is enclosed by hollow obstacles, such as the inside of a cupboard.
  void close_pockets(const std::vector<Polygon2>& hollow_obstacles);
  /// Cells that can be walked to from this one, in the order found; marks them.
  [[nodiscard]] std::vector<std::size_t> cells_in_reach(std::size_t from, std::vector<char>& seen) const;
  [[nodiscard]] const std::vector<int>& regions() const;
  [[nodiscard]] std::vector<std::size_t> search(std::size_t from, std::size_t to) const;
  [[nodiscard]] bool clear_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double clearance_m) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> shortened(const std::vector<Eigen::Vector2d>& points) const;
  /// Where the robot stands before and behind the step between two cells, where there is room for it.
  [[nodiscard]] std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> over_step(std::size_t cell,
                                                                                     std::size_t next) const;
  [[nodiscard]] bool add_parts(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int steps_left,
                               std::vector<PathPart>& parts) const;

  /// What a search writes; its vectors are as before after each.
  struct Search {
    std::vector<std::int64_t> cost;
    std::vector<std::uint32_t> before;
    std::vector<char> done;
    std::vector<std::size_t> touched;
  };

  RouteConfig config_;
  double ground_W_ = 0.0;
  GridFrame grid_;
  std::vector<double> clearance_;                                       ///< by cell, at its centre
  std::vector<char> floor_;                                             ///< by cell
  std::vector<float> heights_;                                          ///< of the floor by cell; empty: all 0
  mutable std::map<std::pair<std::size_t, std::size_t>, bool> joined_;  ///< by steps, lower cell first
  mutable std::vector<int> regions_;
  mutable Search search_;
};

}  // namespace plumbline::sim
