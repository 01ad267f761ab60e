// SPDX-License-Identifier: Apache-2.0
#include "slam/loop/fitness.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

TEST(Fitness, IsTheMeanSquaredDistanceToTheNearest) {
  const Stream random(5, "bim.generate");
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const auto cloud = [&](std::uint32_t lane, std::size_t n) {
      std::vector<Eigen::Vector3d> points(n);
      for (std::uint32_t k = 0; k < n; ++k)
        points[k] = {random.gauss(trial, lane, 3 * k), random.gauss(trial, lane, 3 * k + 1),
                     random.gauss(trial, lane, 3 * k + 2)};
      return points;
    };
    const std::vector<Eigen::Vector3d> a = cloud(0, 60), b = cloud(1, 40);
    const Pose X_AB = Pose::from_xyz_yaw({0.1, -0.2, 0.3}, 0.5);
    double sum = 0.0;
    for (const Eigen::Vector3d& p : b) {
      double least = 1e9;
      for (const Eigen::Vector3d& q : a) least = std::min(least, (X_AB * p - q).squaredNorm());
      sum += least;
    }
    EXPECT_NEAR(fitness(a, b, X_AB), sum / 40.0, 1e-12);
    EXPECT_NEAR(fitness(a, a, Pose{}), 0.0, 1e-15);
  }
}

TEST(Fitness, WeighsFromTheLeastToTheGreatestVariance) {
  const FitnessConfig config;
  const Matrix6d best = fitness_information(0.0, config), worst = fitness_information(config.limit_m2, config);
  EXPECT_NEAR(best(0, 0), 100.0, 1e-9);
  EXPECT_NEAR(best(3, 3), 100.0, 1e-9);
  EXPECT_NEAR(worst(0, 0), 0.04, 1e-9);
  EXPECT_NEAR(worst(3, 3), 6.25, 1e-9);
  EXPECT_EQ(fitness_information(10.0, config), worst);
  EXPECT_GT(fitness_information(0.02, config)(0, 0), fitness_information(0.03, config)(0, 0));
}

}  // namespace
}  // namespace plumbline::slam
