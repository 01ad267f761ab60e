// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/alias_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "bim/random/stream.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

class AliasSearchAt : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] Pose somewhere() const {
    const Stream stream(7, "slam.localize.init");
    const auto tick = static_cast<std::uint64_t>(GetParam());
    return Pose::from_xyz_yaw({0.8 + 3.0 * stream.uniform(tick, 0), 0.8 + 2.0 * stream.uniform(tick, 1), 0.46},
                              6.0 * stream.uniform(tick, 2));
  }
  /// Aliases of a pose, in W.
  [[nodiscard]] std::vector<Pose2> aliases(const synthetic::House& planned, const synthetic::House& built,
                                           const StartPrior& prior = {}) const {
    const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
    const LocalizationScan scan = synthetic::house_scan(built, somewhere(), Pose{}).scan;
    const StoreyPose pose{0, heading(index.X_WI.inverse() * somewhere())};
    StartPrior prior_I = prior;
    if (prior.yaw_I) prior_I.yaw_I = pose.X_IH.yaw;
    std::vector<Pose2> found;
    const AliasSearch search(index, scan.sensor_height, {});
    for (const StoreyPose& alias : search.find(index, pose, prior_I, scan, {}, {}))
      found.push_back(heading(index.X_WI) * alias.X_IH);
    return found;
  }
  [[nodiscard]] static bool holds(const std::vector<Pose2>& poses, const Pose2& wanted) {
    return std::any_of(poses.begin(), poses.end(), [&](const Pose2& p) { return is_near(p, wanted, 0.03, 0.01); });
  }
};

TEST_P(AliasSearchAt, FindsTheTwinRoomThoughTheScanIsFullOfClutter) {
  const synthetic::House twins = synthetic::twin_rooms();
  synthetic::House cluttered = twins;
  cluttered.boxes.push_back({{4.2, 0.3, 0.0}, {4.9, 3.6, 1.6}});
  Pose2 there = heading(somewhere());
  there.t += Eigen::Vector2d(9.0, 1.0);
  EXPECT_TRUE(holds(aliases(twins, cluttered), there));
}

TEST_P(AliasSearchAt, FindsTheHalfTurnOfARectangle) {
  const synthetic::House room = synthetic::one_room(6.0, 4.0);
  const Pose2 here = heading(somewhere());
  const Pose2 there{Eigen::Vector2d(6.0, 4.0) - here.t, wrap_angle(here.yaw + std::numbers::pi)};
  const std::vector<Pose2> found = aliases(room, room);
  EXPECT_TRUE(holds(found, there));
  EXPECT_EQ(found.size(), 1U);
}

TEST_P(AliasSearchAt, ACompassRulesOutTheHalfTurn) {
  const synthetic::House room = synthetic::one_room(6.0, 4.0);
  EXPECT_TRUE(aliases(room, room, {0.0, 0.05}).empty());
}

INSTANTIATE_TEST_SUITE_P(Places, AliasSearchAt, testing::Range(0, 12));

}  // namespace
}  // namespace plumbline::slam
