// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

constexpr double noise_m = 0.004;  // across a wall seen aslant: 12 mm along the beam at 20 degrees
constexpr double spacing_m = 0.05;

/// One ring that looks along a wall at y = -1.1 with a leaf of 0.95 m in it, set back.
DeskewedScan past_a_door(std::uint64_t k, double set_back_m) {
  const Stream random(9, "bim.generate");
  DeskewedScan scan;
  scan.rings = 1;
  std::uint32_t draw = 0;
  for (double x = 1.0; x < 5.0; x += spacing_m) {
    const bool leaf = x > 2.5 && x < 3.45;
    const double y = -1.1 - (leaf ? set_back_m : 0.0) + noise_m * std::sqrt(12.0) * (random.uniform(k, draw++) - 0.5);
    scan.point_R.emplace_back(x, y, 0.3);
    scan.range_m.push_back(std::hypot(x, y));
  }
  scan.columns = static_cast<int>(scan.point_R.size());
  return scan;
}

std::vector<RingSegment> segments_of(const DeskewedScan& scan, const PlaneDetectorConfig& config) {
  return ring_segments(scan, std::vector<Facing>(scan.range_m.size(), Facing::upright), config);
}

/// Largest part of a segment that lies on the wall and on the leaf at once, m: the shorter of its two shares.
double worst_mixture_m(const DeskewedScan& scan, const std::vector<RingSegment>& segments, double middle_y) {
  double worst = 0.0;
  for (const RingSegment& segment : segments) {
    const auto on_leaf = std::count_if(segment.points.begin(), segment.points.end(),
                                       [&](std::uint32_t i) { return scan.point_R[i].y() < middle_y; });
    const auto on_wall = static_cast<std::ptrdiff_t>(segment.points.size()) - on_leaf;
    worst = std::max(worst, spacing_m * static_cast<double>(std::min(on_leaf, on_wall)));
  }
  return worst;
}

// A step of 8 cm is 20 sigmas of the noise: no more than a point may end up on the wrong side, whatever the start.
TEST(RingSegments, ALeafSetBackIsNoLineWithItsWall) {
  PlaneDetectorConfig blind;
  blind.step_chi2 = 1e9;
  for (std::uint64_t k = 0; k < 50; ++k) {
    const DeskewedScan scan = past_a_door(k, 0.08);
    EXPECT_LE(worst_mixture_m(scan, segments_of(scan, {}), -1.14), 1.5 * spacing_m) << k;
    EXPECT_GT(worst_mixture_m(scan, segments_of(scan, blind), -1.14), 0.3) << k;
  }
}

TEST(RingSegments, AWallThatIsFlatStaysWhole) {
  int whole = 0;
  for (std::uint64_t k = 0; k < 200; ++k) whole += segments_of(past_a_door(k, 0.0), {}).size() == 1 ? 1 : 0;
  EXPECT_GE(whole, 198);
}

}  // namespace
}  // namespace plumbline::slam
