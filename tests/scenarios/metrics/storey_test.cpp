// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/storey.h"

#include <gtest/gtest.h>

#include "scenarios/metrics/structure.h"

namespace plumbline::scenarios::score {
namespace {

const std::vector<bim::PlanStorey> house = {{"upper", 2.9, 2.6}, {"ground", 0.0, 2.7}};

TEST(Storey, OfABaseIsTheNearestFloorUnderIt) {
  EXPECT_NEAR(base_height_m(), 0.5, 0.02);
  EXPECT_EQ(storey_of_base(house, base_height_m()), 1);
  EXPECT_EQ(storey_of_base(house, base_height_m() + 1.4), 1);
  EXPECT_EQ(storey_of_base(house, base_height_m() + 1.5), 0);
  EXPECT_EQ(storey_of_base(house, base_height_m() + 2.9), 0);
  EXPECT_EQ(storey_of_base({}, 0.5), 0);
}

TEST(Storey, OfAHeightIsTheOneThatBeginsBelowIt) {
  EXPECT_EQ(storey_of_height(house, -1.0), 1);
  EXPECT_EQ(storey_of_height(house, 2.8), 1);
  EXPECT_EQ(storey_of_height(house, 2.95), 0);
  EXPECT_EQ(storey_of_height({}, 1.0), 0);
}

/// The same room of 4 x 3 m on both storeys of a house.
bim::Plan tower() {
  bim::Plan plan;
  plan.storeys = {{"ground", 0.0, 2.7}, {"upper", 2.9, 2.6}};
  for (int storey = 0; storey < 2; ++storey) {
    bim::PlanRoom room;
    room.id = storey;
    room.storey = storey;
    room.z0 = 2.9 * storey;
    room.z1 = room.z0 + 2.6;
    room.polygon = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
    for (std::size_t i = 0; i < 4; ++i) {
      bim::PlanFace face;
      face.id = static_cast<int>(plan.faces.size());
      face.storey = storey;
      face.p0 = room.polygon[i];
      face.p1 = room.polygon[(i + 1) % 4];
      const Eigen::Vector2d e = (face.p1 - face.p0).normalized();
      face.plane_W.n = Eigen::Vector3d(-e.y(), e.x(), 0.0);
      face.plane_W.d = -face.plane_W.n.head<2>().dot(face.p0);
      face.z0 = room.z0;
      face.z1 = room.z1;
      room.faces.push_back(face.id);
      plan.faces.push_back(face);
    }
    plan.rooms.push_back(room);
  }
  return plan;
}

/// The rooms as a method finds them; their walls stand on the given storeys.
slam::Estimate found(const bim::Plan& plan, const std::vector<int>& storeys) {
  slam::Estimate estimate;
  for (const int storey : storeys) {
    slam::RoomNode node;
    node.id = static_cast<int>(estimate.rooms.size());
    node.polygon_F = plan.rooms[0].polygon;
    node.center_F = {2.0, 1.5};
    for (const int face : plan.rooms[static_cast<std::size_t>(storey)].faces) {
      const bim::PlanFace& f = plan.faces[static_cast<std::size_t>(face)];
      slam::PlaneNode plane;
      plane.id = static_cast<int>(estimate.planes.size());
      plane.plane_F = f.plane_W;
      plane.p0 = f.p0;
      plane.p1 = f.p1;
      plane.z0 = f.z0 + 0.2;
      plane.z1 = f.z0 + 2.0;
      node.planes.push_back(plane.id);
      estimate.planes.push_back(plane);
    }
    estimate.rooms.push_back(node);
  }
  return estimate;
}

Truth standing(double z) {
  Truth truth;
  for (int i = 0; i < 30; ++i) {
    truth.scans.push_back(100'000'000LL * i);
    truth.poses_W.push_back({truth.scans.back(), Pose::from_xyz_yaw({2.0, 1.5, z}, 0.0)});
  }
  return truth;
}

TEST(Storey, RoomsAreVisitedWhereTheRobotIs) {
  const bim::Plan plan = tower();
  EXPECT_EQ(visited_rooms(plan, standing(0.5)), std::vector<int>{0});
  EXPECT_EQ(visited_rooms(plan, standing(3.4)), std::vector<int>{1});
}

TEST(Storey, RoomsAndWallsMatchOnTheirOwnOnly) {
  const bim::Plan plan = tower();
  for (const std::vector<int>& storeys : {std::vector<int>{0, 1}, {1, 0}, {1, 1}, {0}}) {
    const slam::Estimate estimate = found(plan, storeys);
    const WallScore walls = score_walls(estimate, Pose(), plan, {});
    for (std::size_t i = 0; i < walls.faces_of_plane.size(); ++i)
      for (const int face : walls.faces_of_plane[i])
        EXPECT_EQ(plan.faces[static_cast<std::size_t>(face)].storey, storeys[i / 4]);
    const RoomScore rooms = score_rooms(estimate, Pose(), plan, walls, standing(0.5));
    EXPECT_EQ(rooms.room_of_node[0], storeys[0]);
    if (storeys == std::vector<int>{1, 1}) {
      EXPECT_EQ(rooms.room_of_node[1], -1);
      EXPECT_EQ(rooms.recall, 0.0);
    }
  }
}

TEST(Storey, HeightsAreThoseAfterPlacingTheMap) {
  const bim::Plan plan = tower();
  const slam::Estimate estimate = found(plan, {0});
  const Pose X_WF{Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.9}};
  const WallScore walls = score_walls(estimate, X_WF, plan, {});
  EXPECT_EQ(score_rooms(estimate, X_WF, plan, walls, standing(0.5)).room_of_node[0], 1);
}

}  // namespace
}  // namespace plumbline::scenarios::score
