// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/point_units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace plumbline::slam {
namespace {

template <class T>
PointCloud whole_cloud(PointType type, const std::array<T, 3>& point) {
  PointCloud cloud;
  constexpr auto size = static_cast<std::uint32_t>(sizeof(T));
  cloud.fields = {{"x", 0, type}, {"y", size, type}, {"z", 2 * size, type}};
  cloud.width = cloud.height = 1;
  cloud.point_step = cloud.row_step = 3 * size;
  cloud.data.resize(cloud.point_step);
  std::memcpy(cloud.data.data(), point.data(), cloud.point_step);
  return cloud;
}

TEST(PointUnits, WholeNumbersAreMillimetres) {
  const CloudScan i16 = read_scan(whole_cloud<std::int16_t>(PointType::i16, {-3000, 4000, 500}));
  const CloudScan i32 = read_scan(whole_cloud<std::int32_t>(PointType::i32, {-300'000, 400'000, 500}));
  EXPECT_TRUE(i16.scan.point_L.front().isApprox(Eigen::Vector3d(-3.0, 4.0, 0.5)));
  EXPECT_NEAR(i32.scan.range_m.front(), 500.0, 0.001);
  PointUnits units;
  units.add(i16);
  ASSERT_EQ(units.said().size(), 1U);
  EXPECT_NE(units.said().front().find("taken as millimetres"), std::string::npos);
}

TEST(PointUnits, FloatsAreMetres) {
  const CloudScan near = read_scan(whole_cloud<float>(PointType::f32, {3, 4, 1}));
  EXPECT_NEAR(*std::max_element(near.scan.range_m.begin(), near.scan.range_m.end()), std::sqrt(26.0), 1e-6);
  PointUnits units;
  units.add(near);
  EXPECT_TRUE(units.said().empty());
  for (int i = 0; i < 2; ++i) units.add(read_scan(whole_cloud<float>(PointType::f32, {3000, 4000, 1})));
  ASSERT_EQ(units.said().size(), 1U);
  EXPECT_NE(units.said().front().find("divide them by 1000"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::slam
