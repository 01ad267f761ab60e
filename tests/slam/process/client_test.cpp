// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "slam/process/client/plumbline_client.hpp"

namespace plumbline_client {
namespace {

struct Members {
  double x, y, z;
};

// What others have for a point: a class made of three numbers, or an aggregate.
TEST(PlumblineClient, PointsAreOfTheTypeThatTheMethodHas) {
  const std::vector<double> range = {1.0, 0.0, 2.0};
  const std::vector<wire::Point> point = {{1, 2, 3}, {}, {4, 5, 6}};
  Scan scan;
  scan.range_m = {range.data(), range.size()};
  scan.point_L = {point.data(), point.size()};
  EXPECT_EQ(scan.points<Eigen::Vector3d>(), (std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ((scan.points<std::array<double, 3>>()), (std::vector<std::array<double, 3>>{{1, 2, 3}, {4, 5, 6}}));
  ASSERT_EQ(scan.points<Members>().size(), 2U);
  EXPECT_EQ(scan.points<Members>()[1].z, 6);
}

}  // namespace
}  // namespace plumbline_client
