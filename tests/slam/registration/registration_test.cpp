// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/registration.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "bim/random/stream.h"
#include "slam/registration/rough_points.h"
#include "slam/registration/vgicp.h"
#include "tests/slam/registration/house_surfels.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

Vector6d random_twist(const Stream& random, std::uint64_t k, double metres, double radians) {
  Vector6d xi;
  for (std::uint32_t i = 0; i < 6; ++i) xi(i) = (i < 3 ? metres : radians) * (2.0 * random.uniform(k, i) - 1.0);
  return xi;
}

TEST(SurfelTest, LieOnTheHouseWithNormalsAcross) {
  const Pose X_WR = Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4);
  const std::vector<Surfel> surfels = surfels_at(X_WR, 0.012, 1);
  ASSERT_GT(surfels.size(), 500U);
  int aligned = 0;
  for (const Surfel& surfel : surfels) {
    const Eigen::Vector3d n_W = X_WR.q * surfel.normal_R;
    EXPECT_NEAR(n_W.norm(), 1.0, 1e-9);
    if (n_W.cwiseAbs().maxCoeff() > std::cos(0.15)) ++aligned;
  }
  EXPECT_GT(aligned, 0.85 * static_cast<double>(surfels.size()));  // the others stand at corners and door posts
}

// 4 m of room about a sensor that stands 0.4 m above the floor: all but the floor's far surfels are seen steeply
// enough.
TEST(SurfelTest, NormalsPointToTheSensor) {
  const Pose X_WR = Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4);
  const std::vector<Surfel> surfels = surfels_at(X_WR, 0.012, 1);
  int facing = 0;
  for (const Surfel& surfel : surfels) {
    if (!surfel.faces_sensor) continue;
    ++facing;
    EXPECT_LT(surfel.normal_R.dot(surfel.mean_R), 0.25 * surfel.mean_R.norm())
        << "a sensor 0.1 m above the robot's origin";
  }
  EXPECT_GT(facing, 0.7 * static_cast<double>(surfels.size()));
}

// A floor is not taken for the ceiling of the storey below, nor a wall for its other side.
TEST(SurfelMapTest, KeepsTheSidesOfASurfaceApart) {
  const Stream random(27, "bim.generate");
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Eigen::Vector3d n = exp_se3(random_twist(random, k, 0.0, 3.0)).q * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d p(0.1, 0.1, 0.1);
    const Surfel front{p, n, 0.0F, true}, back{p - 0.04 * n, -n, 0.0F, true}, unknown{p + 0.01 * n, -n, 0.0F, false};
    SurfelMap map(0.4);
    const auto mean_of = [&](const Surfel& surfel) -> std::optional<Eigen::Vector3d> {
      const std::optional<SurfelMap::Voxel> voxel = map.find(surfel.mean_R, surfel.normal_R, surfel.faces_sensor, 0.9);
      if (!voxel) return std::nullopt;
      return voxel->sum / voxel->n;
    };
    map.add(std::vector{front}, Pose{});
    EXPECT_EQ(mean_of(front), front.mean_R);
    EXPECT_EQ(mean_of(unknown), front.mean_R) << "its side may be this one";
    EXPECT_FALSE(mean_of(back));
    map.add(std::vector{back, unknown}, Pose{});
    const auto near = [](const std::optional<Eigen::Vector3d>& found, const Eigen::Vector3d& expected) {
      return found && (*found - expected).norm() < 1e-9;
    };
    EXPECT_TRUE(near(mean_of(front), 0.5 * (front.mean_R + unknown.mean_R))) << "of either side";
    EXPECT_TRUE(near(mean_of(back), 0.5 * (back.mean_R + unknown.mean_R)));
    map.remove(std::vector{front}, Pose{});
    EXPECT_EQ(mean_of(front), unknown.mean_R) << "which may be the front";
    map.remove(std::vector{back, unknown}, Pose{});
    EXPECT_FALSE(mean_of(back));
  }
}

TEST(SurfelMapTest, RemovingTakesBackWhatWasAdded) {
  const Stream random(21, "bim.generate");
  const std::vector<Surfel> a = surfels_at(Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4), 0.012, 1);
  const std::vector<Surfel> b = surfels_at(Pose::from_xyz_yaw({3.0, 4.5, 0.46}, 1.4), 0.012, 2);
  const Pose X_MR = exp_se3(random_twist(random, 0, 1.0, 1.0));
  SurfelMap one(0.5);
  one.add(b, Pose{});
  SurfelMap both(0.5);
  both.add(a, X_MR);
  both.add(b, Pose{});
  both.remove(a, X_MR);
  for (const Surfel& surfel : b) {
    const std::optional<SurfelMap::Voxel> x = one.find(surfel.mean_R, surfel.normal_R, surfel.faces_sensor, 0.0);
    const std::optional<SurfelMap::Voxel> y = both.find(surfel.mean_R, surfel.normal_R, surfel.faces_sensor, 0.0);
    ASSERT_TRUE(x);
    ASSERT_TRUE(y);
    EXPECT_EQ(x->n, y->n);
    EXPECT_LT((x->sum - y->sum).norm(), 1e-9);
  }
  for (const Surfel& surfel : a) {
    const Eigen::Vector3d p_M = X_MR * surfel.mean_R;
    const Eigen::Vector3d n_M = X_MR.q * surfel.normal_R;
    EXPECT_EQ(one.find(p_M, n_M, surfel.faces_sensor, 0.0).has_value(),
              both.find(p_M, n_M, surfel.faces_sensor, 0.0).has_value());
  }
}

// The gradient against central differences of the cost, at poses where no surfel changes its voxel within the step. A
// surfel's own covariance turns with the pose, which Gauss-Newton leaves out; that part is second order in the
// residual. Of 3,000 surfels 3 m away one leaves its voxel of 0.5 m within 2e-6 rad about an axis, by either of the two
// coordinates that change, in 7 % of the steps: half of them is far more than chance takes.
TEST(RegistrationTest, GradientIsThatOfTheCost) {
  const Stream random(22, "bim.generate");
  const Pose X_WR = Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4);
  const std::vector<Surfel> surfels = surfels_at(X_WR, 0.012, 1);
  SurfelMap map(0.5);
  map.add(surfels, Pose{});
  RegistrationConfig config;
  config.sigma_tangent_m = config.sigma_normal_m = 0.1;  // isotropic covariances do not turn, and the gradient is exact
  constexpr double h = 1e-6;
  constexpr int poses = 20;
  std::array<int, 6> compared{};
  for (std::uint64_t k = 0; k < poses; ++k) {
    const Pose X_MR = exp_se3(random_twist(random, k, 0.03, 0.01));
    const Normal6 at = linearize(surfels, map, X_MR, config);
    for (int i = 0; i < 6; ++i) {
      Vector6d step = Vector6d::Zero();
      step(i) = h;
      const Normal6 up = linearize(surfels, map, X_MR * exp_se3(step), config);
      const Normal6 down = linearize(surfels, map, X_MR * exp_se3(-step), config);
      if (up.inliers != down.inliers) continue;
      const double numeric = (up.cost - down.cost) / (2.0 * h);
      // A surfel that leaves its voxel changes the cost by a share of its own, to one side only; curvature does by 4e-6
      // (50 / m^2 of 3,000 surfels 5 m away, times h^2).
      if (std::abs(up.cost - 2.0 * at.cost + down.cost) > 1e-4) continue;
      ++compared[static_cast<std::size_t>(i)];
      EXPECT_NEAR(at.g(i), numeric, 1e-4 * std::max(1.0, std::abs(numeric)) + 1e-3) << "axis " << i;
    }
  }
  for (const int count : compared) EXPECT_GE(count, poses / 2);
}

double tilt_cost(const TiltPrior& tilt, const Pose& X_MR) {
  constexpr double scale2 = 9.0;
  const double squared = (X_MR.q * tilt.up_R - tilt.up_M).squaredNorm() / (tilt.sigma_rad * tilt.sigma_rad);
  return 0.5 * scale2 * std::log1p(squared / scale2);
}

TEST(TiltPriorTest, GradientIsThatOfTheCost) {
  const Stream random(25, "bim.generate");
  constexpr double h = 1e-6;
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Pose X_MR = exp_se3(random_twist(random, k, 2.0, 3.0));
    const Pose off = exp_se3(random_twist(random, 1000 + k, 0.0, 0.05));
    const TiltPrior tilt{off.q * (X_MR.q.conjugate() * Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitZ(), 0.01};
    Normal6 at;
    add_prior(at, {X_MR, Matrix6d::Zero(), tilt}, X_MR);
    for (int i = 0; i < 6; ++i) {
      Vector6d step = Vector6d::Zero();
      step(i) = h;
      const double numeric =
          (tilt_cost(tilt, X_MR * exp_se3(step)) - tilt_cost(tilt, X_MR * exp_se3(-step))) / (2.0 * h);
      EXPECT_NEAR(at.g(i), numeric, 1e-5 * std::max(1.0, std::abs(numeric)));
    }
  }
}

TEST(TiltPriorTest, SaysNothingAboutHeadingAndPlace) {
  const Stream random(26, "bim.generate");
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Pose X_MR = exp_se3(random_twist(random, k, 2.0, 3.0));
    const Eigen::Vector3d up_R = X_MR.q.conjugate() * Eigen::Vector3d::UnitZ();
    Normal6 sum;
    add_prior(sum, {X_MR, Matrix6d::Zero(), TiltPrior{up_R, Eigen::Vector3d::UnitZ(), 0.01}}, X_MR);
    EXPECT_LT(sum.g.norm(), 1e-9);
    EXPECT_LT((sum.h.bottomRightCorner<3, 3>() * up_R).norm(), 1e-9);
    EXPECT_EQ(sum.h.topRows<3>().norm(), 0.0);
    const Eigen::Vector3d level_R = up_R.unitOrthogonal();
    EXPECT_NEAR(level_R.dot(sum.h.bottomRightCorner<3, 3>() * level_R), 1e4, 1e-6);
  }
}

/// Roll of a robot that stands still, by VGICP, when its odometry says that it rolled by 1 mrad.
double roll_found(bool tilt_prior) {
  VgicpConfig config;
  config.odometry_prior = false;
  config.tilt_prior = tilt_prior;
  config.tilt_rad = 3e-4;
  VgicpOdometry odometry(config);
  MotionBuffer still;
  still.add({0, Pose{}});
  const DeskewedScan scan =
      deskew(synthetic::standing_scan(synthetic::corridor_house(), Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4), {}),
             still, synthetic::calibration());
  (void)odometry.update(scan, Pose{});
  return log_so3(odometry.update(scan, {exp_so3({1e-3, 0.0, 0.0}), Eigen::Vector3d::Zero()}).X_MR.q).x();
}

TEST(VgicpTest, HoldsTheTiltWithoutTheIncrements) { EXPECT_GT(roll_found(true), roll_found(false) + 2e-4); }

// The soffit of a flight of stairs, 32 degrees, meets the level ceiling within one voxel.
TEST(VgicpTest, TakesNoSoffitForACeiling) {
  const VgicpConfig config;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d soffit(std::sin(0.56), 0.0, std::cos(0.56));
  SurfelMap map(config.map_voxel_m);
  map.add(std::vector<Surfel>{{{0.05, 0.05, 0.05}, up}}, Pose{});
  EXPECT_TRUE(map.find({0.06, 0.05, 0.05}, up, false, config.registration.min_normal_agreement));
  EXPECT_FALSE(map.find({0.06, 0.05, 0.05}, soffit, false, config.registration.min_normal_agreement));
}

TEST(RegistrationTest, FindsAPlantedMotionBetweenTwoScans) {
  const Stream random(23, "bim.generate");
  for (std::uint64_t k = 0; k < 12; ++k) {
    const Pose X_WA = Pose::from_xyz_yaw({2.2 + 0.3 * random.gauss(k, 10), 4.2, 0.46}, 6.0 * random.uniform(k, 11));
    const Pose X_AB = exp_se3(random_twist(random, k, 0.25, 0.1));
    SurfelMap map(0.5);
    map.add(surfels_at(X_WA, 0.012, 100 + k), Pose{});
    const std::vector<Surfel> surfels = surfels_at(X_WA * X_AB, 0.012, 200 + k);
    const Registration found = align(surfels, map, Pose{}, std::nullopt, {});
    EXPECT_TRUE(found.converged);
    EXPECT_GT(found.matched, 0.7);
    const Vector6d error = log_se3(X_AB.inverse() * found.X_MR);
    // Measured: up to 5 mm across, 28 mm up (few returns on the floor), 9 mrad.
    EXPECT_LT(error.head<2>().norm(), 0.015) << "run " << k;
    EXPECT_LT(std::abs(error.z()), 0.045) << "run " << k;
    EXPECT_LT(error.tail<3>().norm(), 0.02) << "run " << k;
  }
}

TEST(RegistrationTest, WithoutAMapTheStartIsKeptAndNothingIsClaimed) {
  const std::vector<Surfel> surfels = surfels_at(Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.0), 0.012, 1);
  const Pose start = Pose::from_xyz_yaw({1.0, 2.0, 0.0}, 0.3);
  const Registration found = align(surfels, SurfelMap(0.5), start, std::nullopt, {});
  EXPECT_FALSE(found.converged);
  EXPECT_EQ(found.matched, 0.0);
  EXPECT_EQ(found.X_MR.t, start.t);
}

/// Surfels of an endless corridor along x about the robot: floor, ceiling and two walls, with voxels' own slack.
std::vector<Surfel> corridor_surfels(const Stream& random, bool with_end) {
  std::vector<Surfel> surfels;
  for (std::uint64_t k = 0; k < 1600; ++k) {
    const double x = 16.0 * random.uniform(k, 0) - 8.0, across = 2.0 * random.uniform(k, 1) - 1.0;
    const int side = static_cast<int>(k % 4);
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    if (side < 2) surfels.push_back({{x, sign, across}, {0.0, -sign, 0.0}});
    if (side >= 2) surfels.push_back({{x, across, sign}, {0.0, 0.0, -sign}});
  }
  for (std::uint64_t k = 0; with_end && k < 100; ++k)
    surfels.push_back({{8.0, 2.0 * random.uniform(k, 2) - 1.0, 2.0 * random.uniform(k, 3) - 1.0}, {-1.0, 0.0, 0.0}});
  return surfels;
}

TEST(Observability, ACorridorLeavesTheWayAlongItOpen) {
  const Stream random(43, "bim.generate");
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const Pose X_MR = exp_se3(random_twist(random, trial, 2.0, 1.0));
    for (const bool with_end : {false, true}) {
      const std::vector<Surfel> surfels = corridor_surfels(random, with_end);
      SurfelMap map(0.2);
      map.add(surfels, X_MR);
      const Observability seen = observability(surfels, map, X_MR, {});
      ASSERT_EQ(seen.degenerate_directions.size(), with_end ? 0U : 1U);
      if (with_end) continue;
      EXPECT_GT(std::abs(seen.degenerate_directions.front()(0)), 0.999) << "along x of R";
      Vector6d along = Vector6d::Zero(), across = Vector6d::Zero();
      along(0) = across(1) = 1.0;
      EXPECT_LT((seen.kept * along).norm(), 0.05);
      EXPECT_LT((seen.kept * across - across).norm(), 0.05);
    }
  }
}

// A few surfels fit anywhere.
TEST(Observability, AHandfulOfSurfelsLeavesAllOpen) {
  const std::vector<Surfel> few = {{{2.0, 0.0, -0.6}, {0.0, 0.0, 1.0}}, {{2.0, 0.3, -0.6}, {0.0, 0.0, 1.0}}};
  SurfelMap map(0.2);
  map.add(few, Pose{});
  const Pose start = Pose::from_xyz_yaw({0.03, 0.02, 0.01}, 0.01);
  const Registration found = align(few, map, start, std::nullopt, {});
  EXPECT_EQ(found.unobserved_directions, 6);
  EXPECT_LT((start.inverse() * found.X_MR).t.norm(), 1e-9);
}

// What holds a pose where nothing measures it is no information about it.
TEST(Observability, TheHoldIsNoInformation) {
  const Stream random(45, "bim.generate");
  const std::vector<Surfel> surfels = corridor_surfels(random, false);
  SurfelMap map(0.2);
  map.add(surfels, Pose{});
  const Registration found = align(surfels, map, Pose{}, std::nullopt, {}, {}, 1e-3);
  ASSERT_EQ(found.degenerate_directions, 1);
  EXPECT_LT(found.information(0, 0), 1e-3 * found.information(1, 1));
  EXPECT_NEAR(found.open(0, 0), 1.0, 0.05);
}

// Where surfaces leave a direction open the start stays, whatever the surfels' own places along it would pull.
TEST(Observability, ADegenerateDirectionKeepsTheStart) {
  const Stream random(44, "bim.generate");
  const std::vector<Surfel> surfels = corridor_surfels(random, false);
  SurfelMap map(0.2);
  map.add(surfels, Pose{});
  const Pose start = Pose::from_xyz_yaw({0.07, 0.04, 0.0}, 0.01);
  const Registration found = align(surfels, map, start, std::nullopt, {});
  EXPECT_EQ(found.degenerate_directions, 1);
  EXPECT_EQ(found.unobserved_directions, 1);
  EXPECT_NEAR(found.X_MR.t.x(), 0.07, 0.01);
  EXPECT_NEAR(found.X_MR.t.y(), 0.0, 0.01);
  EXPECT_NEAR(found.X_MR.yaw(), 0.0, 0.005);
}

// They find the place along the corridor, change nothing across it, and leave it unobserved.
TEST(Observability, WhatIsNotSureCountsWhereNothingElseDoes) {
  const Stream random(46, "bim.generate");
  const std::vector<Surfel> surfels = corridor_surfels(random, false);
  SurfelMap map(0.2);
  map.add(surfels, Pose{});
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t k = 0; k < 200; ++k)
    points.emplace_back(16.0 * random.uniform(k, 5) - 8.0, 2.0 * random.uniform(k, 6) - 1.0,
                        2.0 * random.uniform(k, 7) - 1.0);
  RoughMap rough;
  rough.add(points, Pose{}, 20);
  for (Eigen::Vector3d& p_R : points) p_R.y() += 0.1;  // a push across, to which surfels do not yield
  const Pose start = Pose::from_xyz_yaw({0.07, 0.04, 0.0}, 0.01);
  const auto place = [&](bool with) {
    const std::vector<RoughMatch> matches = rough.match(points, start, 0.6);
    return align(surfels, map, start, std::nullopt, {}, {}, 0.1, std::nullopt,
                 with ? [&](const Pose& X_MR) { return linearize(matches, X_MR, 0.2); } : AdditionalFactors{});
  };
  EXPECT_NEAR(place(false).X_MR.t.x(), 0.07, 0.01);
  const Registration found = place(true);
  EXPECT_NEAR(found.X_MR.t.x(), 0.0, 0.02);
  EXPECT_NEAR(found.X_MR.t.y(), 0.0, 0.01);
  EXPECT_EQ(found.unobserved_directions, 1);
}

}  // namespace
}  // namespace plumbline::slam
