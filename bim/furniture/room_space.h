// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "bim/furniture/footprint.h"
#include "bim/furniture/surroundings.h"
#include "bim/geometry/grid_frame.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// The floor of one room as furniture comes and goes: where pieces fit, and where a robot can be. A cell of the grid is
/// free where its centre has the robot's radius clear; the outline of the room counts as a wall.
class RoomSpace {
 public:
  explicit RoomSpace(const Room& room, WalkableConfig config = {});

  void keep_clear(std::vector<Polygon2> areas);
  /// Takes out floor that what stands there shuts off from every area kept clear, such as the inside of a shaft; none
  /// where no area tells how the room is entered. To be called before furniture is added.
  void leave_out_shut_off();
  /// Index of what was added; nothing is checked.
  int add(Footprint footprint);
  void remove(int index);

  /// In the room, with the gap to walls and all that stands there, and out of what is kept clear.
  [[nodiscard]] bool holds(const Footprint& footprint) const;
  /// The robot gets from everywhere to everywhere as without the piece, except under it, and still has where to turn.
  [[nodiscard]] bool stays_walkable(const Footprint& footprint);
  /// Distance to what stands next, m, at most the reach of the grid; -1 out of the room.
  [[nodiscard]] double clearance(const Eigen::Vector2d& p) const;
  /// Any free cell, on a grid that is not too large.
  [[nodiscard]] bool walkable() const { return free_cells_ > 0; }
  /// Of the room without what is left out, m^2.
  [[nodiscard]] double floor_m2() const;

  /// Around the room's outline.
  [[nodiscard]] const Eigen::AlignedBox2d& box() const { return box_; }
  [[nodiscard]] const GridFrame& grid() const { return grid_; }
  [[nodiscard]] const WalkableConfig& config() const { return config_; }

 private:
  struct Standing {
    Footprint footprint;
    bool there = true;
  };
  struct CellRange {
    int i0, i1, j0, j1;
  };

  [[nodiscard]] CellRange cells_around(const Eigen::AlignedBox2d& box) const;
  void find_inside(const Room& room);
  [[nodiscard]] std::vector<int> standing_pieces() const;
  [[nodiscard]] std::optional<std::size_t> cell_at_entry(const Polygon2& area, const std::vector<int>& piece) const;
  void lower(const Footprint& footprint);
  void set_clearance(std::size_t cell, float value);
  [[nodiscard]] bool free(std::size_t cell) const { return clearance_[cell] >= radius_; }
  template <class Use>
  void for_neighbours(std::size_t cell, const Use& use) const;
  template <class Use>
  void for_free_neighbours(std::size_t cell, const Use& use) const;
  [[nodiscard]] bool connected_without(const std::vector<std::size_t>& taken);
  [[nodiscard]] bool all_reach_one_another(const std::vector<std::size_t>& border, std::uint32_t bordering,
                                           std::uint32_t lost, std::uint32_t grouped);

  WalkableConfig config_;
  Polygon2 outline_;
  Eigen::AlignedBox2d box_;
  GridFrame grid_;
  float radius_, turn_;
  double reach_m_;
  std::vector<Standing> standing_;
  std::vector<Polygon2> clear_;
  std::vector<float> clearance_;       ///< by cell; -1 outside
  std::vector<char> shut_off_;         ///< by cell; empty: none is
  std::vector<std::uint32_t> marked_;  ///< by cell: the search that last saw it
  std::uint32_t search_ = 0;
  std::int64_t free_cells_ = 0, turning_cells_ = 0;
};

}  // namespace plumbline::bim
