// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bim/random/stream.h"
#include "slam/rooms/outline.h"
#include "slam/rooms/room_detector.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// Grid of nx x ny cells of 0.1 m, free as the test sets it.
template <class Free>
FreeGrid make_grid(int nx, int ny, Free free) {
  FreeGrid grid{{{0.0, 0.0}, 0.1, nx, ny}, {}};
  grid.free.resize(grid.frame.size());
  for (std::size_t k = 0; k < grid.free.size(); ++k) grid.free[k] = free(grid.frame.center(k)) ? 1 : 0;
  return grid;
}

bool in_box(const Eigen::Vector2d& p, double x0, double y0, double x1, double y1) {
  return p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1;
}

TEST(Clearance, IsTheDistanceToTheNearestObstacleOnRandomGrids) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    FreeGrid grid = make_grid(23, 17, [](const auto&) { return true; });
    for (std::size_t k = 0; k < grid.free.size(); ++k)
      grid.free[k] = stream.uniform(trial, static_cast<std::uint32_t>(k)) < 0.95 ? 1 : 0;
    const std::vector<float> fast = distance_transform(grid);
    for (std::size_t k = 0; k < grid.free.size(); ++k) {
      double slow = 1e9;
      for (std::size_t o = 0; o < grid.free.size(); ++o)
        if (grid.free[o] == 0) slow = std::min(slow, (grid.frame.center(k) - grid.frame.center(o)).norm());
      EXPECT_NEAR(static_cast<double>(fast[k]), slow, 1e-5);  // float
    }
  }
}

TEST(Clusters, ADoorSplitsAndANarrowCorridorIsKept) {
  // A room of 4 x 4 m, a door of 0.9 m, a corridor 1.4 m wide: the fixed threshold of 0.8 m would lose the corridor.
  const FreeGrid grid = make_grid(80, 120, [](const auto& p) {
    return in_box(p, 1, 1, 5, 5) || in_box(p, 5, 2.5, 5.2, 3.4) || in_box(p, 5.2, 1, 6.6, 11);
  });
  const std::vector<Cluster> found = clusters(grid, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].area_m2, 16.0, 0.8);
  EXPECT_NEAR(found[1].area_m2, 14.0, 0.8);
}

/// Free space after a walk round `solid` in the middle of a 6 x 4 m room.
template <class Solid>
FreeGrid walk_round(Solid solid) {
  FreeSpaceMap map{FreeSpaceConfig{}};
  for (int k = 0; k < 24; ++k) {
    const double a = 2.0 * std::numbers::pi * k / 24.0;
    FreeRays rays;
    rays.origin_R = {2.0 * std::cos(a), 1.2 * std::sin(a), 0.0};
    for (int r = 0; r < 720; ++r) {
      const double b = std::numbers::pi * r / 360.0;
      Eigen::Vector2d p = rays.origin_R.head<2>();
      const Eigen::Vector2d step = 0.02 * Eigen::Vector2d(std::cos(b), std::sin(b));
      while (in_box(p, -3, -2, 3, 2) && !solid(p)) p += step;
      rays.end_R.emplace_back(p.x(), p.y(), 0.0);
      rays.hit.push_back(true);
    }
    map.carve(rays, Pose{});
  }
  return map.grid();
}

TEST(Clusters, AWallBetweenTwoDoorsSplitsARoom) {
  // 2 m of wall stand free between two doors of 1 m; their area is less than a column's of 0.8 m.
  const FreeGrid grid = walk_round([](const auto& p) { return in_box(p, -0.1, -1, 0.1, 1); });
  EXPECT_EQ(clusters(grid, {}).size(), 2U);
}

TEST(Clusters, SmallIslandsDoNotSplitARoom) {
  const FreeGrid grid = walk_round([](const auto& p) { return in_box(p, -0.2, -0.2, 0.2, 0.2); });
  const std::vector<Cluster> found = clusters(grid, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].area_m2, 24.0, 1.5);  // half a cell along a border of 20 m
}

TEST(FreeSpace, ChangedCellsAreCountedAcrossExtents) {
  const auto all = [](const auto&) { return true; };
  const FreeGrid small = make_grid(10, 10, all);
  FreeGrid large = make_grid(30, 20, all);
  EXPECT_EQ(changed_cells(small, small), 0U);
  EXPECT_EQ(changed_cells(small, large), 500U);
  EXPECT_EQ(changed_cells({}, small), 100U);
  large.frame.origin = {-0.5, -0.5};
  EXPECT_EQ(changed_cells(large, small), 500U);
  large.frame.origin = {0.5, 0.5};
  EXPECT_EQ(changed_cells(large, small), 600U + 100U - 2U * 25U);
}

/// The inner faces of a house's rooms as mapped planes, moved by X_MW.
std::vector<PlaneNode> wall_faces(const synthetic::House& house, const Pose& X_MW) {
  std::vector<PlaneNode> faces;
  for (const Polygon2& room : house.rooms)
    for (std::size_t k = 0; k < room.size(); ++k) {
      const Eigen::Vector2d a = room[k], b = room[(k + 1) % room.size()];
      const Eigen::Vector2d inward = Eigen::Vector2d(-(b - a).y(), (b - a).x()).normalized();
      PlaneNode face;
      face.id = static_cast<int>(faces.size());
      face.plane_F = X_MW * Plane{{inward.x(), inward.y(), 0.0}, -inward.dot(a)};
      face.p0 = (X_MW * Eigen::Vector3d(a.x(), a.y(), 0)).head<2>();
      face.p1 = (X_MW * Eigen::Vector3d(b.x(), b.y(), 0)).head<2>();
      face.z1 = house.height_m;
      faces.push_back(face);
    }
  return faces;
}

/// Standing scans every 1.5 s of a walk, with their true poses: the rooms stage alone is under test here.
struct Look {
  std::vector<DeskewedScan> scans;
  std::vector<Pose> X_WR;
};

Look look(const synthetic::House& house, std::uint64_t seed, double duration_s) {
  Look look;
  synthetic::WalkConfig walk;
  walk.seed = seed;
  MotionBuffer still;
  still.add(Odometry{});
  for (double t = 0.0; t < duration_s; t += 1.5) {
    look.X_WR.push_back(synthetic::walk_pose(synthetic::corridor_house_walk(), walk, t));
    const Scan scan = synthetic::standing_scan(house, look.X_WR.back(), walk);
    look.scans.push_back(deskew(scan, still, synthetic::calibration()));
  }
  return look;
}

struct Seen {
  FreeSpaceMap map{FreeSpaceConfig{}};
  std::vector<Eigen::Vector2d> visited_M;
};

Seen carve(const Look& look, const Pose& X_MW) {
  Seen seen;
  for (std::size_t k = 0; k < look.scans.size(); ++k) {
    const Pose X_MR = X_MW * look.X_WR[k];
    const Eigen::Vector3d up_R = X_MR.q.conjugate() * Eigen::Vector3d::UnitZ();
    seen.map.carve(free_rays(look.scans[k], up_R, FreeSpaceConfig{}), X_MR);
    seen.visited_M.emplace_back(X_MR.t.head<2>());
  }
  return seen;
}

double iou(const Polygon2& a, const Polygon2& b) {
  const double shared = intersection_area(a, b);
  return shared / (std::abs(signed_area(a)) + std::abs(signed_area(b)) - shared);
}

Polygon2 moved(const Polygon2& polygon_W, const Pose& X_MW) {
  Polygon2 polygon_M;
  for (const Eigen::Vector2d& p : polygon_W)
    polygon_M.emplace_back((X_MW * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>());
  return polygon_M;
}

TEST(Rooms, FindsEveryRoomOfAHouseAndNoOtherAtAnyHeading) {
  const synthetic::House house = synthetic::corridor_house();
  const Look all = look(house, 1, 120.0);
  for (const double yaw : {0.0, 0.4, -1.1}) {
    const Pose X_MW = Pose::from_xyz_yaw({-3.0, 5.0, 0.0}, yaw);
    const Seen seen = carve(all, X_MW);
    const FreeGrid grid = seen.map.grid();
    const std::vector<RoomCandidate> rooms =
        detect_rooms(grid, clusters(grid, {}), wall_faces(house, X_MW), seen.visited_M, {});
    EXPECT_EQ(rooms.size(), house.rooms.size()) << "yaw " << yaw;
    for (const Polygon2& room_W : house.rooms) {
      double best = 0.0;
      for (const RoomCandidate& room : rooms) best = std::max(best, iou(room.polygon_M, moved(room_W, X_MW)));
      // Walls are exact here, so a four-wall polygon is too; the corridor may be cut by its cluster's ends.
      EXPECT_GT(best, 0.9) << "yaw " << yaw;
    }
  }
}

/// Free space inside `outline`, which is turned by X_MW, less what `solid` holds, and the wall faces along both, seen
/// but for their last 0.2 m; `open` sides have none.
struct Shape {
  FreeGrid grid;
  std::vector<PlaneNode> walls;
};

Shape shape(const Polygon2& outline, const Polygon2& solid, const Pose& X_MW, const std::vector<std::size_t>& open) {
  const Polygon2 outer = moved(outline, X_MW), core = moved(solid, X_MW);
  Shape s;
  s.grid =
      make_grid(300, 300, [&](const auto& p) { return contains(outer, p) && (core.empty() || !contains(core, p)); });
  synthetic::House house;
  house.rooms = {outline};
  if (!solid.empty()) house.rooms.push_back(solid);
  s.walls = wall_faces(house, X_MW);
  for (PlaneNode& wall : s.walls) {
    const Eigen::Vector2d t = 0.2 * (wall.p1 - wall.p0).normalized();
    wall.p0 += t;
    wall.p1 -= t;
  }
  for (const std::size_t side : open) s.walls[side].p1 = s.walls[side].p0;
  return s;
}

const double headings[] = {0.0, 0.3, 1.2};

std::vector<RoomCandidate> rooms_in(const Shape& s) {
  std::vector<Eigen::Vector2d> everywhere;
  for (std::size_t k = 0; k < s.grid.free.size(); k += 7)
    if (s.grid.free[k] != 0) everywhere.push_back(s.grid.frame.center(k));
  return detect_rooms(s.grid, clusters(s.grid, {}), s.walls, everywhere, {});
}

TEST(Rooms, OfAnyShapeAreTheirChainOfWalls) {
  const std::vector<Polygon2> shapes = {
      {{0, 0}, {8, 0}, {8, 3}, {3, 3}, {3, 7}, {0, 7}},                                // L
      {{0, 0}, {12, 0}, {12, 2.2}, {8, 2.2}, {8, 7}, {5.8, 7}, {5.8, 2.2}, {0, 2.2}},  // T
      {{0, 0}, {9, 0}, {9, 6}, {6.5, 6}, {6.5, 2.5}, {2.5, 2.5}, {2.5, 6}, {0, 6}},    // U
      {{0, 0}, {4, 0}, {8, 4}, {8, 6}, {0, 6}}};                                       // a corner cut off
  for (const Polygon2& outline : shapes)
    for (const double yaw : headings) {
      const Pose X_MW = Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw);
      const std::vector<RoomCandidate> rooms = rooms_in(shape(outline, {}, X_MW, {}));
      ASSERT_EQ(rooms.size(), 1U) << outline.size() << " sides, yaw " << yaw;
      EXPECT_EQ(rooms[0].kind, RoomKind::polygon);
      EXPECT_EQ(rooms[0].planes.size(), outline.size());
      EXPECT_EQ(rooms[0].corners.size(), outline.size());
      EXPECT_GT(signed_area(rooms[0].polygon_M), 0.0);
      EXPECT_GT(iou(rooms[0].polygon_M, moved(outline, X_MW)), 1.0 - 1e-6);  // the walls are exact
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& p : moved(outline, X_MW)) mean += p / static_cast<double>(outline.size());
      EXPECT_LT((rooms[0].center_M - mean).norm(), 1e-6);
    }
}

// A side may lie on the wall of the one before it, or on one that is nearly parallel: no corner is there.
TEST(Rooms, HaveCornersWhereTwoWallsMeetAtAnAngle) {
  Outline outline;
  outline.sides = {{7, {0, 0}}, {7, {3, 0.1}}, {2, {6, 0}}, {5, {6, 4}}, {6, {3, 4}}, {-1, {0, 4}}};
  std::vector<FaceLine> walls(4);
  const std::array<std::pair<int, Eigen::Vector2d>, 4> normals = {
      {{7, {0, 1}}, {2, {-1, 0}}, {5, {0, -1}}, {6, {0.05, -1}}}};
  for (std::size_t k = 0; k < walls.size(); ++k) {
    walls[k].id = normals[k].first;
    walls[k].m = normals[k].second.normalized();
  }
  RoomCandidate room;
  set_polygon_planes(outline, walls, room);
  EXPECT_EQ(room.planes, (std::vector<int>{7, 2, 5, 6}));
  EXPECT_EQ(room.corners, (std::vector<std::array<int, 2>>{{0, 1}, {1, 2}}));
  EXPECT_LT((room.center_M - Eigen::Vector2d(6, 2)).norm(), 1e-12);
}

TEST(Rooms, OfAnyShapeMayHaveOpenSides) {
  const Polygon2 tee = {{0, 0}, {12, 0}, {12, 2.2}, {8, 2.2}, {8, 7}, {5.8, 7}, {5.8, 2.2}, {0, 2.2}};
  for (const double yaw : headings) {
    const Pose X_MW = Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw);
    const std::vector<RoomCandidate> rooms = rooms_in(shape(tee, {}, X_MW, {1, 7}));
    ASSERT_EQ(rooms.size(), 1U) << "yaw " << yaw;
    EXPECT_EQ(rooms[0].kind, RoomKind::polygon);
    EXPECT_EQ(rooms[0].planes.size(), 6U);
    EXPECT_EQ(rooms[0].corners.size(), 4U);
    EXPECT_GT(iou(rooms[0].polygon_M, moved(tee, X_MW)), 0.95);  // a cell at each open end of 12 m
  }
}

TEST(Rooms, ARingIsItsStraightParts) {
  const Polygon2 outer = {{0, 0}, {14, 0}, {14, 9}, {0, 9}}, core = {{2.2, 2}, {2.2, 7}, {11.8, 7}, {11.8, 2}};
  const std::vector<Polygon2> parts = {{{0, 0}, {14, 0}, {14, 2}, {0, 2}},
                                       {{0, 7}, {14, 7}, {14, 9}, {0, 9}},
                                       {{0, 2}, {2.2, 2}, {2.2, 7}, {0, 7}},
                                       {{11.8, 2}, {14, 2}, {14, 7}, {11.8, 7}}};
  for (const double yaw : headings) {
    const Pose X_MW = Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw);
    const std::vector<RoomCandidate> rooms = rooms_in(shape(outer, core, X_MW, {}));
    EXPECT_EQ(rooms.size(), parts.size()) << "yaw " << yaw;
    for (const Polygon2& part : parts) {
      double best = 0.0;
      for (const RoomCandidate& room : rooms) best = std::max(best, iou(room.polygon_M, moved(part, X_MW)));
      EXPECT_GT(best, 0.9) << "yaw " << yaw;  // a stretch ends where cells do, within one of 0.1 m at each end of 5 m
    }
  }
}

/// Rooms of a hall of 12 x 4 m that a wall from its side parts in the middle, over all but `open_m` of its width; the
/// wall's clearance is below the saddle ratio of the free space.
std::size_t rooms_beside_wall(double open_m, double yaw) {
  const Pose X_MW = Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw);
  return rooms_in(shape({{0, 0}, {12, 0}, {12, 4}, {0, 4}}, {{5.9, 0}, {5.9, 4 - open_m}, {6.1, 4 - open_m}, {6.1, 0}},
                        X_MW, {}))
      .size();
}

TEST(Rooms, GoOnPastAPilasterAndEndAtAWall) {
  for (const double yaw : headings) {
    EXPECT_EQ(rooms_beside_wall(2.7, yaw), 1U) << "yaw " << yaw;
    EXPECT_EQ(rooms_beside_wall(1.6, yaw), 2U) << "yaw " << yaw;
  }
}

/// Two clusters of a hall of 3 x 10 m whose ends are open, parted by a strip of this width that climbs by `slope`.
std::vector<RoomCandidate> hall_parted(double slope, double width_m, double yaw) {
  const Pose X_MW = Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw);
  const Shape s = shape({{0, 0}, {3, 0}, {3, 10}, {0, 10}}, {}, X_MW, {0, 2});
  std::vector<std::size_t> below, above;
  for (std::size_t k = 0; k < s.grid.free.size(); ++k) {
    if (s.grid.free[k] == 0) continue;
    const Eigen::Vector2d p_M = s.grid.frame.center(k);
    const Eigen::Vector3d p_W = X_MW.inverse() * Eigen::Vector3d(p_M.x(), p_M.y(), 0.0);
    const double over = p_W.y() - 5.0 - slope * (p_W.x() - 1.5);
    if (over < -0.5 * width_m) below.push_back(k);
    if (over >= 0.5 * width_m) above.push_back(k);
  }
  const std::vector<Eigen::Vector2d> visited = {s.grid.frame.center(below[below.size() / 2]),
                                                s.grid.frame.center(above[above.size() / 2])};
  return detect_rooms(s.grid, std::vector<Cluster>{cluster_of(s.grid, below), cluster_of(s.grid, above)}, s.walls,
                      visited, {});
}

TEST(Rooms, OfOneHallCutAskewAreOneAndThoseBesideASillTwo) {
  for (const double yaw : headings) {
    const std::vector<RoomCandidate> askew = hall_parted(0.8, 0.6, yaw);
    ASSERT_EQ(askew.size(), 1U) << "yaw " << yaw;
    EXPECT_EQ(askew[0].kind, RoomKind::two_wall);
    const Polygon2 whole = moved({{0, 0}, {3, 0}, {3, 10}, {0, 10}}, Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw));
    EXPECT_GT(iou(askew[0].polygon_M, whole), 0.95) << "yaw " << yaw;
    EXPECT_GT(askew[0].fill, 0.7);
    EXPECT_EQ(hall_parted(0.0, 0.6, yaw).size(), 2U) << "yaw " << yaw;
    EXPECT_EQ(hall_parted(0.0, 0.15, yaw).size(), 2U) << "yaw " << yaw;  // a partition: no cell lies between
  }
}

TEST(Rooms, AreNotClaimedBeforeTheyAreEntered) {
  const synthetic::House house = synthetic::corridor_house();
  const Seen seen = carve(look(house, 2, 12.0), Pose{});
  const FreeGrid grid = seen.map.grid();
  const std::vector<PlaneNode> walls = wall_faces(house, Pose{});
  for (const RoomCandidate& room : detect_rooms(grid, clusters(grid, {}), walls, seen.visited_M, {})) {
    int entered = 0;
    for (const Eigen::Vector2d& p : seen.visited_M) entered += contains(room.polygon_M, p) ? 1 : 0;
    EXPECT_GT(entered, 0);
  }
  const std::vector<Eigen::Vector2d> nowhere;
  EXPECT_TRUE(detect_rooms(grid, clusters(grid, {}), walls, nowhere, {}).empty());
}

TEST(Rooms, AreFoundAgainByOverlap) {
  const auto square = [](double x, double y) { return Polygon2{{x, y}, {x + 4, y}, {x + 4, y + 4}, {x, y + 4}}; };
  std::vector<RoomCandidate> candidates(3);
  candidates[0].polygon_M = square(10.2, 0.1);
  candidates[1].polygon_M = square(30, 0);
  candidates[2].polygon_M = square(0.1, 0);
  const std::vector<Polygon2> known = {square(0, 0), square(10, 0)};
  EXPECT_EQ(associate_rooms(known, candidates, 0.3), (std::vector<int>{1, -1, 0}));
}

}  // namespace
}  // namespace plumbline::slam
