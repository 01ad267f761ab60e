// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/airborne.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/lidar/lidar.h"
#include "sim/lidar/light.h"
#include "tests/bim/rays/box_mesh.h"

namespace plumbline::sim {
namespace {

constexpr std::size_t message = 1824;
constexpr double density_per_m = 0.01;

LidarConfig dusty(slam::ReturnMode returns = slam::ReturnMode::strongest) {
  LidarConfig config = lidar_config(LidarPreset::ideal);
  config.airborne_per_m = density_per_m;
  config.returns = returns;
  return config;
}

TEST(Airborne, TheShareOfEarlyReturnsIsThatOfTheDensity) {
  const Airborne airborne(dusty(), 5);
  const double least_m = slam::lidar_model(slam::LidarModelId::vlp16).range_min_m;
  constexpr int n = 160000;
  for (const double wall_m : {2.0, 5.0, 12.0}) {
    int early = 0;
    for (std::int64_t firing = 0; firing < n / 16; ++firing)
      for (std::size_t laser = 0; laser < 16; ++laser) {
        const auto range_m = airborne.at(firing, laser);
        if (range_m) {
          EXPECT_GE(*range_m, least_m);
        }
        if (range_m && *range_m < wall_m) ++early;
      }
    const double expected = 1.0 - std::exp(-density_per_m * (wall_m - least_m));
    // Five standard errors of a share.
    EXPECT_NEAR(early / static_cast<double>(n), expected, 5.0 * std::sqrt(expected * (1.0 - expected) / n)) << wall_m;
  }
}

class DustyRoom : public ::testing::Test {
 protected:
  bim::BuildingMesh mesh_ = bim::box_room({10.0, 8.0, 3.0});
  bim::RayScene scene_{mesh_};
  std::vector<Pose> standing_ = std::vector<Pose>(message, Pose::from_xyz_yaw({3.0, 3.5, 0.66}, 0.3));
};

TEST_F(DustyRoom, EarlyReturnsLieBeforeTheWallsAndTheOthersStay) {
  const Sweep clear = Lidar(lidar_config(LidarPreset::ideal), 600.0, 2, scene_).sweep(0, standing_);
  const Sweep dust = Lidar(dusty(), 600.0, 2, scene_).sweep(0, standing_);
  std::size_t early = 0;
  double expected = 0.0;
  const slam::LidarModel& model = slam::lidar_model(slam::LidarModelId::vlp16);
  for (std::size_t i = 0; i < clear.words.size(); ++i) {
    ASSERT_GT(clear.words[i].distance, 0U);
    const double wall_m = model.range_unit_m * clear.words[i].distance;
    expected += 1.0 - std::exp(-density_per_m * (wall_m - model.range_min_m));
    const std::size_t slot = i / 16 * 16 + static_cast<std::size_t>(model.lasers[i % 16].ring);
    if ((dust.labels.path[slot] & light_path::airborne) != 0) {
      ++early;
      EXPECT_LE(dust.words[i].distance, clear.words[i].distance);
      EXPECT_EQ(dust.labels.element[slot], -1);
      // Half a word, of which there is one every 2 mm.
      const Eigen::Vector3d origin_W = standing_[0].t + Eigen::Vector3d(0, 0, model.lasers[i % 16].height_m);
      EXPECT_NEAR((dust.labels.point_W[slot] - origin_W).norm(), model.range_unit_m * dust.words[i].distance, 1.001e-3);
    } else {
      EXPECT_EQ(dust.words[i].distance, clear.words[i].distance);
      EXPECT_EQ(dust.labels.element[slot], clear.labels.element[slot]);
    }
  }
  // Five standard deviations of a sum of rare events.
  EXPECT_NEAR(static_cast<double>(early), expected, 5.0 * std::sqrt(expected));
}

TEST_F(DustyRoom, LastReturnsComeFromTheWallsAndDualOnesFromBoth) {
  const Sweep clear = Lidar(lidar_config(LidarPreset::ideal), 600.0, 2, scene_).sweep(0, standing_);
  const Sweep last = Lidar(dusty(slam::ReturnMode::last), 600.0, 2, scene_).sweep(0, standing_);
  const Sweep dual = Lidar(dusty(slam::ReturnMode::dual), 600.0, 2, scene_).sweep(0, standing_);
  const Sweep strongest = Lidar(dusty(), 600.0, 2, scene_).sweep(0, standing_);
  for (std::size_t i = 0; i < clear.words.size(); ++i) {
    EXPECT_EQ(last.words[i].distance, clear.words[i].distance);
    EXPECT_EQ(dual.last[i].distance, clear.words[i].distance);
    EXPECT_EQ(dual.words[i].distance, strongest.words[i].distance);
  }
}

}  // namespace
}  // namespace plumbline::sim
