// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/odometry_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace plumbline::slam {
namespace {

DeskewedScan one_return(Nanoseconds stamp, const Eigen::Vector3d& p_R) {
  DeskewedScan scan;
  scan.stamp = stamp;
  scan.rings = scan.columns = 1;
  scan.range_m = {p_R.norm()};
  scan.point_R = {p_R};
  return scan;
}

const Eigen::Vector3d first_R(5.0, 0.0, 0.0), better_R(5.0, 1.0, 0.0);

/// Gives these answers, and a scan of first_R that is better_R once it was tracked.
class Scripted final : public OdometryMethod {
 public:
  explicit Scripted(std::vector<OdometryAnswer> answers)
      : OdometryMethod(MapCloudConfig{}), answers_(std::move(answers)) {}

 private:
  DeskewedScan deskewed(const Scan& raw) override { return one_return(raw.stamp, first_R); }
  OdometryAnswer track(const Scan& raw, DeskewedScan& scan) override {
    scan = one_return(raw.stamp, better_R);
    return answers_.at(trajectory().size());
  }

  std::vector<OdometryAnswer> answers_;
};

/// Far enough apart for each scan to enter the map.
OdometryAnswer answer_at(double x, bool accepted) {
  OdometryAnswer answer;
  answer.X_MR.t.x() = x;
  answer.accepted = accepted;
  return answer;
}

Scan scan_at(Nanoseconds stamp) {
  Scan scan;
  scan.stamp = stamp;
  return scan;
}

TEST(OdometryMethod, AnOutputHoldsTheAnswerAndTheDigestsOfTheStages) {
  OdometryAnswer answer = answer_at(2.0, true);
  answer.degenerate_directions = 3;
  answer.digest = 17;
  OdometryAnswer lost = answer_at(4.0, false);
  lost.lost = true;
  Scripted method({answer, lost});
  const Output output = method.on_scan(scan_at(100));
  EXPECT_EQ(output.stamp, 100);
  ASSERT_TRUE(output.X_FR);
  EXPECT_EQ(output.X_FR->t, answer.X_MR.t);
  EXPECT_EQ(output.state, State::converged);
  EXPECT_EQ(output.degenerate_directions, 3);
  ASSERT_EQ(output.digests.size(), 2U);
  EXPECT_EQ(output.digests[0].stage, "deskew");
  EXPECT_EQ(output.digests[0].digest, digest(one_return(100, first_R)));
  EXPECT_EQ(output.digests[1].stage, "odometry");
  EXPECT_EQ(output.digests[1].digest, 17U);
  ASSERT_EQ(output.times.size(), 2U);
  EXPECT_EQ(output.times[0].stage, "deskew");
  EXPECT_EQ(output.times[1].stage, "odometry");
  EXPECT_EQ(method.on_scan(scan_at(200)).state, State::lost);
}

TEST(OdometryMethod, TheMapIsOfTheFirstScanAndOfThoseAcceptedAsTheyWereTracked) {
  Scripted method({answer_at(0.0, false), answer_at(10.0, false), answer_at(20.0, true)});
  for (Nanoseconds stamp = 100; stamp <= 300; stamp += 100) static_cast<void>(method.on_scan(scan_at(stamp)));
  const Estimate estimate = method.finish();
  EXPECT_EQ(estimate.frame, Frame::map);
  ASSERT_EQ(estimate.trajectory.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(estimate.trajectory[k].stamp, static_cast<Nanoseconds>(100 * (k + 1)));
    EXPECT_EQ(estimate.trajectory[k].X_FR.t.x(), 10.0 * static_cast<double>(k));
  }
  std::vector<Eigen::Vector3f> map_M = estimate.map_F;
  std::sort(map_M.begin(), map_M.end(),
            [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a.x() < b.x(); });
  ASSERT_EQ(map_M.size(), 2U);
  EXPECT_EQ(map_M[0], Eigen::Vector3f(5.0F, 1.0F, 0.0F));
  EXPECT_EQ(map_M[1], Eigen::Vector3f(25.0F, 1.0F, 0.0F));
}

}  // namespace
}  // namespace plumbline::slam
