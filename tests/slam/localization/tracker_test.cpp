// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/geometry/symmetric.h"
#include "bim/random/stream.h"
#include "slam/localization/associate.h"
#include "slam/localization/tracker_factors.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

constexpr double standing_m = 0.46;

using synthetic::HouseScan;

/// A straight walk in the corridor seen every 0.25 m, with odometry that reads `scale` of the way.
struct Walked {
  PlanIndex index;
  std::vector<Pose> X_IR;
  std::vector<HouseScan> seen;
};

Walked walk_straight(double scale) {
  const synthetic::House house = synthetic::corridor_house();
  Walked walked{make_plan_index(synthetic::plan_of(house), "ground", {}), {}, {}};
  for (int i = 0; i < 8; ++i) {
    const Pose X_WR = Pose::from_xyz_yaw({3.0 + 0.25 * i, 1.0, 0.46}, 0.1);
    const Pose X_OR{Eigen::Quaterniond::Identity(),
                    scale * (Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), -0.1) * Eigen::Vector3d(0.25 * i, 0, 0))};
    walked.X_IR.push_back(walked.index.X_WI.inverse() * X_WR);
    walked.seen.push_back(synthetic::house_scan(house, X_WR, X_OR, static_cast<std::uint64_t>(i + 1)));
  }
  return walked;
}

/// Tracks all scans from a start at the first.
PlanTracker track(const Walked& walked, const Pose& start, const TrackerConfig& config = {}) {
  PlanTracker tracker(config, walked.index.storeys.front(), standing_m);
  tracker.start(walked.seen[0].scan, walked.seen[0].planes, start);
  for (std::size_t i = 1; i < walked.seen.size(); ++i)
    static_cast<void>(tracker.update(walked.seen[i].scan, walked.seen[i].planes));
  return tracker;
}

TEST(Tracker, TakesAnObservedFloorForTheOneThatItStandsOn) {
  StoreyIndex storey = walk_straight(1.0).index.storeys.front();
  const auto rectangle = [](double x0, double x1) { return Polygon2{{x0, 0}, {x1, 0}, {x1, 4}, {x0, 4}}; };
  storey.floors = bim::WalkedFloors{-0.5, {}};
  storey.floors->raised.push_back({{rectangle(2.0, 6.0), {}}, 0.0, -0.75, {0.125, 0.0}});
  storey.floors->raised.push_back({{rectangle(6.0, 9.0), {}}, 0.0, 0.0});
  const std::vector<Plane> planes = storey.floor_planes();
  ASSERT_EQ(planes.size(), 3U);
  for (double x = 0.5; x < 9.0; x += 0.25) {
    const Eigen::Vector2d p(x, 2.0);
    const Pose X_IR = Pose::from_xyz_yaw({x, 2.0, storey.floor_at(p) + standing_m}, 0.3);
    Pose low = X_IR;  // odometry has lost a hand's breadth of height
    low.t.z() -= 0.1;
    for (const Plane& plane : planes) {
      PlaneObservation observed;
      observed.plane_R = X_IR.inverse() * plane;
      EXPECT_LT((nearest_floor(storey, observed, low, standing_m, {}).n - plane.n).norm(), 1e-9) << x;
      EXPECT_NEAR(nearest_floor(storey, observed, low, standing_m, {}).d, plane.d, 1e-9) << x;
    }
  }
}

TEST(Tracker, WithoutTheRoomFactorIsAsWithPairsThatWeighNothing) {
  const Walked walked = walk_straight(1.0);
  Pose start = walked.X_IR.front();
  start.t += Eigen::Vector3d(0.04, -0.05, 0.03);
  TrackerConfig without, nothing;
  without.room_factor = false;
  nothing.pair_sigma_m = 1e6;
  const Eigen::Vector3d with_t = track(walked, start).window().back().X_IR.t,
                        without_t = track(walked, start, without).window().back().X_IR.t,
                        nothing_t = track(walked, start, nothing).window().back().X_IR.t;
  EXPECT_LT((without_t - nothing_t).norm(), 1e-9);
  EXPECT_GT((without_t - with_t).norm(), 1e-7);
}

TEST(Tracker, PullsAWrongStartOntoThePlan) {
  const Walked walked = walk_straight(1.0);
  Pose start = walked.X_IR.front();
  start.t += Eigen::Vector3d(0.04, -0.05, 0.03);
  const PlanTracker tracker = track(walked, start);
  const Pose X_IR = tracker.pose(walked.seen.back().scan.X_OR);
  // Walls across the corridor, its ends and the floor are all seen: measured 1 mm, 0.3 mrad.
  EXPECT_LT((X_IR.t - walked.X_IR.back().t).norm(), 0.005);
  EXPECT_LT(std::abs(wrap_angle(X_IR.yaw() - walked.X_IR.back().yaw())), 0.001);
}

TEST(Tracker, APalletWithMoreReturnsThanTheFloorIsNotTheFloor) {
  Walked walked = walk_straight(1.0);
  for (HouseScan& seen : walked.seen) {
    PlaneObservation pallet;
    pallet.plane_R = {Eigen::Vector3d::UnitZ(), standing_m - 0.2};
    pallet.points = 100000;
    seen.planes.push_back(pallet);
  }
  const PlanTracker tracker = track(walked, walked.X_IR.front());
  ASSERT_EQ(tracker.window().back().floor.size(), 1U);
  EXPECT_NEAR(tracker.window().back().floor.front().plane_R.d, standing_m, 0.02);
}

// Glass and frames stand a hand's breadth behind the face of their wall: a patch there is not the wall.
TEST(Tracker, APatchInAnOpeningIsNotTheWall) {
  const Walked walked = walk_straight(1.0);
  const StoreyIndex& storey = walked.index.storeys.front();
  const auto linked = [&](const StoreyIndex& with) {
    std::vector<int> lines;
    for (const WallLink& link : associate_walls(with, walked.seen[0].scan, walked.seen[0].planes, walked.X_IR[0],
                                                Eigen::Matrix2d::Zero(), TrackerConfig()))
      lines.push_back(link.line);
    return lines;
  };
  const std::vector<int> all = linked(storey);
  ASSERT_GE(all.size(), 3U);
  for (const int line : all) {
    StoreyIndex other = storey;
    WallLine& wall = other.lines[static_cast<std::size_t>(line)];
    wall.openings = {{0.45 * wall.length, 0.55 * wall.length}};
    EXPECT_EQ(linked(other), all) << "a door in wall " << line;
    wall.openings = {{0.0, wall.length}};
    const std::vector<int> less = linked(other);
    EXPECT_EQ(std::count(less.begin(), less.end(), line), 0) << line;
  }
}

TEST(Tracker, CorrectsAnOdometryScaleError) {
  const Walked walked = walk_straight(0.9);
  const PlanTracker tracker = track(walked, walked.X_IR.front());
  const double error = (tracker.pose(walked.seen.back().scan.X_OR).t - walked.X_IR.back().t).norm();
  // 10 % of 1.75 m is 0.175 m; measured 14 mm.
  EXPECT_LT(error, 0.04);
}

TEST(Tracker, PositionAndHeadingAreUncertainTogether) {
  const Walked walked = walk_straight(1.0);
  const PlanTracker tracker = track(walked, walked.X_IR.front());
  const Eigen::Matrix3d& P = tracker.covariance();
  EXPECT_EQ(P, P.transpose());
  EXPECT_GT(P.determinant(), 0.0);
  EXPECT_GT(P.topLeftCorner(2, 2).determinant(), 0.0);
  // Walls seen ahead and behind, not evenly: a turn about the robot moves them all to one side.
  EXPECT_GT(P.topRightCorner(2, 1).norm(), 0.01 * std::sqrt(P(0, 0) * P(2, 2)));
}

/// Fronts of cupboards before both walls along the corridor, as large as what is seen of the walls above them.
void furnish(Walked& walked, double depth_m) {
  for (HouseScan& seen : walked.seen) {
    const std::vector<WallObservation> walls = seen.scan.walls;
    for (const WallObservation& wall : walls) {
      if (std::abs(std::cos(wall.azimuth + 0.1)) > 0.5) continue;
      PlaneObservation front = seen.planes[static_cast<std::size_t>(wall.observation)];
      front.plane_R.d -= depth_m;
      WallObservation before = wall;
      before.distance -= depth_m;
      before.observation = static_cast<int>(seen.planes.size());
      seen.planes.push_back(front);
      seen.scan.walls.push_back(before);
    }
  }
}

double error_of(const PlanTracker& tracker, const Walked& walked) {
  return (tracker.pose(walked.seen.back().scan.X_OR).t - walked.X_IR.back().t).head<2>().norm();
}

// Fronts on both sides look like a range bias, and a range bias moves the robot along a corridor whose one end is seen.
TEST(Tracker, FrontsBeforeTheWallsOfACorridorDoNotMoveTheRobot) {
  Walked walked = walk_straight(1.0);
  for (HouseScan& seen : walked.seen)
    std::erase_if(seen.scan.walls, [](const WallObservation& w) { return std::cos(w.azimuth + 0.1) < -0.5; });
  TrackerConfig believing;
  believing.clutter_sigmas = believing.misplaced_sigmas = 1e3;
  furnish(walked, 0.06);
  // Measured: 7 mm, and 27 mm where all are believed.
  EXPECT_LT(error_of(track(walked, walked.X_IR.front()), walked), 0.012);
  EXPECT_GT(error_of(track(walked, walked.X_IR.front(), believing), walked), 0.02);
}

TEST(Tracker, AWallSeenByFewBeamsHoldsLess) {
  const Walked walked = walk_straight(1.0);
  Walked poor = walked;
  for (HouseScan& seen : poor.seen)
    for (PlaneObservation& plane : seen.planes) plane.covariance(2, 2) += 0.05 * 0.05;
  const Eigen::Matrix3d well = track(walked, walked.X_IR.front()).covariance();
  const Eigen::Matrix3d poorly = track(poor, poor.X_IR.front()).covariance();
  // There is no such noise here, which takes away up to 15/16 of what is said.
  EXPECT_GT(poorly(0, 0), 1.5 * well(0, 0));
  EXPECT_GT(poorly(1, 1), 1.5 * well(1, 1));
}

TEST(Tracker, DropsTheOldestPoseBeyondItsWindow) {
  const Walked walked = walk_straight(1.0);
  TrackerConfig config;
  config.window = 4;
  PlanTracker tracker(config, walked.index.storeys.front(), standing_m);
  tracker.start(walked.seen[0].scan, walked.seen[0].planes, walked.X_IR.front());
  std::size_t left = 0;
  for (std::size_t i = 1; i < walked.seen.size(); ++i)
    left += tracker.update(walked.seen[i].scan, walked.seen[i].planes).size();
  EXPECT_EQ(left, walked.seen.size() - 4);
  EXPECT_EQ(tracker.window().size(), 4U);
}

// Walls along the way hold nothing of the position on it.
TEST(Tracker, KnowsWhatNoWallHolds) {
  Walked walked = walk_straight(1.02);
  for (HouseScan& seen : walked.seen)
    std::erase_if(seen.scan.walls, [](const WallObservation& w) { return std::abs(std::cos(w.azimuth + 0.1)) > 0.5; });
  TrackerConfig config;
  config.window = 2;
  PlanTracker tracker(config, walked.index.storeys.front(), standing_m);
  tracker.start(walked.seen[0].scan, walked.seen[0].planes, walked.X_IR.front());
  double before_m = 0.0;
  for (std::size_t i = 1; i < walked.seen.size(); ++i) {
    static_cast<void>(tracker.update(walked.seen[i].scan, walked.seen[i].planes));
    const double sigma_m = std::sqrt(tracker.covariance()(0, 0));
    EXPECT_GT(sigma_m, before_m);
    before_m = sigma_m;
  }
  const double way_m = 0.25 * static_cast<double>(walked.seen.size() - 2);
  EXPECT_GT(before_m, config.anchor_sigma_m + 0.9 * config.drift_per_m * way_m);
  EXPECT_LT(std::sqrt(tracker.covariance()(1, 1)), config.anchor_sigma_m);
  const std::optional<Eigen::Vector2d> along = tracker.open_direction();
  ASSERT_TRUE(along.has_value());
  EXPECT_GT(std::abs(along->x()), 0.99);

  const Pose& X_OR = walked.seen.back().scan.X_OR;
  const double off_m = (walked.X_IR.back().t - tracker.pose(X_OR).t).head<2>().dot(*along);
  EXPECT_GT(std::abs(off_m), 0.02);
  tracker.correct_along(*along, off_m, 1e-4);
  EXPECT_LT((walked.X_IR.back().t - tracker.pose(X_OR).t).norm(), 0.25 * std::abs(off_m) + 0.01);
  EXPECT_LT(along->dot(tracker.covariance().topLeftCorner<2, 2>() * *along), 1e-4);
}

// Where the open direction goes along with the yaw, as between walls that are not quite parallel.
TEST(Tracker, AMeasurementAlongTheOpenDirectionLeavesACovariance) {
  const Stream stream(9, "slam.localize.init");
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Eigen::Matrix3d A;
    for (std::uint32_t k = 0; k < 9; ++k)
      A(static_cast<int>(k) / 3, static_cast<int>(k) % 3) = stream.gauss(trial, 0, k);
    const Eigen::Vector3d sizes(0.5, 0.01, 0.003);
    const Eigen::Matrix3d P = sizes.asDiagonal() * (A * A.transpose()) * sizes.asDiagonal();
    const double angle = stream.gauss(trial, 1, 0), sigma_m = 0.002 + 0.05 * std::abs(stream.gauss(trial, 1, 1));
    const Eigen::Vector2d along(std::cos(0.1 * angle), std::sin(0.1 * angle));
    const Eigen::Matrix3d after = corrected_along(P, along, sigma_m * sigma_m);
    EXPECT_GT(symmetric_eigen(after).values.minCoeff(), -1e-12 * after.trace()) << trial;
    EXPECT_LE(along.dot(after.topLeftCorner<2, 2>() * along), sigma_m * sigma_m * (1.0 + 1e-9)) << trial;
    EXPECT_NEAR(after(2, 2), P(2, 2), 1e-12 * P(2, 2)) << trial;
  }
}

TEST(Tracker, PairsOpposedWallsOfTheRoom) {
  const Walked walked = walk_straight(1.0);
  const StoreyIndex& storey = walked.index.storeys.front();
  TrackedPose pose;
  pose.X_IR = walked.X_IR.front();
  pose.room = storey.room_at(pose.X_IR.t.head<2>());
  ASSERT_GE(pose.room, 0);
  pose.walls =
      associate_walls(storey, walked.seen[0].scan, walked.seen[0].planes, pose.X_IR, Eigen::Matrix2d::Zero(), {});
  const std::vector<WallPair> pairs = opposed_pairs(storey, pose, {});
  ASSERT_FALSE(pairs.empty());
  for (const WallPair& pair : pairs) {
    const WallLine& a = storey.lines[static_cast<std::size_t>(pose.walls[static_cast<std::size_t>(pair.a)].line)];
    const WallLine& b = storey.lines[static_cast<std::size_t>(pose.walls[static_cast<std::size_t>(pair.b)].line)];
    EXPECT_LT(a.n.dot(b.n), -0.999);
  }
}

}  // namespace
}  // namespace plumbline::slam
