// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/structure.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "scenarios/metrics/storey.h"

namespace plumbline::scenarios::score {
namespace {

/// Two rooms of 4 x 5 m side by side and a corridor of 8 x 2 m above them; faces point into the rooms.
bim::Plan small_plan() {
  bim::Plan plan;
  const auto add_room = [&](const std::string& name, double x0, double y0, double x1, double y1) {
    bim::PlanRoom room;
    room.id = static_cast<int>(plan.rooms.size());
    room.name = name;
    room.polygon = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    for (std::size_t i = 0; i < 4; ++i) {
      bim::PlanFace face;
      face.id = static_cast<int>(plan.faces.size());
      face.p0 = room.polygon[i];
      face.p1 = room.polygon[(i + 1) % 4];
      const Eigen::Vector2d e = (face.p1 - face.p0).normalized();
      face.plane_W.n = Eigen::Vector3d(-e.y(), e.x(), 0.0);
      face.plane_W.d = -face.plane_W.n.head<2>().dot(face.p0);
      face.rooms = {room.id};
      room.faces.push_back(face.id);
      plan.faces.push_back(face);
    }
    plan.rooms.push_back(room);
  };
  add_room("left", 0.1, 0.1, 3.9, 4.9);
  add_room("right", 4.1, 0.1, 7.9, 4.9);
  add_room("corridor", 0.1, 5.1, 7.9, 6.9);
  return plan;
}

slam::PlaneNode node_of(const bim::PlanFace& face, int id) {
  slam::PlaneNode node;
  node.id = id;
  node.plane_F = face.plane_W;
  node.p0 = face.p0;
  node.p1 = face.p1;
  node.z0 = 0.2;
  node.z1 = 2.0;
  return node;
}

slam::Estimate perfect(const bim::Plan& plan) {
  slam::Estimate estimate;
  for (const bim::PlanFace& face : plan.faces) estimate.planes.push_back(node_of(face, face.id));
  for (const bim::PlanRoom& room : plan.rooms) {
    slam::RoomNode node;
    node.id = room.id;
    node.polygon_F = room.polygon;
    node.planes = room.faces;
    estimate.rooms.push_back(node);
  }
  return estimate;
}

std::vector<Eigen::Vector3d> hits_on(const bim::PlanFace& face) {
  std::vector<Eigen::Vector3d> hits;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d p = face.p0 + (face.p1 - face.p0) * (0.05 + 0.045 * i);
    hits.emplace_back(p.x(), p.y(), 1.0);
  }
  return hits;
}

std::vector<Eigen::Vector3d> hits_on_all(const bim::Plan& plan) {
  std::vector<Eigen::Vector3d> hits;
  for (const bim::PlanFace& face : plan.faces)
    for (const Eigen::Vector3d& p : hits_on(face)) hits.push_back(p);
  return hits;
}

/// Stands in each place for so long.
Truth stays(const std::vector<std::pair<Eigen::Vector2d, double>>& places) {
  Truth truth;
  slam::Nanoseconds t = 0;
  for (const auto& [place, duration_s] : places)
    for (int i = 0; i < static_cast<int>(duration_s * 100.0) + 1; ++i, t += 10'000'000)
      truth.poses_W.push_back({t, Pose::from_xyz_yaw({place.x(), place.y(), 0.5}, 0.0)});
  truth.scans = {0, t};
  return truth;
}

TEST(Rooms, VisitedWhenDeepEnoughForLongEnough) {
  const bim::Plan plan = small_plan();
  EXPECT_EQ(visited_rooms(plan, stays({{{2, 2}, 2.0}, {{4, 6}, 3.0}})), (std::vector<int>{0, 2}));
  EXPECT_EQ(visited_rooms(plan, stays({{{2, 2}, 1.9}})), (std::vector<int>{}));
  EXPECT_EQ(visited_rooms(plan, stays({{{2, 2}, 1.5}, {{0.3, 2}, 1.0}, {{2, 2}, 1.5}})), (std::vector<int>{}));
  EXPECT_EQ(visited_rooms(plan, stays({{{0.5, 2}, 9.0}})), (std::vector<int>{}));  // 0.4 m inside
}

TEST(Structure, ThePlanItselfScoresOne) {
  const bim::Plan plan = small_plan();
  const slam::Estimate estimate = perfect(plan);
  const WallScore walls = score_walls(estimate, Pose(), plan, hits_on_all(plan));
  EXPECT_EQ(walls.precision, 1.0);
  EXPECT_EQ(*walls.recall, 1.0);
  const RoomScore rooms = score_rooms(estimate, Pose(), plan, walls, stays({{{2, 2}, 3}, {{6, 2}, 3}, {{4, 6}, 3}}));
  EXPECT_EQ(rooms.matched, 3);
  EXPECT_EQ(*rooms.precision, 1.0);
  EXPECT_EQ(*rooms.recall, 1.0);
}

TEST(Structure, ScoresMoveWithTheFrame) {
  const bim::Plan plan = small_plan();
  slam::Estimate estimate = perfect(plan);
  const Pose X_WF = Pose::from_xyz_yaw({3.0, -2.0, 0.1}, 2.0);
  for (slam::PlaneNode& node : estimate.planes) {
    node.plane_F = X_WF.inverse() * node.plane_F;
    const auto moved = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d((X_WF.inverse() * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>());
    };
    node.p0 = moved(node.p0);
    node.p1 = moved(node.p1);
  }
  EXPECT_EQ(score_walls(estimate, X_WF, plan, hits_on_all(plan)).precision, 1.0);
  EXPECT_LT(score_walls(estimate, Pose(), plan, hits_on_all(plan)).precision, 0.3);
}

TEST(Walls, LimitsOfAngleOffsetOverlapAndSide) {
  const bim::Plan plan = small_plan();
  const bim::PlanFace& face = plan.faces[0];
  const auto precision = [&](const slam::PlaneNode& node) {
    slam::Estimate estimate;
    estimate.planes = {node};
    return score_walls(estimate, Pose(), plan, {}).precision;
  };
  const auto turned = [&](double degrees) {
    slam::PlaneNode node = node_of(face, 0);
    node.plane_F.n = exp_so3({0, 0, degrees * std::numbers::pi / 180.0}) * node.plane_F.n;
    return node;
  };
  const auto shifted = [&](double across, double along) {
    slam::PlaneNode node = node_of(face, 0);
    node.p0 += Eigen::Vector2d(along, across);
    node.p1 += Eigen::Vector2d(along, across);
    return node;
  };
  EXPECT_EQ(precision(turned(2.9)), 1.0);
  EXPECT_EQ(precision(turned(3.1)), 0.0);
  EXPECT_EQ(precision(turned(180.0)), 0.0);  // the other side of the wall
  EXPECT_EQ(precision(shifted(0.09, 0.0)), 1.0);
  EXPECT_EQ(precision(shifted(0.11, 0.0)), 0.0);
  // Half of the 3.8 m of the face, then of its neighbour 0.2 m further on the same line.
  EXPECT_EQ(precision(shifted(0.0, -1.8)), 1.0);
  EXPECT_EQ(precision(shifted(0.0, -2.0)), 0.0);
}

TEST(Walls, EachFaceMatchesOnce) {
  const bim::Plan plan = small_plan();
  slam::Estimate estimate;
  estimate.planes = {node_of(plan.faces[0], 0), node_of(plan.faces[0], 1)};
  estimate.planes[0].p0.y() += 0.02;
  estimate.planes[0].p1.y() += 0.02;
  const WallScore score = score_walls(estimate, Pose(), plan, hits_on(plan.faces[0]));
  EXPECT_EQ(score.precision, 0.5);
  EXPECT_EQ(score.faces_of_plane, (std::vector<std::vector<int>>{{}, {0}}));  // the nearer one
  EXPECT_EQ(*score.recall, 1.0);
  EXPECT_FALSE(score_walls(estimate, Pose(), plan, {}).recall);
  EXPECT_EQ(*score_walls(estimate, Pose(), plan, hits_on(plan.faces[5])).recall, 0.0);
}

TEST(Walls, StretchesOfOneFaceAreWallsOfTheirOwn) {
  const bim::Plan plan = small_plan();
  slam::Estimate estimate;
  estimate.planes = {node_of(plan.faces[0], 0), node_of(plan.faces[0], 1)};
  estimate.planes[0].p1.x() = 1.7;  // of 0.1 to 3.9
  estimate.planes[1].p0.x() = 2.1;
  EXPECT_EQ(score_walls(estimate, Pose(), plan, {}).precision, 1.0);
  estimate.planes[1].p0.x() = 0.2;
  EXPECT_EQ(score_walls(estimate, Pose(), plan, {}).precision, 0.5);
}

/// The plan with every face cut into three.
bim::Plan cut(const bim::Plan& plan) {
  bim::Plan pieces = plan;
  pieces.faces.clear();
  for (bim::PlanRoom& room : pieces.rooms) room.faces.clear();
  for (const bim::PlanFace& face : plan.faces)
    for (int k = 0; k < 3; ++k) {
      bim::PlanFace piece = face;
      piece.id = static_cast<int>(pieces.faces.size());
      piece.p0 = face.p0 + (face.p1 - face.p0) * (k / 3.0);
      piece.p1 = face.p0 + (face.p1 - face.p0) * ((k + 1) / 3.0);
      for (const int room : face.rooms) pieces.rooms[static_cast<std::size_t>(room)].faces.push_back(piece.id);
      pieces.faces.push_back(piece);
    }
  return pieces;
}

TEST(Walls, HowThePlanCutsThemMakesNoDifference) {
  const bim::Plan plan = small_plan(), pieces = cut(plan);
  const slam::Estimate whole = perfect(plan);
  for (const auto& [estimate, other] : {std::pair{whole, pieces}, std::pair{perfect(pieces), plan}}) {
    const WallScore walls = score_walls(estimate, Pose(), other, hits_on_all(other));
    EXPECT_EQ(walls.precision, 1.0);
    EXPECT_EQ(*walls.recall, 1.0);
  }
  const WallScore walls = score_walls(whole, Pose(), pieces, {});
  EXPECT_EQ(walls.faces_of_plane[0].size(), 3U);
  slam::Estimate corridor = whole;
  corridor.rooms = {corridor.rooms[2]};
  corridor.rooms[0].kind = slam::RoomKind::two_wall;
  corridor.rooms[0].polygon_F.clear();
  corridor.rooms[0].center_F = {4.0, 6.0};
  corridor.rooms[0].planes = {plan.rooms[2].faces[0], plan.rooms[2].faces[2]};
  EXPECT_EQ(score_rooms(corridor, Pose(), pieces, walls, stays({{{4, 6}, 3}})).matched, 1);
}

TEST(Rooms, InventedAndMissedRoomsCount) {
  const bim::Plan plan = small_plan();
  slam::Estimate estimate = perfect(plan);
  estimate.rooms.pop_back();                                                    // the corridor is missed,
  for (auto& p : estimate.rooms[1].polygon_F) p += Eigen::Vector2d(20.0, 0.0);  // one room is elsewhere,
  estimate.rooms.push_back(estimate.rooms[0]);                                  // and one is found twice
  const WallScore walls = score_walls(estimate, Pose(), plan, {});
  const RoomScore rooms = score_rooms(estimate, Pose(), plan, walls, stays({{{2, 2}, 3}, {{6, 2}, 3}, {{4, 6}, 3}}));
  EXPECT_EQ(rooms.visited, 3);
  EXPECT_EQ(rooms.found, 3);
  EXPECT_EQ(rooms.matched, 1);
  EXPECT_NEAR(*rooms.precision, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(*rooms.recall, 1.0 / 3.0, 1e-12);
}

// Equal rooms one above the other; the found one has no walls that would tell its height.
TEST(Rooms, OfEqualOnesTheVisitedIsFound) {
  bim::Plan plan = small_plan();
  const auto ground = static_cast<std::ptrdiff_t>(plan.rooms.size());
  for (std::ptrdiff_t i = 0; i < ground; ++i) {
    bim::PlanRoom above = plan.rooms[static_cast<std::size_t>(i)];
    above.id += static_cast<int>(ground);
    above.z0 += 3.0;
    above.z1 += 3.0;
    plan.rooms.push_back(above);
  }
  slam::Estimate estimate;
  estimate.rooms.emplace_back().polygon_F = plan.rooms[0].polygon;
  Truth truth = stays({{{2, 2}, 3}});
  for (slam::StampedPose& pose : truth.poses_W) pose.X_FR.t.z() += 3.0;
  const RoomScore upper = score_rooms(estimate, Pose(), plan, {}, truth);
  EXPECT_EQ(upper.room_of_node, std::vector<int>{static_cast<int>(ground)});
  EXPECT_EQ(*upper.recall, 1.0);
  EXPECT_EQ(score_rooms(estimate, Pose(), plan, {}, stays({{{2, 2}, 3}})).room_of_node, std::vector<int>{0});
}

TEST(Rooms, OverlapMustBeHalfOfTheUnion) {
  const bim::Plan plan = small_plan();
  const auto matched = [&](double height) {
    slam::Estimate estimate;
    slam::RoomNode node;
    node.polygon_F = {{0.1, 0.1}, {3.9, 0.1}, {3.9, 0.1 + height}, {0.1, 0.1 + height}};
    estimate.rooms = {node};
    return score_rooms(estimate, Pose(), plan, {}, stays({{{2, 2}, 3}})).matched;
  };
  EXPECT_EQ(matched(2.41), 1);
  EXPECT_EQ(matched(2.39), 0);
}

TEST(Rooms, ACorridorMatchesByItsTwoWalls) {
  const bim::Plan plan = small_plan();
  slam::Estimate estimate;
  estimate.planes = {node_of(plan.faces[8], 40), node_of(plan.faces[10], 41)};  // below and above the corridor
  slam::RoomNode node;
  node.kind = slam::RoomKind::two_wall;
  node.center_F = {2.0, 6.0};
  node.polygon_F = {{1.5, 5.1}, {2.5, 5.1}, {2.5, 6.9}, {1.5, 6.9}};  // a short stretch: no match by overlap
  node.planes = {40, 41};
  estimate.rooms = {node};
  const auto matched = [&] {
    const WallScore walls = score_walls(estimate, Pose(), plan, {});
    return score_rooms(estimate, Pose(), plan, walls, stays({{{4, 6}, 3}})).matched;
  };
  EXPECT_EQ(matched(), 1);
  estimate.rooms[0].center_F.y() = 6.51;
  EXPECT_EQ(matched(), 0);  // more than 0.5 m off the middle
  estimate.rooms[0].center_F = {2.0, 6.0};
  estimate.planes[1].p0.y() += 1.0;
  estimate.planes[1].p1.y() += 1.0;
  EXPECT_EQ(matched(), 0);  // one wall is not where it should be
}

TEST(Walls, DuplicatesLieOnStretchesThatAreTaken) {
  const bim::Plan plan = small_plan();
  slam::Estimate estimate = perfect(plan);
  EXPECT_EQ(score_walls(estimate, Pose(), plan, {}).duplicates, 0);
  slam::PlaneNode again = node_of(plan.faces[0], 100);  // the whole face, 3 cm behind it
  again.plane_F.d += 0.03;
  again.p0.y() -= 0.03;
  again.p1.y() -= 0.03;
  estimate.planes.push_back(again);
  slam::PlaneNode wrong = node_of(plan.faces[0], 101);  // not on any face
  wrong.plane_F.d -= 1.0;
  wrong.p0.y() += 1.0;
  wrong.p1.y() += 1.0;
  estimate.planes.push_back(wrong);
  const WallScore score = score_walls(estimate, Pose(), plan, {});
  EXPECT_EQ(score.duplicates, 1);
  EXPECT_DOUBLE_EQ(score.precision, 12.0 / 14.0);
  // Two halves of one face are different stretches.
  estimate.planes.resize(12);
  estimate.planes[0].p1.x() = 2.0;
  slam::PlaneNode rest = node_of(plan.faces[0], 102);
  rest.p0.x() = 2.0;
  estimate.planes.push_back(rest);
  EXPECT_EQ(score_walls(estimate, Pose(), plan, {}).duplicates, 0);
}

TEST(Storeys, FloorsAreMatchedByHeightOneToOne) {
  bim::Plan plan;
  for (const double z : {0.0, 3.0, 6.0}) {
    bim::PlanStorey storey;
    storey.elevation_m = z;
    plan.storeys.push_back(storey);
  }
  Truth truth;  // three seconds on the first two storeys, one on the last
  const double base = base_height_m();
  slam::Nanoseconds t = 0;
  for (const auto& [z, duration_s] : {std::pair(0.0, 3), std::pair(1.5, 3), std::pair(3.0, 3), std::pair(6.0, 1)})
    for (int i = 0; i <= 10 * duration_s; ++i, t += 100'000'000)
      truth.poses_W.push_back({t, Pose::from_xyz_yaw({0, 0, z + base}, 0.0)});
  slam::Estimate estimate;
  for (const double z : {0.02, 0.1, 3.29, 4.5}) estimate.floors.push_back({0, {1, 1, z}, {{0, 0, 1}, -z}});
  const StoreyScore score = score_storeys(estimate, Pose(), plan, truth);
  EXPECT_EQ(score.visited, 2);
  EXPECT_EQ(score.found, 4);
  EXPECT_EQ(score.matched, 2);  // the second one is the ground floor once more, the last is a landing
  EXPECT_EQ(*score.precision, 0.5);
  EXPECT_EQ(*score.recall, 1.0);
  const StoreyScore sunk = score_storeys(estimate, Pose::from_xyz_yaw({0, 0, -0.35}, 0.0), plan, truth);
  EXPECT_EQ(sunk.matched, 2);  // 0.1 is 0.25 too low, 3.29 is 0.06
  EXPECT_EQ(score_storeys({}, Pose(), plan, truth).recall, 0.0);
}

}  // namespace
}  // namespace plumbline::scenarios::score
