// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "slam/mapping/s_graphs_plus.h"
#include "tests/slam/shortened_rays.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// Share of its length after which a ray from L to (px, py, pz) meets an upright box of 4.6 x 1.8 m about (x, y),
/// turned by yaw, whose top is 1.2 m above L; 1 where it misses.
double share_to_box(double px, double py, double pz, double x, double y, double yaw) {
  constexpr std::array<double, 2> half = {2.3, 0.9};
  constexpr double top_m = 1.2;
  const double c = std::cos(yaw), s = std::sin(yaw);
  const std::array<double, 2> from = {-(c * x + s * y), -(c * y - s * x)}, to = {c * px + s * py, c * py - s * px};
  double in = 0.0, out = 1.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double a = (-half[k] - from[k]) / to[k], b = (half[k] - from[k]) / to[k];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in < out && in * pz < top_m ? in : 1.0;
}

constexpr double radius_m = 100.0;  ///< of the road's bend to the left

/// Vehicles that go along with a robot round a bend, each a little to the side of the one before and hardly faster or
/// slower.
void put_in_traffic(Scan& scan) {
  for (int which = 0; which < 8; ++which) {
    const double phase = 2.4 * which, t = seconds(scan.stamp);
    const double along = (7.0 * (which / 2 - 1.5) + 1.5 * std::sin(0.4 * t + phase)) / radius_m;
    const double aside = (which % 2 == 0 ? 3.2 : -3.2) + 0.15 * std::sin(phase) + 0.1 * std::sin(0.7 * t + phase);
    const double x = (radius_m - aside) * std::sin(along), y = radius_m - (radius_m - aside) * std::cos(along);
    shorten_rays(scan, [&](double px, double py, double pz) { return share_to_box(px, py, pz, x, y, along); });
  }
}

// The sides of vehicles that go along stand where those of others stood before, and turn as the road does: no walls.
TEST(SGraphsPlus, MakesNoWallsOfTraffic) {
  synthetic::WalkConfig walk;
  walk.speed_mps = 12.0;
  walk.duration_s = 4.0;
  walk.vibration = 0.0;
  walk.odometry_sigma = walk.odometry_yaw_sigma = 0.001;
  std::vector<Eigen::Vector2d> way;
  for (int k = 0; k <= 40; ++k)
    way.emplace_back(20.0 + radius_m * std::sin(0.02 * k), 20.0 + radius_m * (1.0 - std::cos(0.02 * k)));
  const synthetic::Recording recording = synthetic::walk(synthetic::one_room(160.0, 160.0), way, walk);
  MethodInput input;
  input.has_odometry = true;
  input.calibration = recording.calibration;
  SGraphsPlus method(input, {});
  std::size_t record = 0, answered = 0;
  for (Scan scan : recording.scans) {
    for (; record < recording.odometry.size() && recording.odometry[record].stamp <= scan.stamp; ++record)
      method.on_odometry(recording.odometry[record]);
    put_in_traffic(scan);
    answered += method.on_scan(scan).state == State::lost ? 0 : 1;
  }
  EXPECT_GT(answered, 35U);
  // 8, where all planes that are seen would give 33: not every scan shows that things move.
  EXPECT_LT(method.finish().planes.size(), 15U);
}

}  // namespace
}  // namespace plumbline::slam
