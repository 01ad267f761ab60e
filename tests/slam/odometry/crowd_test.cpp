// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/odometry/front_end.h"
#include "tests/slam/shortened_rays.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// People who walk along with a robot, as round columns about L: returns behind them come from them.
void put_in_a_crowd(Scan& scan) {
  constexpr double radius_m = 0.2, top_m = 1.2;
  for (int who = 0; who < 12; ++who) {
    const double phase = 2.4 * who, x = 0.7 * (who - 5.5) + 0.4 * std::sin(0.8 * seconds(scan.stamp) + phase);
    const double y = (who % 2 == 0 ? 0.5 : -0.5) * (1.2 + 0.5 * std::cos(phase));
    const double away2 = x * x + y * y - radius_m * radius_m;
    shorten_rays(scan, [&](double px, double py, double pz) {
      // Where the ray enters the column, as a share of its length: a share^2 - 2 b share + away2 = 0.
      constexpr double never = 1.0;
      const double a = px * px + py * py, b = px * x + py * y, root2 = b * b - a * away2;
      if (b <= 0.0 || root2 <= 0.0) return never;
      const double share = (b - std::sqrt(root2)) / a;
      return share * pz > top_m ? never : share;
    });
  }
}

// Most of what faces the way walks along, each at a speed of its own; the wheels know the way to a half per cent.
TEST(Crowd, OdometryHoldsTheWay) {
  synthetic::WalkConfig walk;
  walk.speed_mps = 1.2;
  walk.duration_s = 6.0;
  walk.odometry_scale = 1.005;
  walk.odometry_sigma = walk.odometry_yaw_sigma = 0.001;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::one_room(40.0, 3.0), {{5.0, 1.5}, {35.0, 1.5}}, walk);
  FrontEnd front_end(LidarOdometryConfig{}, recording.calibration, true);
  const Pose X_MW = recording.truth.front().X_FR.inverse();
  std::size_t record = 0;
  double worst_m = 0.0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    Scan scan = recording.scans[k];
    for (; record < recording.odometry.size() && recording.odometry[record].stamp <= scan.stamp; ++record)
      front_end.on_odometry(recording.odometry[record]);
    put_in_a_crowd(scan);
    DeskewedScan deskewed = front_end.deskewed(scan);
    const Registration odometry = front_end.track(scan, deskewed);
    worst_m = std::max(worst_m, (odometry.X_MR.t - (X_MW * recording.truth[k].X_FR).t).norm());
  }
  EXPECT_LT(worst_m, 0.3);
}

}  // namespace
}  // namespace plumbline::slam
