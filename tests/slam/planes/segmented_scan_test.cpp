// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/segmented_scan.h"

#include <gtest/gtest.h>

#include <array>

namespace plumbline::slam {
namespace {

TEST(SegmentedScan, ReturnsGoToTheNearestPlaneWhosePatchHoldsThem) {
  PlaneObservation near, far;
  near.plane_R = {{-1, 0, 0}, 2.0};  // x = 2, from y = -1 to 1
  near.p0_R = {2, -1, 0};
  near.p1_R = {2, 1, 0};
  near.z0 = 0.0;
  near.z1 = 2.0;
  far = near;
  far.plane_R.d = 2.06;
  DeskewedScan scan;
  scan.rings = 2;
  scan.columns = 33;
  scan.range_m.assign(66, 0.0);
  scan.point_R.assign(66, Eigen::Vector3d::Zero());
  const auto put = [&](std::size_t slot, const Eigen::Vector3d& p_R) {
    scan.range_m[slot] = p_R.norm();
    scan.point_R[slot] = p_R;
  };
  put(0, {2.01, 0.0, 1.0});
  put(1, {2.05, 1.09, 1.0});  // of the farther plane
  put(2, {2.0, 0.0, 1.0});    // column 1 is left out
  put(32, {2.0, 1.2, 1.0});   // beyond the end
  put(33, {2.0, 0.0, 2.2});   // above
  put(64, {1.94, 0.0, 1.0});  // before it
  const std::array seen = {near, far};
  const SegmentedScan result = segmented_scan(scan, seen);
  EXPECT_EQ(result.plane, (std::vector<int>{0, 1, -1, -1, -1}));
  EXPECT_EQ(result.point_mm[1], Eigen::Vector3i(2050, 1090, 1000));
}

}  // namespace
}  // namespace plumbline::slam
