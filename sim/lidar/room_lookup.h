// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::sim {

/// Which room a point lies in, by a grid over the rooms' outlines. Where rooms overlap the lowest index wins.
class RoomLookup {
 public:
  /// The building must outlive it.
  explicit RoomLookup(const bim::Building& building);

  /// Index into Building::rooms, -1 in none.
  [[nodiscard]] std::int32_t at(const Eigen::Vector3d& p_W) const;

 private:
  struct Entry {
    std::int32_t room = -1;
    bool whole = false;  ///< the cell lies in the room with all its area
  };
  [[nodiscard]] std::int64_t cell_of(const Eigen::Vector2d& p_W) const;
  void add_room(std::int32_t room, std::vector<std::vector<Entry>>& cells) const;

  const std::vector<bim::Room>& rooms_;
  Eigen::Vector2d origin_W_ = Eigen::Vector2d::Zero();
  Eigen::Vector2i cells_ = Eigen::Vector2i::Zero();
  double cell_m_ = 0.25;
  std::vector<std::int32_t> first_;  ///< of each cell's entries, one more at the end
  std::vector<Entry> entries_;
};

}  // namespace plumbline::sim
