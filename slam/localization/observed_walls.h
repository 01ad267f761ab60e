// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/io/estimate.h"
#include "slam/localization/tracker.h"

namespace plumbline::slam {

/// Walls and rooms of the plan that were observed, as they were observed: where the as-built wall stands off its plan,
/// the wall reported here does too.
class ObservedWalls {
 public:
  /// Adds a pose after its last optimisation.
  void add(const StoreyIndex& storey, const TrackedPose& pose);

  /// Faces in W, by first sighting.
  [[nodiscard]] std::vector<PlaneNode> planes(const Pose& X_WI) const;
  /// Rooms entered, in W, by first entry; their outline is the plan's.
  [[nodiscard]] std::vector<RoomNode> rooms(const Pose& X_WI) const;

 private:
  struct Wall {
    int plan_storey = -1;
    int line = -1;
    WallLine planned;
    double offset_sum = 0.0;  ///< of the face seen from the face planned, along the normal
    double s0 = 0.0, s1 = 0.0, z0 = 0.0, z1 = 0.0;
    int observations = 0;
  };
  struct Room {
    int plan_room = -1;
    Polygon2 polygon;
    int visits = 0;
  };
  void add_wall(const StoreyIndex& storey, const TrackedPose& pose, const WallLink& link);
  void add_room(const LocalRoom& room);

  std::vector<Wall> walls_;
  std::vector<Room> rooms_;
};

}  // namespace plumbline::slam
