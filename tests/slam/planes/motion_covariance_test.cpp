// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/motion_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "slam/planes/plane_detector.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// From the middle of a room of 6 x 4 m, as a scan that knows nothing of `twist` during it.
DeskewedScan bent_scan(const Vector6d& twist) {
  const Pose X_WR{Eigen::Quaterniond::Identity(), {3.0, 2.0, 0.46}};
  MotionBuffer standing;
  standing.add({0, Pose{}});
  standing.add({10'000'000'000, Pose{}});
  DeskewedScan scan =
      deskew(synthetic::standing_scan(synthetic::one_room(), X_WR, {}), standing, synthetic::calibration());
  correct_motion(scan, twist);
  return scan;
}

/// Largest squared Mahalanobis distance of walls from those without that motion, moved by X.
double worst_wall(const std::vector<PlaneObservation>& bent, const std::vector<PlaneObservation>& straight,
                  const Pose& X) {
  double worst = 0.0;
  int walls = 0;
  for (const PlaneObservation& seen : straight)
    for (const PlaneObservation& b : bent) {
      const Plane a = X * seen.plane_R;
      if (!seen.vertical || !b.vertical || a.n.dot(b.plane_R.n) < 0.9) continue;
      const Tangents t = plane_tangents(b.plane_R.n);
      const Eigen::Vector3d e(t.u.dot(a.n), t.v.dot(a.n), a.d - b.plane_R.d);
      worst = std::max(worst, e.dot(b.covariance.inverse() * e));
      ++walls;
    }
  EXPECT_GE(walls, 4);
  return worst;
}

// A motion of one standard deviation in each direction: 3 degrees of freedom exceed 16 once in a thousand. What it
// moves all walls by is the pose's, so that they are compared with those at half of the sweep.
TEST(MotionCovarianceTest, CoversWhatAnUnknownMotionDoesToWalls) {
  constexpr double gate = 16.0;
  const std::vector<PlaneObservation> straight = detect_planes(bent_scan(Vector6d::Zero()), {});
  for (const double sign : {-1.0, 1.0}) {
    Vector6d twist;
    twist << 0.4, 0.4, 0.4, 0.8 * sign, 0.8, -0.8 * sign;
    DeskewedScan scan = bent_scan(twist);
    scan.twist_sigma = {0.4, 0.8};
    std::vector<PlaneObservation> bent = detect_planes(scan, {});
    const Vector6d half = -0.05 * twist;
    const Pose X{exp_so3(half.tail<3>()), half.head<3>()};
    EXPECT_GT(worst_wall(bent, straight, X), gate);
    add_motion_covariance(bent, scan);
    EXPECT_LT(worst_wall(bent, straight, X), gate);
  }
}

TEST(MotionCovarianceTest, LeavesPlanesOfKnownMotion) {
  const DeskewedScan scan = bent_scan(Vector6d::Zero());
  const std::vector<PlaneObservation> seen = detect_planes(scan, {});
  std::vector<PlaneObservation> same = seen;
  add_motion_covariance(same, scan);
  ASSERT_FALSE(seen.empty());
  for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(same[k].covariance, seen[k].covariance);
}

}  // namespace
}  // namespace plumbline::slam
