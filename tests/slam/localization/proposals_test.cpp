// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/proposals.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"
#include "tests/slam/plan_map/planned_furniture.h"

namespace plumbline::slam {
namespace {

bool holds(const std::vector<StoreyPose>& poses, const Pose2& X_IH) {
  return std::any_of(poses.begin(), poses.end(), [&](const StoreyPose& pose) {
    return (pose.X_IH.t - X_IH.t).norm() < 0.1 && std::abs(wrap_angle(pose.X_IH.yaw - X_IH.yaw)) < 0.03;
  });
}

TEST(Proposals, HoldTheTruePoseInEveryRoom) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  for (std::size_t i = 0; i < house.rooms.size(); ++i) {
    const Eigen::Vector2d middle = centroid(house.rooms[i]);
    const Pose X_WR = Pose::from_xyz_yaw({middle.x() + 0.3, middle.y() - 0.2, 0.46}, 1.1 * static_cast<double>(i));
    const LocalizationScan scan = synthetic::house_scan(house, X_WR, Pose{}, i + 1).scan;
    const Pose2 X_IH = heading(index.X_WI.inverse() * X_WR);
    EXPECT_TRUE(holds(propose_poses(index, {}, scan, 6, {}, {}), X_IH)) << i;
    EXPECT_TRUE(holds(propose_poses(index, {X_IH.yaw + 0.1, 0.05}, scan, 6, {}, {}), X_IH)) << i;
    for (const StoreyPose& pose : propose_poses(index, {X_IH.yaw, 0.05}, scan, 6, {}, {}))
      EXPECT_LT(std::abs(wrap_angle(pose.X_IH.yaw - X_IH.yaw)), 0.4);
  }
}

TEST(Proposals, HoldEveryPoseThatLooksTheSame) {
  const synthetic::House house = synthetic::twin_rooms();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const LocalizationScan scan = synthetic::house_scan(house, Pose::from_xyz_yaw({1.4, 1.3, 0.46}, 0.4), Pose{}).scan;
  const std::vector<StoreyPose> poses = propose_poses(index, {}, scan, 6, {}, {});
  ASSERT_GE(poses.size(), 2U);
  EXPECT_TRUE(holds({poses[0], poses[1]}, heading(index.X_WI.inverse() * Pose::from_xyz_yaw({1.4, 1.3, 0}, 0.4))));
  EXPECT_TRUE(holds({poses[0], poses[1]}, heading(index.X_WI.inverse() * Pose::from_xyz_yaw({10.4, 2.3, 0}, 0.4))));
}

// Between two rows of shelves a scan shows their fronts and the ends of the hall.
TEST(Proposals, HoldThePoseBetweenRowsOfPlannedShelves) {
  const synthetic::House hall = synthetic::one_room(20.0, 12.0);
  synthetic::House built = hall;
  bim::Plan plan = synthetic::plan_of(hall);
  for (const double y : {4.0, 7.0}) {
    built.boxes.push_back({{3.0, y, 0.0}, {17.0, y + 0.8, 2.7}});
    synthetic::add_furniture(plan, {3.0, y, 0.0}, {17.0, y + 0.8, 2.7});
  }
  PlanIndexConfig config;
  config.furniture = false;
  const PlanIndex index = make_plan_index(plan, "ground", config), walls = make_plan_index(plan, "ground", {});
  for (const double x : {6.0, 9.0, 14.0}) {
    const Pose X_WR = Pose::from_xyz_yaw({x, 5.7, 0.46}, 0.2);
    const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}).scan;
    EXPECT_TRUE(holds(propose_poses(index, {}, scan, 6, {}, {}), heading(index.X_WI.inverse() * X_WR))) << x;
    EXPECT_FALSE(holds(propose_poses(walls, {}, scan, 6, {}, {}), heading(index.X_WI.inverse() * X_WR))) << x;
  }
}

// What was taken for the wall of a hall may be the front of a row that the plan lacks.
TEST(Proposals, SlideThePoseAcrossEachWallWithinRooms) {
  const synthetic::House hall = synthetic::one_room(20.0, 12.0);
  const PlanIndex index = make_plan_index(synthetic::plan_of(hall), "ground", {});
  const Pose X_WR = Pose::from_xyz_yaw({8.0, 2.0, 0.46}, 0.3);
  const LocalizationScan scan = synthetic::house_scan(hall, X_WR, Pose{}).scan;
  const Pose2 X_IH = heading(index.X_WI.inverse() * X_WR);
  const ProposalConfig config;
  const std::vector<std::vector<StoreyPose>> by_direction = slide_across_walls(index, {0, X_IH}, scan, 6, {}, config);
  ASSERT_EQ(by_direction.size(), 2u) << "two directions of four walls";
  std::vector<StoreyPose> slid = by_direction[0];
  slid.insert(slid.end(), by_direction[1].begin(), by_direction[1].end());
  for (int k = -2; k <= 18; ++k) {
    const Pose moved = Pose::from_xyz_yaw({8.0, 2.0 + config.slide_step_m * k, 0.46}, 0.3);
    EXPECT_TRUE(holds(slid, heading(index.X_WI.inverse() * moved))) << k;
  }
  for (const StoreyPose& pose : slid) {
    EXPECT_GE(index.storeys.front().room_at(pose.X_IH.t), 0);
    EXPECT_EQ(pose.X_IH.yaw, X_IH.yaw);
  }
}

}  // namespace
}  // namespace plumbline::slam
