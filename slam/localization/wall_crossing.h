// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/plan_map/plan_index.h"
#include "slam/plan_map/pose2.h"

namespace plumbline::slam {

/// The wall or column that a step goes through, or -1. body_height_m: of what may not pass, above the floor.
[[nodiscard]] int crossed_element(const StoreyIndex& storey, const Pose2& from, const Pose2& to, double body_height_m);
/// Adds that element, if any.
void add_crossed_element(const StoreyIndex& storey, const Pose2& from, const Pose2& to, double body_height_m,
                         std::vector<int>& elements);

/// Tells when a tracked pose has left the plan's rooms through a wall. One wall may not have been built; but then there
/// is a room behind it.
class RoomExit {
 public:
  /// Adds the pose after a scan. Returns the number of scans in a row, up to this one, at which it has been in no room
  /// since it went through a wall; 0 in a plan without rooms.
  int update(const StoreyIndex& storey, const Pose2& X_IH, double body_height_m);
  void clear() { *this = {}; }

 private:
  std::optional<Pose2> last_;
  bool crossed_ = false;  ///< a wall, and in no room since
  int outside_ = 0;       ///< scans
};

}  // namespace plumbline::slam
