// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/localization/hypotheses.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {

/// Scans of a walk in one of two equal rooms.
struct TwinRooms {
  PlanIndex index;
  std::vector<LocalizationScan> scans;
  std::vector<Pose2> u;
  Pose2 here, there;  ///< the true pose and its twin at the first scan
};

inline TwinRooms twin_rooms_scans() {
  const synthetic::House house = synthetic::twin_rooms();
  TwinRooms twins{make_plan_index(synthetic::plan_of(house), "ground", {}), {}, {}, {}, {}};
  for (int i = 0; i < 6; ++i) {
    const Pose X_WR = Pose::from_xyz_yaw({1.5 + 0.25 * i, 1.4, 0.46}, 0.2);
    twins.scans.push_back(synthetic::house_scan(house, X_WR, Pose{}, static_cast<std::uint64_t>(i + 1)).scan);
    const Pose2 X_IH = heading(twins.index.X_WI.inverse() * X_WR);
    const Pose2 before =
        i == 0 ? X_IH : heading(twins.index.X_WI.inverse() * Pose::from_xyz_yaw({1.25 + 0.25 * i, 1.4, 0.46}, 0.2));
    twins.u.push_back(before.inverse() * X_IH);
    if (i > 0) continue;
    twins.here = X_IH;
    twins.there = heading(twins.index.X_WI.inverse() * Pose::from_xyz_yaw({10.5, 2.4, 0.46}, 0.2));
  }
  return twins;
}

/// Tracks the true pose through all scans, then adds its twin.
inline void track_and_add_twin(const TwinRooms& twins, HypothesisSet& set) {
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  set.add(twins.index, std::vector<StoreyPose>{{0, twins.here}});
  for (std::size_t i = 1; i < twins.scans.size(); ++i) set.predict_and_update(twins.index, twins.u[i], twins.scans[i]);
  Pose2 twin = twins.there;
  for (std::size_t i = 1; i < twins.scans.size(); ++i) twin = twin * twins.u[i];
  set.add(twins.index, std::vector<StoreyPose>{{0, twin}});
}

}  // namespace plumbline::slam
