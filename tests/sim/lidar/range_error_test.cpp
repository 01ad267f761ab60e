// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/range_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/lidar/detector.h"

namespace plumbline::sim {
namespace {

/// Nothing but systematic errors.
LidarConfig clean() {
  LidarConfig config = lidar_config(LidarPreset::ideal);
  config.dropout = false;
  return config;
}

double error_at(const LidarConfig& config, double range_m, double reflectivity, double cosine, double time_s = 0.0) {
  return range_error(config, time_s, range_m, reflectivity, cosine);
}

TEST(RangeError, IsNothingInTodaysPresets) {
  for (const LidarPreset preset : {LidarPreset::ideal, LidarPreset::datasheet, LidarPreset::real, LidarPreset::full}) {
    const LidarConfig config = lidar_config(preset);
    EXPECT_EQ(config.airborne_per_m, 0.0);
    for (const double range_m : {0.5, 3.0, 40.0})
      for (const double reflectivity : {0.05, 0.5, 90.0}) EXPECT_EQ(error_at(config, range_m, reflectivity, 0.1), 0.0);
  }
}

TEST(RangeError, FallsWithTheDistance) {
  LidarConfig config = clean();
  config.distance_bias_m = 0.04;
  EXPECT_DOUBLE_EQ(error_at(config, 1.0, 0.5, 1.0), -0.04);
  EXPECT_DOUBLE_EQ(error_at(config, 2.4, 0.5, 1.0), -0.04);
  EXPECT_NEAR(error_at(config, 0.5 * (2.4 + 25.0), 0.5, 1.0), -0.02, 1e-12);
  EXPECT_EQ(error_at(config, 60.0, 0.5, 1.0), 0.0);
}

TEST(RangeError, IsLongOnDarkAndShortOnRetroReflectors) {
  LidarConfig config = clean();
  config.reflectivity_bias_m = 0.01;
  EXPECT_NEAR(error_at(config, 5.0, 0.5, 1.0), 0.0, 1e-15);
  EXPECT_NEAR(error_at(config, 5.0, 0.05, 1.0), 0.01, 1e-12);
  EXPECT_NEAR(error_at(config, 5.0, 5.0, 1.0), -0.01, 1e-12);
  EXPECT_NEAR(error_at(config, 5.0, 1e-9, 1.0), 0.02, 1e-12) << "two decades at most";
  EXPECT_NEAR(error_at(config, 5.0, 100.0, 1.0), -0.02, 1e-12);
}

TEST(RangeError, GrowsWithTheFootprintsDepth) {
  LidarConfig config = clean();
  config.incidence_bias_m = 0.03;
  const auto at = [&](double range_m, double degrees) {
    return error_at(config, range_m, 0.5, std::cos(degrees * std::numbers::pi / 180.0));
  };
  EXPECT_NEAR(at(10.0, 80.0), -0.03, 1e-10);
  EXPECT_NEAR(at(5.0, 80.0), -0.015, 1e-10);
  EXPECT_NEAR(at(10.0, 45.0), -0.03 / std::tan(80.0 * std::numbers::pi / 180.0), 1e-10);
  EXPECT_EQ(at(10.0, 0.0), 0.0);
  EXPECT_NEAR(at(10.0, 89.9), at(10.0, 85.0), 1e-9) << "nothing is known beyond 85 degrees";
  EXPECT_NEAR(at(90.0, 80.0), at(20.0, 80.0), 1e-12);
}

TEST(RangeError, OfAColdSensorFades) {
  LidarConfig config = clean();
  config.warm_up_m = 0.02;
  config.warm_up_s = 100.0;
  EXPECT_DOUBLE_EQ(error_at(config, 5.0, 0.5, 1.0, 0.0), 0.02);
  EXPECT_NEAR(error_at(config, 5.0, 0.5, 1.0, 100.0), 0.02 * std::exp(-1.0), 1e-15);
}

/// What comes out of the detector is the sum of them, whatever else is drawn.
TEST(RangeError, AddsToWhatTheDetectorMeasures) {
  LidarConfig config = lidar_config(LidarPreset::real);
  config.dropout = false;
  LidarConfig wrong = lidar_config(LidarPreset::harsh);
  wrong.dropout = false;
  wrong.running_s = 60.0;
  const Detector right(config, 3), detector(wrong, 3);
  const double unit = slam::lidar_model(config.model).range_unit_m;
  for (std::int64_t firing = 0; firing < 2000; firing += 7)
    for (std::size_t laser = 0; laser < 16; ++laser) {
      const double range_m = 1.0 + 0.01 * static_cast<double>(firing),
                   cosine = 0.15 + 0.05 * static_cast<double>(laser);
      const double time_s = 60.0 + 55.296e-6 * static_cast<double>(firing);
      const double expected = range_error(wrong, time_s, range_m, 0.1, cosine);
      const double said =
          unit * (static_cast<double>(detector.measure(firing, laser, 0, range_m, 0.1, cosine).distance) -
                  static_cast<double>(right.measure(firing, laser, 0, range_m, 0.1, cosine).distance));
      EXPECT_NEAR(said, expected, unit) << "two roundings";
    }
}

}  // namespace
}  // namespace plumbline::sim
