// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/constant_velocity.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace plumbline::slam {
namespace {

/// Answers each scan with a pose 0.1 m on, and records the predictions that it gets.
class Walker final : public Method {
 public:
  explicit Walker(std::vector<Odometry>& told) : told_(told) {}
  void on_odometry(const Odometry& odometry) override { told_.push_back(odometry); }
  [[nodiscard]] Output on_scan(const Scan& scan) override {
    Output output;
    output.stamp = scan.stamp;
    output.X_FR = Pose::from_xyz_yaw({0.1 * scans_++, 0.0, 0.0}, 0.0);
    return output;
  }
  [[nodiscard]] Estimate finish() override { return {}; }

 private:
  std::vector<Odometry>& told_;
  int scans_ = 0;
};

/// How far the predictions move before the last of these scans.
double told_before_last_m(const std::vector<Nanoseconds>& stamps) {
  std::vector<Odometry> told;
  const std::unique_ptr<Method> method = with_constant_velocity(std::make_unique<Walker>(told));
  for (const Nanoseconds stamp : stamps) {
    Scan scan;
    scan.stamp = stamp;
    (void)method->on_scan(scan);
  }
  EXPECT_EQ(told.size(), stamps.size());
  EXPECT_EQ(told.back().stamp, stamps.back());
  return told.back().X_OR.t.x() - told[told.size() - 2].X_OR.t.x();
}

TEST(ConstantVelocity, GoesOnForAsLongAsTheScanTookAndNotThroughAGap) {
  constexpr Nanoseconds period = 100'000'000;
  EXPECT_NEAR(told_before_last_m({0, period, 2 * period, 3 * period}), 0.1, 1e-12);
  EXPECT_NEAR(told_before_last_m({0, period, 2 * period, 4 * period}), 0.2, 1e-12);
  EXPECT_NEAR(told_before_last_m({0, period, 2 * period, 32 * period}), 0.3, 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
