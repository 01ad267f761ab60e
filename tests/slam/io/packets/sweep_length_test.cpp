// SPDX-License-Identifier: Apache-2.0
// The unit of point times, where the spacing of the clouds tells it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/slam/io/packets/turning_cloud.h"

namespace plumbline::slam {
namespace {

/// From clouds so many seconds apart.
template <class T>
AssumedTimes found(double apart_s, const std::string& name, PointType type, T first, T last) {
  SweepLengthSearch search(TimeBase::stamp);
  for (int k = 0; k < 30 && search.add(turn(10.0 + apart_s * k, name, type, first, last)); ++k) continue;
  return search.found();
}

double length_s(const PointCloud& cloud, const PointTimes& times) {
  const Scan scan = scan_of(cloud, times);
  return -1e-9 * *std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
}

TEST(SweepLength, SharesAreOfTheSpacing) {
  const AssumedTimes up = found(0.1, "time", PointType::f32, 0.0F, 1.0F);
  EXPECT_NE(up.said.find("shares of a scan of 100 ms"), std::string::npos) << up.said;
  EXPECT_NEAR(length_s(turn(20.0, "time", PointType::f32, 0.0F, 1.0F), up.times), 0.1, 1e-6);
  const AssumedTimes down = found(0.05, "timestamp", PointType::f64, -1.0, -0.001);
  EXPECT_NEAR(length_s(turn(20.0, "timestamp", PointType::f64, -1.0, -0.001), down.times), 0.05, 1e-3);
}

TEST(SweepLength, WholeNumbersMayBeMicroseconds) {
  const AssumedTimes us = found<std::uint32_t>(0.1, "t", PointType::u32, 0, 99'000);
  EXPECT_EQ(us.times.unit_ns, 1e3) << us.said;
  EXPECT_NE(us.said.find("in us, by which a scan lasts 99 ms"), std::string::npos) << us.said;
  EXPECT_NEAR(length_s(turn<std::uint32_t>(20.0, "t", PointType::u32, 0, 99'000), us.times), 0.099, 1e-6);
  // Every fifth scan of such a bag.
  EXPECT_EQ((found<std::uint32_t>(0.5, "t", PointType::u32, 0, 99'000).times.unit_ns), 1e3);
}

TEST(SweepLength, WhatCanBeIsLeftAsItIs) {
  const auto expect_plain = [](const AssumedTimes& times) {
    EXPECT_EQ(times.times.unit_ns, 0.0) << times.said;
    EXPECT_TRUE(times.said.empty()) << times.said;
  };
  expect_plain(found<std::uint32_t>(0.1, "t", PointType::u32, 0, 99'000'000));
  expect_plain(found<std::uint32_t>(0.5, "t", PointType::u32, 0, 99'000'000));    // each fifth scan was kept
  expect_plain(found<std::uint32_t>(0.0013, "t", PointType::u32, 0, 1'300'000));  // a packet each
  expect_plain(found(0.1, "time", PointType::f32, -0.0998F, 0.0F));
  expect_plain(found(1.0, "time", PointType::f32, 0.0F, 1.0F));  // a slow head
  expect_plain(found(0.1, "time", PointType::f32, 0.0F, 0.0F));
}

TEST(SweepLength, AUnitThatIsToldWithoutTheSpacingIsSaid) {
  const AssumedTimes us = found(0.1, "time", PointType::f32, 0.0F, 99'800.0F);
  EXPECT_EQ(us.times.unit_ns, 1e3);
  EXPECT_EQ(us.said, "point times are taken to be in us, by which a scan lasts 99.8 ms; clouds are 100 ms apart");
  const AssumedTimes ms = found(0.1, "t", PointType::f64, 0.0, 99.8);
  EXPECT_EQ(ms.said, "point times are taken to be in ms, by which a scan lasts 99.8 ms; clouds are 100 ms apart");
  // A cloud of which nearly all is missing has no length by which to tell it.
  EXPECT_NEAR(length_s(turn(20.0, "time", PointType::f32, 40'000.0F, 41'000.0F), us.times), 0.001, 1e-6);
  EXPECT_NEAR(length_s(turn(20.0, "t", PointType::f64, 40.0, 41.0), ms.times), 0.001, 1e-6);
}

TEST(SweepLength, ACloudWithoutPointsTellsNothing) {
  SweepLengthSearch search(TimeBase::stamp);
  EXPECT_TRUE(search.add(PointCloud{}));
  for (int k = 0; k < 30 && search.add(turn<std::uint32_t>(10.0 + 0.1 * k, "t", PointType::u32, 0, 99'000)); ++k)
    continue;
  EXPECT_EQ(search.found().times.unit_ns, 1e3) << search.found().said;
  TimeBaseSearch base;
  EXPECT_TRUE(base.add(PointCloud{}));
  EXPECT_FALSE(base.add(turn(10.0, "timestamp", PointType::f64, 10.0, 10.1)));
  EXPECT_EQ(base.base(), TimeBase::day);
}

// Before a driver knows the time, it may write 0 for long.
TEST(SweepLength, TheUnitIsToldByTheFirstCloudsWithTimes) {
  SweepLengthSearch search(TimeBase::stamp);
  int k = 0;
  for (; k < 500; ++k) ASSERT_TRUE(search.add(turn<std::uint32_t>(10.0 + 0.1 * k, "t", PointType::u32, 0, 0)));
  for (; k < 530 && search.add(turn<std::uint32_t>(10.0 + 0.1 * k, "t", PointType::u32, 0, 99'000)); ++k) continue;
  EXPECT_EQ(search.found().times.unit_ns, 1e3) << search.found().said;
}

TEST(SweepLength, WholeNumbersMayBeginAnewWithEachSecond) {
  TimeBaseSearch base;
  const double first_s = 1'700'000'000.35;
  for (int k = 0; k < 30 && base.add(turn_of_second(first_s + 0.1 * k)); ++k) continue;
  ASSERT_EQ(base.base(), TimeBase::second);
  SweepLengthSearch search(base.base());
  for (int k = 0; k < 30 && search.add(turn_of_second(first_s + 0.1 * k)); ++k) continue;
  const AssumedTimes found = search.found();
  EXPECT_EQ(found.said, "point times are ns within the second, which are taken against the stamps");
  for (int k = 0; k < 30; ++k) {
    const PointCloud cloud = turn_of_second(first_s + 0.1 * k);
    const Scan scan = scan_of(cloud, found.times);
    EXPECT_NEAR(static_cast<double>(scan.stamp - cloud.stamp), 0.099e9, 1.0) << k;
    EXPECT_NEAR(length_s(cloud, found.times), 0.099, 1e-6) << k;
  }
}

// Of a long recording whose clouds have no times, not all is read beforehand.
TEST(SweepLength, TheSearchForTimesEnds) {
  const PointCloud whole = turn<std::uint32_t>(10.0, "t", PointType::u32, 0, 0);
  const PointCloud of_floats = turn(10.0, "timestamp", PointType::f64, 0.0, 0.0);
  PointCloud without_returns = turn(10.0, "timestamp", PointType::f64, 10.0, 10.1);
  for (std::size_t at = 0; at < without_returns.data.size(); at += without_returns.point_step)
    std::memset(&without_returns.data[at], 0, 12);
  for (const PointCloud& cloud : {PointCloud{}, whole, of_floats, without_returns}) {
    int asked = 0;
    for (TimeBaseSearch base; asked < 5000 && base.add(cloud); ++asked) continue;
    EXPECT_EQ(asked, 2999);
    asked = 0;
    for (SweepLengthSearch search(TimeBase::unknown); asked < 5000 && search.add(cloud); ++asked) continue;
    EXPECT_EQ(asked, 2999);
  }
}

// A driver may write -1 where it has no time.
TEST(SweepLength, OneReturnWithoutTimeIsLeftOutOfTimesWithinTheSecond) {
  for (const PointType type : {PointType::u32, PointType::i32}) {
    const auto spoilt = [&](int k) {
      PointCloud cloud = turn_of_second(1'700'000'000.35 + 0.1 * k, 200);
      cloud.fields.back().type = type;
      if (k % 3 == 1) std::memset(&cloud.data[100 * cloud.point_step + 12], 0xFF, 4);
      return cloud;
    };
    TimeBaseSearch base;
    for (int k = 0; k < 30 && base.add(spoilt(k)); ++k) continue;
    ASSERT_EQ(base.base(), TimeBase::second);
    for (int k = 0; k < 30; ++k) {
      const Scan scan = scan_of(spoilt(k), {TimeBase::second, 0.0});
      EXPECT_EQ(std::count_if(scan.range_m.begin(), scan.range_m.end(), [](double range) { return range > 0.0; }),
                k % 3 == 1 ? 199 : 200);
      EXPECT_NEAR(length_s(spoilt(k), {TimeBase::second, 0.0}), 0.099, 1e-6) << k;
    }
  }
}

TEST(SweepLength, WholeNumbersFromTheStampAreNotOfTheSecond) {
  for (const double apart_s : {0.1, 0.05, 1.0, 0.25}) {
    TimeBaseSearch base;
    int k = 0;
    for (; k < 30; ++k)
      if (!base.add(turn<std::uint32_t>(10.0 + apart_s * k, "t", PointType::u32, 1000, 99'000'000))) break;
    EXPECT_LT(k, 30);
    EXPECT_EQ(base.base(), TimeBase::unknown) << apart_s;
  }
}

TEST(SweepLength, WhatFitsNoUnitIsSaid) {
  const AssumedTimes overlapping = found(0.1, "time", PointType::f32, 0.0F, 0.5F);
  EXPECT_EQ(overlapping.times.unit_ns, 0.0);
  EXPECT_NE(overlapping.said.find("measured over 500 ms by their times; clouds are 100 ms apart"), std::string::npos)
      << overlapping.said;
  EXPECT_FALSE((found<std::uint32_t>(0.1, "t", PointType::u32, 0, 300).said.empty()));
}

}  // namespace
}  // namespace plumbline::slam
