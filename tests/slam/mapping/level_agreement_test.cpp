// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/level_agreement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "slam/graph/optimize.h"
#include "slam/mapping/floor_layer.h"
#include "slam/mapping/s_graphs_plus.h"
#include "slam/mapping/wall_layer.h"
#include "tests/slam/mapping/seen_planes.h"

namespace plumbline::slam {
namespace {

constexpr double step_m = 0.6;

Matrix6d step_covariance(double sigma_m = 0.006, double sigma_rad = 0.002) {
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(sigma_m), Eigen::Vector3d::Constant(sigma_rad);
  return sigmas.cwiseAbs2().asDiagonal();
}

/// How many of these floors, one of each keyframe, stay; each as a plane in M, of a robot that goes along x. The gait
/// rolls it from keyframe to keyframe.
int kept(LevelAgreement& agreement, const std::vector<Plane>& floors_M, const Matrix6d& covariance) {
  int kept = 0;
  Pose former;
  for (std::size_t k = 0; k < floors_M.size(); ++k) {
    const double roll = k % 2 == 0 ? 0.01 : -0.01;
    const Pose X_MR{exp_so3({roll, 0.0, 0.0}), {step_m * static_cast<double>(k), 0.0, 0.5}};
    agreement.add_step(former.inverse() * X_MR, covariance);
    former = X_MR;
    PlaneObservation seen = see_floor(X_MR, 0.0);
    seen.plane_R = X_MR.inverse() * floors_M[k];
    std::vector<PlaneObservation> planes = {see(X_MR, {-50, -2}, {50, -2}), seen};
    agreement.drop_contradicted(planes);
    EXPECT_TRUE(planes[0].vertical) << "walls are not its concern";
    kept += static_cast<int>(planes.size()) - 1;
  }
  return kept;
}

Plane level(double height) { return {Eigen::Vector3d::UnitZ(), -height}; }

/// The tangent plane of ground of this height at x.
template <class Height>
Plane tangent(const Height& height, double x) {
  const double slope = (height(x + 1e-4) - height(x - 1e-4)) / 2e-4;
  const Eigen::Vector3d n = Eigen::Vector3d(-slope, 0.0, 1.0).normalized();
  return {n, -n.dot(Eigen::Vector3d(x, 0.0, height(x)))};
}

TEST(LevelAgreement, KeepsAFloorAndDropsWhatAFitFindsOnMounds) {
  std::vector<Plane> flat, mounds;
  for (int k = 0; k < 60; ++k) {
    flat.push_back(level(0.0));
    mounds.push_back(tangent([](double x) { return 0.3 * std::sin(x / 3.0); }, step_m * k));
  }
  LevelAgreement of_flat{{}}, of_mounds{{}};
  EXPECT_EQ(kept(of_flat, flat, step_covariance()), 60);
  EXPECT_LT(kept(of_mounds, mounds, step_covariance()), 10);
}

TEST(LevelAgreement, OneTableAmongFloorsCostsNoFloor) {
  std::vector<Plane> floors(30, level(0.0));
  floors[12] = level(0.2);
  LevelAgreement agreement{{}};
  EXPECT_EQ(kept(agreement, floors, step_covariance()), 29);
}

TEST(LevelAgreement, ContradictsNothingThatOdometryIsNotSureOf) {
  std::vector<Plane> floors;
  for (int k = 0; k < 30; ++k) floors.push_back(level(0.015 * k));
  LevelAgreement sure{{}}, unsure{{}};
  EXPECT_LT(kept(sure, floors, step_covariance()), 10) << "a ramp of 2.5 %, whose floors all seem level";
  EXPECT_EQ(kept(unsure, floors, step_covariance(0.05, 0.02)), 30);
}

/// A road that bends up: half a metre over 20 m.
double gentle(double x) { return 0.00125 * x * x; }

// A floor of half that is 4 mrad from the median of the latest ones, less than the odometry's drift there.
TEST(LevelAgreement, FindsOverTheWayThatGroundSlopesGently) {
  std::vector<Plane> flat, road;
  for (int k = 0; k < 120; ++k) {
    flat.push_back(level(0.0));
    road.push_back(tangent([](double x) { return 0.5 * gentle(x); }, step_m * k));
  }
  LevelAgreement of_flat{{}}, of_road{{}}, of_latest{{.way_keyframes = 0}};
  EXPECT_EQ(kept(of_flat, flat, step_covariance()), 120);
  EXPECT_LT(kept(of_road, road, step_covariance()), 50);
  EXPECT_EQ(kept(of_latest, road, step_covariance()), 120) << "seen over the latest keyframes it is level";
}

TEST(LevelAgreement, SaysOnceSinceWhenGroundSlopes) {
  LevelAgreement agreement{{}};
  std::vector<int> since;
  for (int k = 0; k < 80; ++k) {
    const Pose X_MR = Pose::from_xyz_yaw({step_m * k, 0.0, 0.5}, 0.0);
    agreement.add_step(k == 0 ? Pose{} : Pose::from_xyz_yaw({step_m, 0.0, 0.0}, 0.0), step_covariance());
    std::vector<PlaneObservation> planes = {see_floor(X_MR, 0.0)};
    planes[0].plane_R = X_MR.inverse() * tangent(gentle, step_m * k);
    agreement.drop_contradicted(planes);
    if (agreement.sloping_since()) since.push_back(*agreement.sloping_since());
  }
  EXPECT_EQ(since, (std::vector<int>{0}));
}

TEST(LevelAgreement, AFloorOfAnotherStoreyIsNoSlope) {
  std::vector<Plane> floors(40, level(0.0));
  floors.insert(floors.end(), 40, level(3.0));
  LevelAgreement agreement{{}};
  EXPECT_EQ(kept(agreement, floors, step_covariance()), 80);
}

/// Largest error of height of a graph of keyframes along the gentle road, whose odometry makes none, m.
double worst_height_m(bool release) {
  WallLayer walls{{}};
  Graph graph;
  Pose X_MR0;
  for (int k = 0; k < 30; ++k) {
    const double x = step_m * k;
    const Pose X_MR{exp_so3({0.0, -std::atan(0.0025 * x), 0.0}), {x, 0.0, gentle(x) + 0.5}};
    graph.keyframes.push_back({k, k == 0 ? X_MR : graph.keyframes.back().X_MR * (X_MR0.inverse() * X_MR), X_MR, 0});
    const Matrix6d information = step_covariance().inverse();
    if (k > 0) graph.pose_factors.push_back({k - 1, k, X_MR0.inverse() * X_MR, information, false});
    X_MR0 = X_MR;
    PlaneObservation seen = see_floor(X_MR, 0.0);
    seen.plane_R = X_MR.inverse() * tangent(gentle, x);
    (void)walls.observe(graph, std::vector<PlaneObservation>{seen}, x);
    (void)optimize(graph, 1, {});
  }
  EXPECT_EQ(graph.planes.size(), 1U) << "step by step the map is bent to one plane";
  if (release) {
    WallLayer::release_floors(graph, 0, 0);
    EXPECT_EQ(floor_plane_of(graph, 0), -1);
    (void)optimize(graph, 1, {});
    EXPECT_EQ(walls.observe(graph, std::vector<PlaneObservation>{see_floor(X_MR0, gentle(X_MR0.t.x()))}, 0.0),
              std::vector<int>{1});
    EXPECT_EQ(floor_plane_of(graph, 0), 1);
  }
  double worst_m = 0.0;
  for (const KeyframeVertex& k : graph.keyframes) worst_m = std::max(worst_m, std::abs(k.X_MR.t.z() - k.X_OR.t.z()));
  return worst_m;
}

TEST(WallLayer, FloorsOfASlopeDoNotBendThePathOnceReleased) {
  EXPECT_GT(worst_height_m(false), 0.2);
  EXPECT_LT(worst_height_m(true), 0.002);
}

TEST(WallLayer, ReleasesFloorsOfOneStorey) {
  Graph graph;
  for (const int storey : {0, 1}) graph.planes.push_back({level(3.0 * storey), PlaneKind::floor, storey});
  for (const int plane : {0, 1, 0, 1}) {
    PlaneFactor factor;
    factor.keyframe = static_cast<int>(graph.plane_factors.size());
    factor.plane = plane;
    factor.information = Eigen::Matrix3d::Identity();
    graph.plane_factors.push_back(factor);
  }
  WallLayer::release_floors(graph, 1, 2);
  EXPECT_FALSE(graph.planes[0].released);
  EXPECT_TRUE(graph.planes[1].released);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(graph.plane_factors[i].information(0, 0), 1.0) << i;
  EXPECT_LT(graph.plane_factors[3].information(0, 0), 1e-6);
}

// On a street that falls by a storey no new storey begins.
TEST(WallLayer, AStoreyWhoseFloorsWereReleasedGoesOn) {
  Graph graph;
  graph.planes.push_back({level(0.0), PlaneKind::floor, 0});
  graph.keyframes.push_back({0, Pose::from_xyz_yaw({0.0, 0.0, 0.5}, 0.0), {}, 0});
  const Pose X_MR = Pose::from_xyz_yaw({80.0, 0.0, -2.5}, 0.0);
  const std::vector<PlaneObservation> seen = {see_floor(X_MR, -3.0)};
  EXPECT_EQ(storey_of(graph, X_MR, seen, {}), 1);
  graph.planes[0].released = true;
  EXPECT_EQ(storey_of(graph, X_MR, seen, {}), 0);
}

TEST(LevelAgreement, ComparesOverNoWayWhereToldSo) {
  LevelAgreement agreement{{.way_keyframes = 0, .way_chi2 = 0.0}};
  EXPECT_EQ(kept(agreement, std::vector<Plane>(80, level(0.0)), step_covariance()), 80);
}

TEST(LevelAgreement, JudgesCeilingsApartFromFloors) {
  LevelAgreement agreement{{}};
  int floors = 0, ceilings = 0;
  for (int k = 0; k < 30; ++k) {
    const Pose X_MR = Pose::from_xyz_yaw({step_m * k, 0.0, 0.5}, 0.0);
    agreement.add_step(k == 0 ? Pose{} : Pose::from_xyz_yaw({step_m, 0.0, 0.0}, 0.0), step_covariance());
    PlaneObservation crown = see_floor(X_MR, 0.0);
    crown.plane_R = X_MR.inverse() * Plane{-Eigen::Vector3d::UnitZ(), 3.0 + 0.2 * (k % 2)};
    std::vector<PlaneObservation> planes = {see_floor(X_MR, 0.0), crown};
    agreement.drop_contradicted(planes);
    for (const PlaneObservation& plane : planes) (plane.plane_R.n.z() > 0.0 ? floors : ceilings) += 1;
  }
  EXPECT_EQ(floors, 30);
  EXPECT_LT(ceilings, 6);
}

// The crown of a tree is seen once, a ceiling from keyframe to keyframe.
TEST(LevelAgreement, UsesNoCeilingThatNothingConfirms) {
  LevelAgreement agreement{{}};
  std::vector<int> kept;
  for (int k = 0; k < 40; ++k) {
    const Pose X_MR = Pose::from_xyz_yaw({step_m * k, 0.0, 0.5}, 0.0);
    agreement.add_step(k == 0 ? Pose{} : Pose::from_xyz_yaw({step_m, 0.0, 0.0}, 0.0), step_covariance());
    std::vector<PlaneObservation> planes;
    if (k % 12 == 0 || k > 36) {
      planes.push_back(see_floor(X_MR, 0.0));
      planes.back().plane_R = X_MR.inverse() * Plane{-Eigen::Vector3d::UnitZ(), 3.0};
    }
    agreement.drop_contradicted(planes);
    if (!planes.empty()) kept.push_back(k);
  }
  EXPECT_EQ(kept, (std::vector<int>{37, 38, 39}));
}

TEST(LevelAgreement, ThePublishedMethodsKeepEveryFloor) {
  EXPECT_FALSE(SGraphsPlusAllWallsConfig().level_agreement.drop);
  EXPECT_FALSE(SGraphs2022Config().level_agreement.drop);
  EXPECT_TRUE(SGraphsPlusConfig().level_agreement.drop);
  const std::vector<Plane> floors = {level(0.0), level(0.2), level(0.0), level(0.2), level(0.0), level(0.2)};
  LevelAgreement off{{.drop = false}};
  EXPECT_EQ(kept(off, floors, step_covariance()), 6);
}

/// Open ground with mounds, a metre from foot to crown.
double ground(double x, double y) { return 0.5 * std::sin(x / 2.5) * std::cos(y / 3.0); }

/// 16 rings from X_WR, without noise; nothing beyond 30 m.
Scan scan_of_ground(const Pose& X_WR, Nanoseconds stamp) {
  constexpr int columns = 360;
  constexpr double least_m = 0.4, most_m = 30.0, stride_m = 0.1;
  Scan scan;
  scan.stamp = stamp;
  scan.columns = columns;
  for (int column = 0; column < columns; ++column)
    for (int ring = 0; ring < scan.rings; ++ring) {
      const double azimuth = -2.0 * M_PI * column / columns, elevation = (2.0 * ring - 15.0) * M_PI / 180.0;
      const Eigen::Vector3d d_R(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const auto over = [&](double range) {
        const Eigen::Vector3d p = X_WR * Eigen::Vector3d(range * d_R);
        return p.z() - ground(p.x(), p.y());
      };
      // Ground and ray together close by less than a metre a metre.
      double above = least_m, below = 0.0;
      while (above < most_m && below == 0.0) {
        const double next = above + std::max(stride_m, over(above));
        (over(next) > 0.0 ? above : below) = next;
      }
      for (int halving = 0; halving < 12 && below > 0.0; ++halving) {
        const double middle = 0.5 * (above + below);
        (over(middle) > 0.0 ? above : below) = middle;
      }
      const double range = below > 0.0 ? above : 0.0;
      scan.range_m.push_back(range);
      scan.point_L.push_back(range * d_R);
      scan.offset_ns.push_back(0);
    }
  return scan;
}

/// Largest error of the pose on a walk over mounds with an odometry that makes none, m.
double worst_error_on_mounds(const SGraphsPlusConfig& config) {
  MethodInput input;
  input.calibration.sensor_height_m = 0.8;
  SGraphsPlus method(input, config);
  Pose X_WR0;
  double worst_m = 0.0;
  for (int k = 0; k < 120; ++k) {
    const double x = 0.15 * k, y = 0.5, d = 0.3;
    const Eigen::Vector3d ahead(2.0 * d, 0.0, ground(x + d, y) - ground(x - d, y));
    const Eigen::Vector3d left(0.0, 2.0 * d, ground(x, y + d) - ground(x, y - d));
    Eigen::Matrix3d R;
    R.col(0) = ahead.normalized();
    R.col(2) = ahead.cross(left).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    const Pose X_WR{Eigen::Quaterniond(R), {x, y, ground(x, y) + 0.8}};
    if (k == 0) X_WR0 = X_WR;
    const Nanoseconds stamp = 100'000'000LL * (k + 1);
    method.on_odometry({stamp, X_WR0.inverse() * X_WR});
    const Output output = method.on_scan(scan_of_ground(X_WR, stamp));
    const Pose X_OM{method.graph().keyframes.front().X_MR.q.conjugate(), Eigen::Vector3d::Zero()};
    worst_m = std::max(worst_m, ((X_OM * *output.X_FR).t - (X_WR0.inverse() * X_WR).t).norm());
  }
  return worst_m;
}

// Measured: 3 cm more with every floor that a fit finds there than without any, 5 mm more with those that agree.
TEST(SGraphsPlus, OpenGroundIsNoFloorThatTheMapIsPulledTo) {
  SGraphsPlusConfig without_floors;
  without_floors.level_agreement.drop = true;
  without_floors.level_agreement.usual_chi2 = without_floors.level_agreement.contradicted_share = 0.0;
  EXPECT_LT(worst_error_on_mounds({}), worst_error_on_mounds(without_floors) + 0.015);
}

}  // namespace
}  // namespace plumbline::slam
