// SPDX-License-Identifier: Apache-2.0
// Ring numbers of clouds, as drivers and converters write them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bim/errors.h"
#include "tests/slam/io/packets/made_cloud.h"

namespace plumbline::slam {
namespace {

/// The scan with each return's ring as `number` has it, in the order of the points.
std::vector<std::vector<float>> points_of(const Scan& scan, const std::function<int(int)>& number) {
  std::vector<std::vector<float>> points;
  const auto rings = static_cast<std::size_t>(scan.rings);
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0)
      points.push_back({static_cast<float>(scan.point_L[i].x()), static_cast<float>(scan.point_L[i].y()),
                        static_cast<float>(scan.point_L[i].z()),
                        static_cast<float>(number(static_cast<int>(i % rings))), scan.reflectivity[i]});
  return points;
}

// PointXYZIRT has the field though its source had none.
TEST(CloudRings, ARingThatIsTheSameForAllIsNone) {
  const Scan scan = some_scan();
  const PointCloud cloud = cloud_with({"x", "y", "z", "ring", "intensity"}, points_of(scan, [](int) { return 0; }));
  const CloudScan read = read_scan(cloud);
  EXPECT_TRUE(read.rings_left_out);
  ASSERT_EQ(read.scan.columns, scan.columns);
  expect_near(read.scan, scan);
  EXPECT_FALSE(read_scan(cloud_of(scan, CloudLayout::dense)).rings_left_out);
}

// Rows of a solid-state LiDAR.
TEST(CloudRings, RingsBeyondThoseOfASpinningLidarAreLeftOut) {
  const Scan scan = some_scan();
  const auto read_with = [&](const std::function<int(int)>& number) {
    return read_scan(cloud_with({"x", "y", "z", "ring", "intensity"}, points_of(scan, number)));
  };
  for (const int step : {9, 16, 4000}) {
    const CloudScan read = read_with([&](int ring) { return step * ring; });
    EXPECT_TRUE(read.rings_left_out) << step;
    expect_near(read.scan, scan);
  }
  EXPECT_TRUE(read_with([](int ring) { return ring - 1; }).rings_left_out) << "no number";
  EXPECT_FALSE(read_with([](int ring) { return 8 * ring; }).rings_left_out);
  EXPECT_FALSE(read_with([](int ring) { return 8 * (ring + 1); }).rings_left_out) << "128 of those from 1";
}

TEST(CloudRings, AScannerOfOneRingKeepsIt) {
  std::vector<std::vector<float>> points;
  for (int k = 0; k < 360; ++k)
    points.push_back({static_cast<float>(5 * std::cos(k * M_PI / 180)),
                      static_cast<float>(5 * std::sin(k * M_PI / 180)), 0.001F * static_cast<float>(k % 7), 0});
  const CloudScan read = read_scan(cloud_with({"x", "y", "z", "ring"}, points));
  EXPECT_FALSE(read.rings_left_out);
  EXPECT_EQ(read.scan.rings, 16);
}

TEST(CloudRings, RingsInAnyOrderAreSortedByElevation) {
  const Scan scan = some_scan();
  // As the lasers of a VLP-16 fire, from the top, and in no known order.
  const auto laser_of_ring = [](int ring) { return ring < 8 ? 2 * ring : 2 * (ring - 8) + 1; };
  const std::vector<std::function<int(int)>> numbers = {laser_of_ring, [](int ring) { return 15 - ring; },
                                                        [](int ring) { return 7 * ring % 16; }};
  for (const auto& number : numbers) {
    const Scan again = scan_of(cloud_with({"x", "y", "z", "ring", "intensity"}, points_of(scan, number)));
    ASSERT_EQ(again.columns, scan.columns);
    expect_near(again, scan);
  }
  // Two lasers that see nothing do not move the others.
  Scan fewer = scan;
  for (std::size_t i = 0; i < fewer.size(); ++i)
    if (i % 16 == 3 || i % 16 == 15) {
      fewer.range_m[i] = 0.0;
      fewer.point_L[i].setZero();
      fewer.reflectivity[i] = 0.0F;
    }
  expect_near(scan_of(cloud_with({"x", "y", "z", "ring", "intensity"}, points_of(fewer, laser_of_ring))), fewer);
}

TEST(CloudRings, MayBeCountedFromOne) {
  const Scan scan = some_scan();
  for (const auto& number :
       {std::function<int(int)>([](int ring) { return ring + 1; }), {[](int ring) { return 16 - ring; }}}) {
    const Scan again = scan_of(cloud_with({"x", "y", "z", "ring", "intensity"}, points_of(scan, number)));
    ASSERT_EQ(again.rings, scan.rings);
    ASSERT_EQ(again.columns, scan.columns);
    expect_near(again, scan);
  }
}

// The most that a cloud may have.
TEST(CloudRings, AHundredAndTwentyEightMayBeCountedFromOne) {
  const auto rings_from = [](int first) {
    std::vector<std::vector<float>> points;
    for (int k = 0; k < 200; ++k)
      for (int ring = 0; ring < 128; ++ring)
        points.push_back({static_cast<float>(5.0 * std::cos(0.03 * k)), static_cast<float>(-5.0 * std::sin(0.03 * k)),
                          0.02F * static_cast<float>(ring), static_cast<float>(first + ring)});
    return cloud_with({"x", "y", "z", "ring"}, points);
  };
  const Scan from_zero = scan_of(rings_from(0)), from_one = scan_of(rings_from(1));
  EXPECT_EQ(from_one.rings, 128);
  ASSERT_EQ(from_one.columns, from_zero.columns);
  EXPECT_EQ(from_one.range_m, from_zero.range_m);
  EXPECT_TRUE(read_scan(rings_from(2)).rings_left_out);
}

TEST(CloudRings, PartOfATurnMayComeRingByRing) {
  constexpr int columns = 400, rings = 16;
  for (const double from : {-1.0, 2.6}) {  // ahead; across straight behind
    std::vector<std::vector<float>> points;
    for (int ring = 0; ring < rings; ++ring)
      for (int k = 0; k < columns; ++k) {
        const double azimuth = from + 2.0 * k / columns;
        points.push_back({static_cast<float>(5.0 * std::cos(azimuth)), static_cast<float>(5.0 * std::sin(azimuth)),
                          static_cast<float>(0.1 * ring), static_cast<float>(ring)});
      }
    const Scan scan = scan_of(cloud_with({"x", "y", "z", "ring"}, points));
    EXPECT_EQ(std::count_if(scan.range_m.begin(), scan.range_m.end(), [](double range) { return range > 0.0; }),
              columns * rings);
    EXPECT_LT(scan.columns, 2 * columns);
  }
}

// Points that are no return stand anywhere in the order.
TEST(CloudRings, WhatIsNoReturnHasNoOnesTime) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::vector<float>> points;
  for (int k = 0; k < 200; ++k)
    for (int ring = 0; ring < 8; ++ring) {
      const double azimuth = 0.03 * k;
      const bool missing = k > 0 && (k + ring) % 5 == 0;
      points.push_back({missing ? nan : static_cast<float>(5.0 * std::cos(azimuth)),
                        missing ? nan : static_cast<float>(-5.0 * std::sin(azimuth)), static_cast<float>(0.1 * ring),
                        static_cast<float>(ring), static_cast<float>(0.0005 * k)});
    }
  const Scan scan = scan_of(cloud_with({"x", "y", "z", "ring", "time"}, points));
  ASSERT_GE(scan.rings, 8);
  for (int ring = 0; ring < 8; ++ring) {
    ASSERT_GT(scan.range_m[static_cast<std::size_t>(ring)], 0.0);
    EXPECT_NEAR(scan.offset_ns[static_cast<std::size_t>(ring)], -0.0995e9, 1e4) << ring;
  }
}

}  // namespace
}  // namespace plumbline::slam
