// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/reference_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds scan_ns = 100'000'000;

constexpr ScanRange all_scans{0, 100 * scan_ns};

/// A path that bends, 0.1 m a scan.
std::vector<slam::StampedPose> bent_path(int poses) {
  std::vector<slam::StampedPose> path;
  Pose X;
  for (int i = 0; i < poses; ++i) {
    path.push_back({i * scan_ns, X});
    X = X * Pose::from_xyz_yaw({0.1, 0.0, 0.0}, 0.05);
  }
  return path;
}

std::vector<slam::StampedPose> moved_path(const Pose& X, std::vector<slam::StampedPose> path) {
  for (slam::StampedPose& pose : path) pose.X_FR = X * pose.X_FR;
  return path;
}

const Pose elsewhere = Pose::from_xyz_yaw({500.0, -30.0, 2.0}, 1.0);

TEST(ReferenceErrors, AreAfterTheAlignmentOfAMap) {
  MethodRecord method;
  method.causal = bent_path(60);
  std::vector<ReportSample> samples(60);
  for (ReportSample& sample : samples) sample.judged = false;
  const std::vector<ReportSample> laid =
      lay_reference(moved_path(elsewhere, bent_path(60)), method, {}, all_scans, samples);
  ASSERT_EQ(laid.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_TRUE(samples[i].judged);
    EXPECT_NEAR(samples[i].error_m, 0.0, 1e-9);
    EXPECT_NEAR(samples[i].yaw_error, 0.0, 1e-9);
    EXPECT_NEAR(laid[i].x, method.causal[i].X_FR.t.x(), 1e-9);  // in the map's own frame
  }
  EXPECT_FALSE(samples[5].relative_m.has_value());
  ASSERT_TRUE(samples[40].relative_m.has_value());
  EXPECT_NEAR(*samples[40].relative_m, 0.0, 1e-9);
}

TEST(ReferenceErrors, InThePlansFrameAreNotAligned) {
  MethodRecord method;
  method.causal = bent_path(30);
  std::vector<ReportSample> samples(30);
  Pose aside;
  aside.t = {0.0, 0.4, 0.0};
  (void)lay_reference(moved_path(aside, bent_path(30)), method, {true, false}, all_scans, samples);
  EXPECT_NEAR(samples[12].error_m, 0.4, 1e-9);
  EXPECT_NEAR(samples[12].error_W.y(), -0.4, 1e-9);
}

TEST(ReferenceErrors, AreWhereTheReferenceHasPoses) {
  MethodRecord method;
  method.causal = bent_path(60);
  std::vector<ReportSample> samples(60);
  for (ReportSample& sample : samples) sample.judged = false;
  std::vector<slam::StampedPose> half = bent_path(60);
  half.resize(30);
  EXPECT_EQ(lay_reference(half, method, {}, {10 * scan_ns, 100 * scan_ns}, samples).size(), 20U);
  EXPECT_TRUE(samples[29].judged);
  EXPECT_FALSE(samples[31].judged);
}

TEST(ReferenceErrors, OfPositionsAloneAreNotOverAMetre) {
  MethodRecord method;
  method.causal = bent_path(60);
  std::vector<slam::StampedPose> positions = bent_path(60);
  for (slam::StampedPose& pose : positions) pose.X_FR.q = Eigen::Quaterniond::Identity();
  std::vector<ReportSample> samples(60);
  const std::vector<ReportSample> laid = lay_reference(moved_path(Pose::from_xyz_yaw({9.0, 0.0, 0.0}, 0.0), positions),
                                                       method, {false, true}, all_scans, samples);
  ASSERT_EQ(laid.size(), 60U);
  EXPECT_NEAR(laid[30].y, method.causal[30].X_FR.t.y(), 1e-6);
  EXPECT_NEAR(samples[40].error_m, 0.0, 1e-6);
  EXPECT_TRUE(samples[40].judged);
  EXPECT_FALSE(samples[40].relative_m.has_value());
}

TEST(ReferenceErrors, AreNoneWithoutAReferenceOfThatTime) {
  MethodRecord method;
  method.causal = bent_path(20);
  std::vector<ReportSample> samples(20);
  samples[3].judged = false;
  EXPECT_TRUE(lay_reference({}, method, {}, all_scans, samples).empty());
  std::vector<slam::StampedPose> later = bent_path(20);
  for (slam::StampedPose& pose : later) pose.stamp += 3600'000'000'000;
  EXPECT_TRUE(lay_reference(later, method, {}, all_scans, samples).empty());
  EXPECT_FALSE(samples[3].judged);
}

}  // namespace
}  // namespace plumbline::scenarios
