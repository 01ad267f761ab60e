// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/factors.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "bim/errors.h"
#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

constexpr int trials = 200;
// Central differences with step h: truncation h^2 ~ 1e-10 times third derivatives (values up to 1e2 m), rounding 1e-16
// * 1e2 / h = 1e-9.
constexpr double h = 1e-5;
constexpr double tolerance = 1e-6;

/// Central differences of f: R^n -> R^m at zero.
Eigen::MatrixXd numeric(int n, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f) {
  Eigen::MatrixXd J;
  for (int i = 0; i < n; ++i) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(n, i);
    const Eigen::VectorXd column = (f(step) - f(-step)) / (2.0 * h);
    if (J.size() == 0) J.resize(column.size(), n);
    J.col(i) = column;
  }
  return J;
}

void expect_near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, int trial) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance) << "trial " << trial << "\n" << a << "\n\n" << b;
}

TEST(Factors, PoseJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(1, static_cast<std::uint64_t>(trial));
    const Pose X_i = random.pose(10.0, 1.0);
    const Pose X_j = random.pose(10.0, 1.0);
    const Pose Z = X_i.inverse() * X_j * random.pose(0.5, trial % 2 == 0 ? 0.3 : 1e-4);
    const PoseResidual r = pose_residual(X_i, X_j, Z);
    expect_near(r.J_i, numeric(6, [&](const auto& s) { return pose_residual(increment(X_i, s), X_j, Z).e; }), trial);
    expect_near(r.J_j, numeric(6, [&](const auto& s) { return pose_residual(X_i, increment(X_j, s), Z).e; }), trial);
  }
}

TEST(Factors, PlaneJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(2, static_cast<std::uint64_t>(trial));
    const Pose X = random.pose(10.0, 1.0);
    const Plane plane{random.vector(1.0).normalized(), random.uniform(-20.0, 20.0)};
    const Plane measured = increment(X.inverse() * plane, random.vector(0.05));
    const PlaneResidual r = plane_residual(X, plane, measured);
    expect_near(r.J_pose, numeric(6, [&](const auto& s) { return plane_residual(increment(X, s), plane, measured).e; }),
                trial);
    expect_near(r.J_plane,
                numeric(3, [&](const auto& s) { return plane_residual(X, increment(plane, s), measured).e; }), trial);
  }
}

TEST(Factors, PlaneResidualVanishesAtTheTruth) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(3, static_cast<std::uint64_t>(trial));
    const Pose X = random.pose(10.0, 1.0);
    const Plane plane{random.vector(1.0).normalized(), random.uniform(-20.0, 20.0)};
    EXPECT_LT(plane_residual(X, plane, X.inverse() * plane).e.norm(), 1e-12);
  }
}

struct Room {
  Plane planes[4];
  const Plane* pointers[4] = {&planes[0], &planes[1], &planes[2], &planes[3]};
  Eigen::Vector2d center;
};

/// A room of random size, place and heading whose walls are a little off parallel; walls face inwards.
void make_room(RandomValues& random, double spread, Room& room) {
  const double yaw = random.uniform(-3.0, 3.0);
  room.center = random.vector(spread).head<2>();
  for (int i = 0; i < 4; ++i) {
    const double angle = yaw + std::numbers::pi * (i % 2 == 0 ? 0.0 : 1.0) + (i < 2 ? 0.0 : 0.5 * std::numbers::pi);
    room.planes[i] = random.wall(angle + 0.02 * random.gauss(), 0.0);
    const Eigen::Vector3d p(room.center.x(), room.center.y(), 0.0);
    room.planes[i].d = random.uniform(1.0, 4.0) - room.planes[i].n.dot(p);
  }
}

TEST(Factors, FourWallJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(4, static_cast<std::uint64_t>(trial));
    Room room;
    make_room(random, 10.0, room);
    const double z = random.uniform(-1.0, 4.0);
    const FourWallResidual r = four_wall_residual(room.center, room.pointers, z);
    expect_near(r.J_center,
                numeric(2, [&](const auto& s) { return four_wall_residual(room.center + s, room.pointers, z).e; }),
                trial);
    for (int i = 0; i < 4; ++i)
      expect_near(
          r.J_plane[i],
          numeric(3,
                  [&](const auto& s) {
                    const Plane moved = increment(room.planes[i], s);
                    const Plane* planes[4] = {room.pointers[0], room.pointers[1], room.pointers[2], room.pointers[3]};
                    planes[i] = &moved;
                    return four_wall_residual(room.center, planes, z).e;
                  }),
          trial);
  }
}

TEST(Factors, TwoWallJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(5, static_cast<std::uint64_t>(trial));
    Room room;
    make_room(random, 10.0, room);
    const Plane &a = room.planes[0], &b = room.planes[1];
    const Eigen::Vector2d k = room.center + random.vector(1.0).head<2>();
    const double z = random.uniform(-1.0, 4.0);
    const Eigen::Vector2d c = room.center;
    const TwoWallResidual r = two_wall_residual(c, a, b, k, z);
    expect_near(r.J_center, numeric(2, [&](const auto& s) { return two_wall_residual(c + s, a, b, k, z).e; }), trial);
    expect_near(r.J_plane[0],
                numeric(3, [&](const auto& s) { return two_wall_residual(c, increment(a, s), b, k, z).e; }), trial);
    expect_near(r.J_plane[1],
                numeric(3, [&](const auto& s) { return two_wall_residual(c, a, increment(b, s), k, z).e; }), trial);
  }
}

/// Walls of an L at a random place and heading, counter-clockwise, a little off square; the corner between the fifth
/// and the sixth is an opening's.
struct Ell {
  std::vector<Plane> planes;
  std::vector<RoomCorner> corners = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {5, 0}};
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
};

Ell make_ell(RandomValues& random, double tilt) {
  const Eigen::Vector2d points[6] = {{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}};
  const Pose X = Pose::from_xyz_yaw(random.vector(10.0), random.uniform(-3.0, 3.0));
  Ell ell;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Vector2d side = points[(k + 1) % 6] - points[k];
    const Eigen::Vector3d n(-side.y(), side.x(), 0.0);
    const Plane wall{n.normalized(), -n.normalized().head<2>().dot(points[k])};
    ell.planes.push_back(X * increment(wall, tilt * random.vector(1.0)));
  }
  for (const RoomCorner& corner : ell.corners)
    ell.mean += 0.2 * (X * Eigen::Vector3d(points[corner[1]].x(), points[corner[1]].y(), 0.0)).head<2>();
  return ell;
}

TEST(Factors, PolygonJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(14, static_cast<std::uint64_t>(trial));
    const Ell ell = make_ell(random, 0.02);
    const double z = random.uniform(-1.0, 4.0);
    const Eigen::Vector2d c = ell.mean + random.vector(0.1).head<2>();
    const PolygonResidual r = polygon_residual(c, ell.planes, ell.corners, z);
    expect_near(r.J_center,
                numeric(2, [&](const auto& s) { return polygon_residual(c + s, ell.planes, ell.corners, z).e; }),
                trial);
    for (std::size_t i = 0; i < ell.planes.size(); ++i)
      expect_near(r.J_plane[i],
                  numeric(3,
                          [&](const auto& s) {
                            std::vector<Plane> planes = ell.planes;
                            planes[i] = increment(planes[i], s);
                            return polygon_residual(c, planes, ell.corners, z).e;
                          }),
                  trial);
  }
}

TEST(Factors, PolygonCentreIsTheMeanOfItsCorners) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(15, static_cast<std::uint64_t>(trial));
    const Ell ell = make_ell(random, 0.0);
    EXPECT_LT(polygon_residual(ell.mean, ell.planes, ell.corners, random.gauss()).e.norm(), 1e-11);
  }
  RandomValues random(15, 0);
  const Ell ell = make_ell(random, 0.0);
  const std::vector<RoomCorner> parallel = {{0, 4}};
  EXPECT_THROW((void)polygon_residual(ell.mean, ell.planes, parallel, 0.0), InternalError);
  EXPECT_THROW((void)polygon_residual(ell.mean, ell.planes, {}, 0.0), InternalError);
}

TEST(Factors, FloorJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(16, static_cast<std::uint64_t>(trial));
    const Eigen::Vector2d floor = random.vector(10.0).head<2>(), room = random.vector(10.0).head<2>();
    const Eigen::Vector2d offset = random.vector(5.0).head<2>();
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
    expect_near(I, numeric(2, [&](const auto& s) { return floor_residual(floor + s, room, offset); }), trial);
    expect_near(-I, numeric(2, [&](const auto& s) { return floor_residual(floor, room + s, offset); }), trial);
  }
}

TEST(Factors, DuplicateJacobiansAreTheNumericOnes) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(6, static_cast<std::uint64_t>(trial));
    const Plane a{random.vector(1.0).normalized(), random.uniform(-20.0, 20.0)};
    const Plane b = increment(a, random.vector(0.05));
    const Eigen::Vector3d p = random.vector(10.0);
    const DuplicateResidual r = duplicate_residual(a, b, p);
    expect_near(r.J_a, numeric(3, [&](const auto& s) { return duplicate_residual(increment(a, s), b, p).e; }), trial);
    expect_near(r.J_b, numeric(3, [&](const auto& s) { return duplicate_residual(a, increment(b, s), p).e; }), trial);
  }
}

TEST(Factors, RoomResidualsDoNotDependOnTheMapsOrigin) {
  for (int trial = 0; trial < trials; ++trial) {
    RandomValues random(7, static_cast<std::uint64_t>(trial));
    Room room;
    make_room(random, 5.0, room);
    const Eigen::Vector2d k = room.center + random.vector(1.0).head<2>();
    const Eigen::Vector2d c = room.center + random.vector(0.3).head<2>();
    const Eigen::Vector2d move = random.vector(100.0).head<2>();
    const Pose X_NM{Eigen::Quaterniond::Identity(), {move.x(), move.y(), 0.0}};
    Room moved;
    for (int i = 0; i < 4; ++i) moved.planes[i] = X_NM * room.planes[i];
    // Offsets of about 1e2 m are rounded at 1e-14.
    const Eigen::Vector2d four =
        four_wall_residual(c, room.pointers, 0.3).e - four_wall_residual(c + move, moved.pointers, 0.3).e;
    EXPECT_LT(four.norm(), 1e-11);
    const Eigen::Vector2d two = two_wall_residual(c, room.planes[0], room.planes[1], k, 0.3).e -
                                two_wall_residual(c + move, moved.planes[0], moved.planes[1], k + move, 0.3).e;
    EXPECT_LT(two.norm(), 1e-11);
  }
}

TEST(Factors, NothingIsSingularWithTheOriginAtARoomsCentre) {
  const Plane xa{{1, 0, 0}, 2.0}, xb{{-1, 0, 0}, 2.0}, ya{{0, 1, 0}, 1.5}, yb{{0, -1, 0}, 1.5};
  const Plane* const planes[4] = {&xa, &xb, &ya, &yb};
  const FourWallResidual four = four_wall_residual(Eigen::Vector2d::Zero(), planes, 0.0);
  EXPECT_EQ(four.e.norm(), 0.0);
  EXPECT_NEAR(std::abs(four.J_center.determinant()), 1.0, 1e-12);
  const TwoWallResidual two = two_wall_residual(Eigen::Vector2d::Zero(), xa, xb, Eigen::Vector2d::Zero(), 0.0);
  EXPECT_EQ(two.e.norm(), 0.0);
  EXPECT_NEAR(std::abs(two.J_center.determinant()), 1.0, 1e-12);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(two.J_plane[i].allFinite());
}

TEST(Factors, AgreesWithThePapersCentreForParallelWalls) {
  // Room x in [1, 5], y in [-2, 1]: the paper's centre is (3, -0.5).
  const Plane xa{{1, 0, 0}, -1.0}, xb{{-1, 0, 0}, 5.0}, ya{{0, 1, 0}, 2.0}, yb{{0, -1, 0}, 1.0};
  const Plane* const planes[4] = {&xa, &xb, &ya, &yb};
  const Eigen::Vector2d e = four_wall_residual({3.2, -0.4}, planes, 0.0).e;
  EXPECT_NEAR(e.x(), 0.2, 1e-12);
  EXPECT_NEAR(e.y(), 0.1, 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
