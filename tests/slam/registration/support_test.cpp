// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "bim/random/stream.h"
#include "tests/slam/registration/house_surfels.h"

namespace plumbline::slam {
namespace {

constexpr double noise_m = 0.012;

/// Of scans from one place, the map among them.
class Support : public ::testing::Test {
 protected:
  Support() {
    for (std::uint64_t seed = 100; seed < 105; ++seed) map_.add(surfels_at(X_WR_, noise_m, seed), Pose{});
  }
  [[nodiscard]] LeastSupported of(const std::vector<Surfel>& surfels) const {
    return least_supported(surfels, map_, Pose{}, {}, align(surfels, map_, Pose{}, std::nullopt, {}).residual_m);
  }

  const Pose X_WR_ = Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4);
  SurfelMap map_{0.5};
};

TEST_F(Support, OfWhatStandsIsMuchInAllDirections) {
  for (std::uint64_t seed = 2; seed < 12; ++seed) EXPECT_GT(of(surfels_at(X_WR_, noise_m, seed)).share, 0.45) << seed;
}

// Three of four surfels that face a direction have gone on by what people walk from scan to scan, or by more.
TEST_F(Support, IsLeastWhereWhatFacesADirectionMoves) {
  const Stream random(31, "bim.generate");
  for (std::uint64_t k = 0; k < 20; ++k) {
    const Eigen::Vector3d along_R =
        X_WR_.q.conjugate() * (k % 2 == 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY());
    const double way_m = 0.1 + 0.3 * random.uniform(k, 0);
    std::vector<Surfel> surfels = surfels_at(X_WR_, noise_m, 2 + k);
    std::size_t facing = 0;
    for (Surfel& surfel : surfels)
      if (std::abs(surfel.normal_R.dot(along_R)) > 0.7 && facing++ % 4 != 0) surfel.mean_R += way_m * along_R;
    ASSERT_GT(facing, 20U);
    const LeastSupported least = of(surfels);
    EXPECT_LT(least.share, 0.45) << k;
    EXPECT_GT(std::abs(least.direction_R.dot(along_R)), 0.9) << k;
  }
}

// Four of nine surfels that face the way have gone on: odometry tells who moved.
TEST_F(Support, BetweenTheLimitsOdometryIsHeard) {
  constexpr double sigma_m = 0.005;
  const Eigen::Vector3d along_R = X_WR_.q.conjugate() * Eigen::Vector3d::UnitX();
  for (std::uint64_t seed = 2; seed < 12; ++seed) {
    std::vector<Surfel> surfels = surfels_at(X_WR_, noise_m, seed);
    std::size_t facing = 0;
    for (Surfel& surfel : surfels)
      if (std::abs(surfel.normal_R.dot(along_R)) > 0.7 && facing++ % 9 < 4) surfel.mean_R += 0.3 * along_R;
    const double share = least_supported(surfels, map_, Pose{}, {}, noise_m).share;
    ASSERT_GT(share, 0.45) << seed;
    ASSERT_LT(share, 0.8) << seed;
    Registration found;
    found.residual_m = noise_m;
    const auto moving_R = [&](double off_m, bool among_movers = true) {
      return moving_direction(surfels, map_, found, {found.X_MR.q, off_m * along_R}, sigma_m, {}, among_movers);
    };
    EXPECT_FALSE(moving_R(5.0 * sigma_m)) << seed;
    for (const double off_m : {-8.0 * sigma_m, 8.0 * sigma_m}) {
      ASSERT_TRUE(moving_R(off_m)) << seed;
      EXPECT_GT(std::abs(moving_R(off_m)->dot(along_R)), 0.9) << seed;
      EXPECT_FALSE(moving_R(off_m, false)) << seed;
    }
  }
}

// A direction that nothing faces is degenerate; no share is low there.
TEST_F(Support, TellsNothingOfDirectionsThatNothingFaces) {
  std::vector<Surfel> floor;
  for (const Surfel& surfel : surfels_at(X_WR_, noise_m, 2))
    if (surfel.normal_R.z() > 0.99) floor.push_back(surfel);
  ASSERT_GT(floor.size(), 10U);
  EXPECT_GT(of(floor).share, 0.6);
  EXPECT_EQ(of({}).share, 1.0);
}

}  // namespace
}  // namespace plumbline::slam
