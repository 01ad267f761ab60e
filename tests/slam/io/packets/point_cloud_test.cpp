// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/point_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "bim/errors.h"
#include "tests/input_error.h"
#include "tests/slam/io/packets/made_cloud.h"

namespace plumbline::slam {
namespace {

TEST(PointCloud, AnOrganisedCloudGivesBackTheScan) {
  const Scan scan = some_scan();
  const PointCloud cloud = cloud_of(scan, CloudLayout::organised);
  EXPECT_EQ(cloud.height, 1824U);
  EXPECT_EQ(cloud.width, 16U);
  EXPECT_FALSE(cloud.dense);
  const Scan again = scan_of(cloud);
  expect_near(again, scan);
  // A float keeps 24 bits of 0.1 s: 7.5 ns.
  EXPECT_NEAR(static_cast<double>(again.stamp), static_cast<double>(scan.stamp), 8.0);
  for (std::size_t i = 0; i < scan.size(); ++i) EXPECT_NEAR(again.offset_ns[i], scan.offset_ns[i], 16);
}

// Drivers fill what they did not measure with anything.
TEST(PointCloud, TimesOfMissingReturnsAreNotBelieved) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Scan scan = scan_of(
      cloud_with({"x", "y", "z", "time"},
                 {{5, 0, 0, 0.01F}, {nan, nan, nan, nan}, {0, 5, 0, 0.02F}, {0, 0, 0, 1e9F}, {-5, 0, 0, 0.03F}}));
  EXPECT_EQ(std::count_if(scan.range_m.begin(), scan.range_m.end(), [](double r) { return r > 0.0; }), 3);
  EXPECT_NEAR(static_cast<double>(scan.stamp), 3e7, 8.0);
  EXPECT_THROW((void)scan_of(cloud_with({"x", "y", "z", "time"}, {{5, 0, 0, nan}})), InputError);
}

TEST(PointCloud, ADenseCloudGivesBackTheScanWhereThereAreReturns) {
  const Scan scan = some_scan();
  const PointCloud cloud = cloud_of(scan, CloudLayout::dense);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_TRUE(cloud.dense);
  const Scan again = scan_of(cloud);
  expect_near(again, scan);
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0) {
      EXPECT_EQ(again.stamp + again.offset_ns[i], scan.stamp + scan.offset_ns[i]);
    }
}

TEST(PointCloud, WithoutTimesColumnsAreFoundByRingAndAzimuth) {
  const Scan scan = some_scan();
  PointCloud cloud = cloud_of(scan, CloudLayout::dense);
  cloud.fields.pop_back();
  const Scan again = scan_of(cloud);
  ASSERT_EQ(again.columns, scan.columns);  // 85 % of 16 lasers: no firing is without a return
  expect_near(again, scan);
  EXPECT_EQ(again.stamp, cloud.stamp) << "whether it is deskewed is not known";
  for (const std::int32_t offset : again.offset_ns) ASSERT_EQ(offset, 0);
}

TEST(PointCloud, PointsMayComeRingByRing) {
  const Scan scan = some_scan();
  std::vector<std::vector<float>> points;
  for (std::size_t ring = 0; ring < 16; ++ring)
    for (std::size_t i = ring; i < scan.size(); i += 16)
      if (scan.range_m[i] > 0.0)
        points.push_back({static_cast<float>(scan.point_L[i].x()), static_cast<float>(scan.point_L[i].y()),
                          static_cast<float>(scan.point_L[i].z()), static_cast<float>(ring)});
  const Scan again = scan_of(cloud_with({"x", "y", "z", "ring"}, points));
  EXPECT_EQ(again.rings, 16);
  EXPECT_LT(again.columns, 2 * scan.columns);
  const auto returns = [](const Scan& s) {
    return std::count_if(s.range_m.begin(), s.range_m.end(), [](double range) { return range > 0.0; });
  };
  EXPECT_GE(returns(again), static_cast<long>(0.97 * static_cast<double>(returns(scan))));
}

TEST(PointCloud, RingsCountFromTheLowest) {
  std::vector<std::vector<float>> points;
  for (int ring = 0; ring < 32; ++ring)
    points.push_back({5.0F, 0.0F, 0.1F * static_cast<float>(16 - ring), static_cast<float>(ring)});
  const Scan scan = scan_of(cloud_with({"x", "y", "z", "ring"}, points));
  ASSERT_EQ(scan.rings, 32);
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0) {
      EXPECT_NEAR(scan.point_L[i].z(), 0.1 * (static_cast<double>(i % 32) - 15.0), 1e-6);
    }
}

TEST(PointCloud, WithoutRingsOrAKnownSensorAScanHasNoOrder) {
  std::vector<std::vector<float>> points;
  for (int k = 0; k < 500; ++k)
    points.push_back({5.0F, 0.01F * static_cast<float>(k), 0.013F * static_cast<float>(k % 97)});
  const Scan scan = scan_of(cloud_with({"x", "y", "z"}, points));
  EXPECT_EQ(scan.rings, 1);
  EXPECT_EQ(scan.columns, 500);
  EXPECT_EQ(std::count(scan.range_m.begin(), scan.range_m.end(), 0.0), 0);
}

TEST(PointCloud, PointsMayComeAsTheLasersFire) {
  std::vector<std::vector<float>> points;
  for (int column = 0; column < 5; ++column)
    for (int k = 1; k < 15; ++k)  // never the first and the last laser
      points.push_back({5, -0.02F * static_cast<float>(column), static_cast<float>(vlp16::sin_elevation(k)),
                        static_cast<float>(vlp16::ring_of_laser(k))});
  const Scan scan = scan_of(cloud_with({"x", "y", "z", "ring"}, points));
  EXPECT_EQ(scan.columns, 5);
  EXPECT_EQ(std::count(scan.range_m.begin(), scan.range_m.end(), 0.0), 5 * 2);
}

TEST(PointCloud, WithoutRingsTheyAreFoundByElevation) {
  std::vector<std::vector<float>> points;
  for (int ring = 0; ring < 16; ++ring) {
    const double elevation = (2 * ring - 15) * M_PI / 180.0;
    points.push_back({static_cast<float>(5 * std::cos(elevation)), 0, static_cast<float>(5 * std::sin(elevation))});
  }
  const Scan scan = scan_of(cloud_with({"x", "y", "z"}, points));
  ASSERT_EQ(scan.rings, 16);
  ASSERT_EQ(scan.columns, 1);
  for (int ring = 0; ring < 16; ++ring)
    EXPECT_NEAR(scan.point_L[static_cast<std::size_t>(ring)].z(), 5 * std::sin((2 * ring - 15) * M_PI / 180.0), 1e-6);
}

/// 32 lasers from 20 degrees down, evenly apart, round a box of a room; moved_m: R's way during the turn, undone.
std::vector<std::vector<float>> turn_of_32_lasers(double moved_m) {
  std::vector<std::vector<float>> points;
  for (int column = 0; column < 512; ++column)
    for (int ring = 0; ring < 32; ++ring) {
      const double elevation = (1.1 * ring - 20.0) * M_PI / 180.0, azimuth = -2.0 * M_PI * column / 512.0;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const double range = std::min({4.0 / std::max(std::abs(ray.x()), 1e-3), 2.5 / std::max(std::abs(ray.y()), 1e-3),
                                     (ray.z() < 0.0 ? 0.6 : 2.0) / std::max(std::abs(ray.z()), 1e-3)});
      const Eigen::Vector3d p = range * ray - moved_m * (1.0 - column / 512.0) * Eigen::Vector3d::UnitX();
      points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
  return points;
}

TEST(PointCloud, RingsOfAnyLidarAreFoundByItsCones) {
  const Scan scan = scan_of(cloud_with({"x", "y", "z"}, turn_of_32_lasers(0.0)));
  ASSERT_EQ(scan.rings, 32);
  EXPECT_EQ(scan.columns, 512);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_GT(scan.range_m[i], 0.0);
    const double elevation = std::asin(scan.point_L[i].z() / scan.range_m[i]) * 180.0 / M_PI;
    ASSERT_NEAR(elevation, 1.1 * static_cast<double>(i % 32) - 20.0, 1e-3);
  }
  EXPECT_EQ(scan_of(cloud_with({"x", "y", "z"}, turn_of_32_lasers(0.1))).rings, 1) << "deskewed: no cones are left";
}

TEST(PointCloud, WhatIsNoPlaceIsNoReturn) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Scan scan =
      scan_of(cloud_with({"x", "y", "z", "ring"},
                         {{1, 0, 0, 0}, {nan, 0, 0, 1}, {0, inf, 0, 2}, {0, 0, 0, 3}, {1e30F, 0, 0, 4}, {2, 0, 0, 5}}));
  int returns = 0;
  for (const double range : scan.range_m) returns += range > 0.0 ? 1 : 0;
  EXPECT_EQ(returns, 2);
}

TEST(PointCloud, AbsoluteAndRelativeTimesOfOtherTypes) {
  PointCloud cloud = cloud_with({"x", "y", "z", "ring", "low", "high"}, {{1, 0, 0, 0, 0, 0}, {1, 0, 0, 1, 0, 0}});
  cloud.stamp = 1'600'000'000'000'000'000;
  const auto set = [&](std::size_t point, const void* value, std::size_t size) {
    std::memcpy(&cloud.data[24 * point + 16], value, size);
  };
  cloud.fields.resize(4);
  cloud.fields.push_back({"timestamp", 16, PointType::f64});
  const double absolute[2] = {1.6e9 + 0.025, 1.6e9 + 0.05};
  for (std::size_t i = 0; i < 2; ++i) set(i, &absolute[i], 8);
  EXPECT_NEAR(static_cast<double>(scan_of(cloud).stamp - cloud.stamp), 0.05e9, 300.0);  // a double of that size: 240 ns
  cloud.fields.back() = {"t", 16, PointType::u32};
  const std::uint32_t ns[2] = {25'000'000, 50'000'001};
  for (std::size_t i = 0; i < 2; ++i) set(i, &ns[i], 4);
  EXPECT_EQ(scan_of(cloud).stamp - cloud.stamp, 50'000'001);
  cloud.fields.back() = {"time", 16, PointType::f32};
  const float us[2] = {25'000.0F, 50'000.0F};  // microseconds, which some drivers write
  for (std::size_t i = 0; i < 2; ++i) set(i, &us[i], 4);
  EXPECT_EQ(scan_of(cloud).stamp - cloud.stamp, 50'000'000);
  // Neither a scan in any unit nor a time of the day: from the start of something else.
  const float since_start[2] = {37.0F, 37.1F};
  for (std::size_t i = 0; i < 2; ++i) set(i, &since_start[i], 4);
  EXPECT_THROW(static_cast<void>(scan_of(cloud)), InputError);
}

/// Two points, a turn apart by the f64 field `timestamp`.
TEST(PointCloud, WithoutCoordinatesItSaysWhatItHas) {
  const PointCloud cloud = cloud_with({"X", "Y", "Z"}, {{1, 2, 3}});
  EXPECT_EQ(input_error([&] { (void)read_scan(cloud); }), "point cloud without field 'x'; it has X, Y, Z");
}

PointCloud timed_cloud(double stamp_s, double first, double turn) {
  PointCloud cloud = cloud_with({"x", "y", "z", "ring", "low", "high"}, {{1, 0, 0, 0, 0, 0}, {1, 0, 0, 1, 0, 0}});
  cloud.fields.resize(4);
  cloud.fields.push_back({"timestamp", 16, PointType::f64});
  cloud.stamp = std::llround(stamp_s * 1e9);
  for (std::size_t i = 0; i < 2; ++i) {
    const double t = first + turn * static_cast<double>(i);
    std::memcpy(&cloud.data[24 * i + 16], &t, 8);
  }
  return cloud;
}

// A simulator's clock starts at 0, where a time of the day looks like one from the stamp.
TEST(PointCloud, TheTimeBaseIsToldFromSeveralClouds) {
  const auto cloud_at = [](double stamp_s, bool of_day, double unit) {
    return timed_cloud(stamp_s, (of_day ? stamp_s : 0.0) / unit, 0.1 / unit);
  };
  for (const double unit : {1.0, 1e-9})
    for (const bool of_day : {true, false})
      for (const int clouds : {3, 30}) {  // within the first second, and beyond
        TimeBaseSearch search;
        int asked = 0;
        for (; asked < clouds && search.add(cloud_at(0.1 * asked, of_day, unit)); ++asked) continue;
        EXPECT_LT(asked, 25);
        const TimeBase base = search.base();
        EXPECT_EQ(base, of_day ? TimeBase::day : TimeBase::stamp) << unit << " " << clouds;
        const PointCloud cloud = cloud_at(0.4, of_day, unit);
        EXPECT_NEAR(static_cast<double>(scan_of(cloud, {base, 0.0}).stamp), 0.5e9, 1.0) << unit << " " << of_day;
      }
  TimeBaseSearch search;
  EXPECT_FALSE(search.add(cloud_with({"x", "y", "z", "time"}, {{1, 0, 0, 0}})));
  EXPECT_EQ(search.base(), TimeBase::unknown);
}

// Before a driver knows the time, it may write 0.
TEST(PointCloud, ACloudWithoutTimesDecidesNoTimeBase) {
  constexpr double today_s = 1.7e9;
  const PointCloud empty = timed_cloud(today_s, 0.0, 0.0), good = timed_cloud(today_s + 0.1, today_s + 0.1, 0.1);
  TimeBaseSearch search;
  EXPECT_TRUE(search.add(empty) && !search.add(good));
  EXPECT_EQ(search.base(), TimeBase::day);
  EXPECT_NEAR(static_cast<double>(scan_of(good, {search.base(), 0.0}).stamp - good.stamp), 0.1e9, 1e3);
  EXPECT_EQ(scan_of(empty, {search.base(), 0.0}).stamp, empty.stamp);
  TimeBaseSearch never;
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(never.add(empty));
  EXPECT_EQ(never.base(), TimeBase::unknown);
}

/// A cloud of a driver: its fields, and the time of two points 60 and 100 ms after `stamp` as `write` puts it.
struct Driver {
  std::string name;
  std::vector<PointField> fields;
  std::uint32_t step;
  std::function<void(std::uint8_t* point, Nanoseconds after)> write;
  Nanoseconds after_stamp;  ///< of the last point
  double tolerance_ns;
};

// Layouts as the drivers' sources have them: velodyne 2, ouster-ros, livox_ros_driver2, HesaiLidar_ROS_2.0,
// rslidar_sdk.
TEST(PointCloud, CloudsOfFiveDriversGiveTheSameScan) {
  constexpr Nanoseconds stamp = 1'700'000'000'250'000'000;
  const auto put = [](std::uint8_t* to, auto value) { std::memcpy(to, &value, sizeof value); };
  const PointField x{"x", 0, PointType::f32}, y{"y", 4, PointType::f32}, z{"z", 8, PointType::f32};
  const std::vector<Driver> drivers = {
      {"velodyne",
       {x, y, z, {"intensity", 12, PointType::f32}, {"ring", 16, PointType::u16}, {"time", 18, PointType::f32}},
       22,
       [&](std::uint8_t* p, Nanoseconds t) {
         put(p + 18, static_cast<float>(1e-9 * static_cast<double>(t - 100'000'000)));
       },
       0,
       16.0},
      {"ouster",
       {x,
        y,
        z,
        {"intensity", 16, PointType::f32},
        {"t", 20, PointType::u32},
        {"reflectivity", 24, PointType::u16},
        {"ring", 26, PointType::u16},
        {"range", 32, PointType::u32}},
       48,
       [&](std::uint8_t* p, Nanoseconds t) { put(p + 20, static_cast<std::uint32_t>(t)); },
       100'000'000,
       0.0},
      {"livox",
       {x,
        y,
        z,
        {"intensity", 12, PointType::f32},
        {"tag", 16, PointType::u8},
        {"line", 17, PointType::u8},
        {"timestamp", 18, PointType::f64}},
       26,
       [&](std::uint8_t* p, Nanoseconds t) { put(p + 18, static_cast<double>(stamp + t)); },
       100'000'000,
       300.0},
      {"hesai",
       {x, y, z, {"intensity", 12, PointType::f32}, {"ring", 16, PointType::u16}, {"timestamp", 18, PointType::f64}},
       26,
       [&](std::uint8_t* p, Nanoseconds t) { put(p + 18, 1e-9 * static_cast<double>(stamp + t)); },
       100'000'000,
       500.0},
      {"robosense",
       {x, y, z, {"intensity", 12, PointType::f32}, {"ring", 16, PointType::u16}, {"timestamp", 18, PointType::f64}},
       26,
       [&](std::uint8_t* p, Nanoseconds t) { put(p + 18, 1e-9 * static_cast<double>(stamp + t)); },
       100'000'000,
       500.0},
  };
  for (const Driver& driver : drivers) {
    PointCloud cloud;
    cloud.stamp = stamp;
    cloud.fields = driver.fields;
    cloud.point_step = driver.step;
    cloud.width = 2;
    cloud.height = 1;
    cloud.row_step = 2 * driver.step;
    cloud.data.resize(cloud.row_step);
    for (std::size_t i = 0; i < 2; ++i) {
      std::uint8_t* point = &cloud.data[i * driver.step];
      put(point, static_cast<float>(i == 0 ? 3.0 : 0.0));
      put(point + 4, static_cast<float>(i == 0 ? 0.0 : 4.0));
      driver.write(point, i == 0 ? 60'000'000 : 100'000'000);
    }
    const Scan scan = scan_of(cloud);
    EXPECT_NEAR(static_cast<double>(scan.stamp - stamp), static_cast<double>(driver.after_stamp), driver.tolerance_ns)
        << driver.name;
    int returns = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.range_m[i] == 0.0) continue;
      ++returns;
      const double expected = scan.range_m[i] == 3.0 ? -40e6 : 0.0;
      EXPECT_NEAR(scan.offset_ns[i], expected, 1000.0) << driver.name;
    }
    EXPECT_EQ(returns, 2) << driver.name;
  }
}

TEST(PointCloud, WithoutPointsIsAScanWithoutColumns) {
  Scan blind = some_scan(), none;
  std::fill(blind.range_m.begin(), blind.range_m.end(), 0.0);
  none.stamp = 7;
  for (const PointCloud& cloud : {cloud_of(blind, CloudLayout::dense), cloud_of(none, CloudLayout::dense),
                                  cloud_of(none, CloudLayout::organised)}) {
    const Scan scan = scan_of(cloud);
    EXPECT_EQ(scan.stamp, cloud.stamp);
    EXPECT_EQ(scan.columns, 0);
    EXPECT_EQ(scan.rings, 16);
    EXPECT_EQ(scan.size(), 0U);
    EXPECT_TRUE(scan.point_L.empty() && scan.offset_ns.empty() && scan.reflectivity.empty());
  }
}

TEST(PointCloud, RefusesWhatDoesNotFit) {
  const PointCloud good = cloud_of(some_scan(), CloudLayout::organised);
  const auto refuse = [&](const auto& change) {
    PointCloud cloud = good;
    change(cloud);
    EXPECT_THROW(static_cast<void>(scan_of(cloud)), InputError);
  };
  refuse([](PointCloud& c) { c.width = 0; });  // but bytes
  refuse([](PointCloud& c) { c.height = 0xffffffff; });
  refuse([](PointCloud& c) { c.width = c.height = 0xffffffff; });
  refuse([](PointCloud& c) { c.row_step = 1; });
  refuse([](PointCloud& c) { c.data.pop_back(); });
  refuse([](PointCloud& c) { c.fields[0].name = "X"; });
  refuse([](PointCloud& c) { c.fields[0].offset = 19; });
  refuse([](PointCloud& c) { c.fields[0].offset = 0xfffffff0; });
  refuse([](PointCloud& c) { c.fields[0].type = static_cast<PointType>(9); });
}

TEST(PointCloud, ARowsLengthOfZeroIsThatOfItsPoints) {
  const PointCloud good = cloud_of(some_scan(), CloudLayout::organised);
  PointCloud unsaid = good;
  unsaid.row_step = 0;
  EXPECT_EQ(scan_of(unsaid).point_L, scan_of(good).point_L);
  unsaid.data.pop_back();
  EXPECT_THROW(static_cast<void>(scan_of(unsaid)), InputError);
}

}  // namespace
}  // namespace plumbline::slam
