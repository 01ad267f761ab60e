// SPDX-License-Identifier: Apache-2.0
#include "slam/io/lidar_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "bim/errors.h"

namespace plumbline::slam {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

class EveryModel : public ::testing::TestWithParam<LidarModelId> {
 protected:
  const LidarModel& model_ = lidar_model(GetParam());
};

TEST_P(EveryModel, RingsRankTheLasersByElevation) {
  std::set<int> rings;
  for (const Laser& a : model_.lasers) {
    rings.insert(a.ring);
    for (const Laser& b : model_.lasers) EXPECT_EQ(a.ring < b.ring, a.elevation_deg < b.elevation_deg);
  }
  EXPECT_EQ(static_cast<int>(rings.size()), model_.rings());
  EXPECT_EQ(*rings.begin(), 0);
}

TEST_P(EveryModel, TablesAgree) {
  Nanoseconds time = 0;
  for (const Laser& laser : model_.lasers) {
    EXPECT_NEAR(laser.cosine, std::cos(laser.elevation_deg * degree), 2e-16);
    EXPECT_NEAR(laser.sine, std::sin(laser.elevation_deg * degree), 2e-16);
    EXPECT_GE(laser.time_ns, time);
    time = laser.time_ns;
  }
  EXPECT_LT(time, model_.firing_period_ns);
  EXPECT_EQ(last_laser_ns(model_), time);
  EXPECT_EQ(velodyne_model(model_.product), model_.product == 0 ? nullptr : &model_);
}

TEST_P(EveryModel, AMessageIsLittleMoreThanATurn) {
  for (const double rpm : {300.0, 600.0, 1200.0}) {
    const std::int64_t firings = firings_per_message(model_, rpm);
    EXPECT_EQ(firings % model_.firings_per_packet, 0);
    const double turns = static_cast<double>(firings * model_.firing_period_ns) * 1e-9 * rpm / 60.0;
    EXPECT_GT(turns, 0.9999) << rpm;  // the OS1's 1,024 columns
    EXPECT_LT(turns, 1.02) << rpm;
  }
  EXPECT_THROW((void)firings_per_message(model_, 299.0), InputError);
  EXPECT_THROW((void)firings_per_message(model_, std::nan("")), InputError);
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel,
                         ::testing::Values(LidarModelId::vlp16, LidarModelId::vlp32c, LidarModelId::hdl32e,
                                           LidarModelId::os1_64),
                         [](const auto& info) { return std::string(lidar_model(info.param).name); });

TEST(LidarModel, RatesFollowTheManuals) {
  EXPECT_EQ(firings_per_message(lidar_model(LidarModelId::vlp16), 600.0), 1824);
  EXPECT_EQ(firings_per_message(lidar_model(LidarModelId::vlp16), 300.0), 151 * 24);
  EXPECT_EQ(firings_per_message(lidar_model(LidarModelId::vlp32c), 600.0), 151 * 12);
  EXPECT_EQ(firings_per_message(lidar_model(LidarModelId::hdl32e), 600.0), 181 * 12);
  EXPECT_EQ(firings_per_message(lidar_model(LidarModelId::os1_64), 600.0), 1024);
  EXPECT_EQ(lidar_model(LidarModelId::vlp32c).lasers[15].elevation_deg, -4.0);  // [velodyne2018a, table 9-2]
  EXPECT_EQ(lidar_model(LidarModelId::vlp32c).lasers[20].azimuth_deg, 4.2);
  EXPECT_EQ(lidar_model(LidarModelId::hdl32e).lasers[31].elevation_deg, 10.67);
}

}  // namespace
}  // namespace plumbline::slam
