// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/odometry_clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/geometry/pose.h"

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds millisecond = 1'000'000;

/// Heading of a robot that turns by `rate` to and fro, with a pause now and then.
double yaw_at(double t_s, double rate) { return rate * (std::sin(0.7 * t_s) + 0.5 * std::sin(2.3 * t_s)); }

/// Half a minute of scans at 10 Hz, with a gyro at 100 Hz and odometry at 1000 / `period_ms` Hz that is late.
OdometryClock clock_of(double late_s, int period_ms, double rate = 0.8, double gyro_sign = 1.0) {
  OdometryClock clock;
  for (int k = 1; k <= 300; ++k) {
    slam::SensorFrame frame;
    frame.scan.stamp = k * 100 * millisecond;
    for (int ms = (k - 1) * 100; ms < k * 100; ms += 10) {
      const double t = 1e-3 * ms, omega = (yaw_at(t + 0.005, rate) - yaw_at(t - 0.005, rate)) / 0.01;
      frame.imu.push_back({ms * millisecond, {0.0, 0.0, gyro_sign * omega}, {0.0, 0.0, 9.81}});
      if (ms % period_ms == 0)
        frame.odometry.push_back({ms * millisecond, Pose::from_xyz_yaw({t, 0.0, 0.0}, yaw_at(t - late_s, rate))});
    }
    clock.add(frame);
  }
  return clock;
}

TEST(OdometryClock, FindsTheLag) {
  for (const double late_s : {-0.6, -0.12, 0.0, 0.1, 0.3, 0.75})
    for (const int period_ms : {10, 20, 100}) {
      const std::optional<double> lag = clock_of(late_s, period_ms).lag_s();
      ASSERT_TRUE(lag) << late_s;
      // The gyro's rate counts for the time before its stamp: 5 ms; a step is 50 ms.
      EXPECT_NEAR(*lag, late_s, 0.02) << late_s << ", " << period_ms;
    }
}

TEST(OdometryClock, SaysWhichIsLater) {
  const std::optional<std::string> late = clock_of(0.3, 20).warning(), early = clock_of(-0.3, 20).warning();
  ASSERT_TRUE(late && early);
  EXPECT_NE(late->find(" s later than the IMU"), std::string::npos) << *late;
  EXPECT_NE(early->find(" s earlier than the IMU"), std::string::npos) << *early;
}

TEST(OdometryClock, SaysNothingOfOneClockNorWithoutTurns) {
  EXPECT_FALSE(clock_of(0.0, 20).warning());
  EXPECT_FALSE(clock_of(0.05, 20).warning());
  EXPECT_FALSE(clock_of(0.3, 20, 0.01).warning()) << "hardly a turn";
  EXPECT_FALSE(clock_of(3.0, 20).warning()) << "beyond a second";
  EXPECT_FALSE(OdometryClock().warning());
}

}  // namespace
}  // namespace plumbline::scenarios
