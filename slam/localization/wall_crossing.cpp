// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_crossing.h"

namespace plumbline::slam {

int crossed_element(const StoreyIndex& storey, const Pose2& from, const Pose2& to, double body_height_m) {
  const double from_z = storey.floor_at(from.t) + body_height_m, to_z = storey.floor_at(to.t) + body_height_m;
  return storey.structure->barrier({from.t.x(), from.t.y(), from_z}, {to.t.x(), to.t.y(), to_z});
}

void add_crossed_element(const StoreyIndex& storey, const Pose2& from, const Pose2& to, double body_height_m,
                         std::vector<int>& elements) {
  const int element = crossed_element(storey, from, to, body_height_m);
  if (element >= 0) elements.push_back(element);
}

int RoomExit::update(const StoreyIndex& storey, const Pose2& X_IH, double body_height_m) {
  crossed_ = crossed_ || (last_ && crossed_element(storey, *last_, X_IH, body_height_m) >= 0);
  last_ = X_IH;
  if (storey.rooms.empty() || storey.room_at(X_IH.t) >= 0) crossed_ = false;
  return outside_ = crossed_ ? outside_ + 1 : 0;
}

}  // namespace plumbline::slam
