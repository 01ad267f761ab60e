// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <string>

#include "bim/random/stream.h"
#include "slam/odometry/lidar_odometry.h"
#include "slam/registration/match.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {

static void PrintTo(OdometryKind kind, std::ostream* out) {
  *out << EnumNames<OdometryKind>::names[static_cast<std::size_t>(kind)];
}

namespace {

const Pose X_WR = Pose::from_xyz_yaw({2.0, 1.5, 0.5}, 0.3);

loam::Features features_of_a_room(double range_sigma_m) {
  synthetic::WalkConfig config;
  config.vibration = 0.0;
  config.range_sigma_m = range_sigma_m;
  config.dropout = 0.0;
  const Scan scan = synthetic::standing_scan(synthetic::one_room(), X_WR, config);
  MotionBuffer still;
  still.add({0, Pose{}});
  return loam::find_features(deskew(scan, still, synthetic::calibration()), {});
}

/// Distance to the nearest line where two of the room's six faces meet.
double edge_distance(const loam::FeaturePoint& feature) {
  const Eigen::Vector3d p = X_WR * feature.p_R;
  std::array<double, 3> to_faces = {std::min(std::abs(p.x()), std::abs(p.x() - 6.0)),
                                    std::min(std::abs(p.y()), std::abs(p.y() - 4.0)),
                                    std::min(std::abs(p.z()), std::abs(p.z() - 2.8))};
  std::sort(to_faces.begin(), to_faces.end());
  return to_faces[1];
}

// Ten neighbours 2 cm apart see a corner from 10 cm; without noise nothing else is curved so.
TEST(LoamFeaturesTest, EdgesStandWhereFacesMeet) {
  const loam::Features features = features_of_a_room(0.0);
  ASSERT_GT(features.sharp.size(), 20U);
  for (const loam::FeaturePoint& f : features.sharp) EXPECT_LT(edge_distance(f), 0.15);
}

TEST(LoamFeaturesTest, EveryReturnIsAnEdgeOrNone) {
  const loam::Features features = features_of_a_room(0.012);
  EXPECT_GE(features.less_sharp.size(), features.sharp.size());
  EXPECT_GT(features.flat.size(), 200U);
  EXPECT_GT(features.less_flat.size(), 20 * features.less_sharp.size());
  EXPECT_LE(features.less_sharp.size(), 16U * 6U * 20U);
  EXPECT_LE(features.flat.size(), 16U * 6U * 4U);
}

TEST(LoamMatchTest, GradientAgreesWithDifferences) {
  const Stream draws(5, "bim.generate");
  int checked = 0;
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    const auto point = [&](std::uint32_t lane) -> Eigen::Vector3d {
      return 2.0 *
             Eigen::Vector3d(draws.gauss(trial, lane), draws.gauss(trial, lane + 1), draws.gauss(trial, lane + 2));
    };
    std::vector<loam::Match> matches;
    const auto line = loam::line_match(point(0), point(3), point(6));
    const auto plane = loam::plane_match(point(9), point(12), point(15), point(18));
    if (!line || !plane) continue;
    ++checked;
    matches = {*line, *plane};
    const Pose X = exp_se3((Vector6d() << point(21), 0.3 * point(24)).finished());
    const Normal6 normal = loam::linearize(matches, X, 0.5);
    constexpr double h = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const double up = loam::linearize(matches, X * exp_se3(h * Vector6d::Unit(k)), 0.5).cost;
      const double down = loam::linearize(matches, X * exp_se3(-h * Vector6d::Unit(k)), 0.5).cost;
      EXPECT_NEAR(normal.g(k), (up - down) / (2.0 * h), 1e-6 * (1.0 + std::abs(normal.g(k))));
    }
  }
  EXPECT_GT(checked, 30);
}

class LidarOdometryTest : public testing::TestWithParam<OdometryKind> {};

// Measured: 0.03 to 0.06 m, odometry 0.15 m.
TEST_P(LidarOdometryTest, FollowsAWalkThroughADoor) {
  synthetic::WalkConfig config;
  config.range_bias_m = 0.015;
  config.odometry_scale = 1.03;
  config.duration_s = 12.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
  LidarOdometryConfig choice;
  choice.kind = GetParam();
  const std::unique_ptr<LidarOdometry> odometry = make_lidar_odometry(choice);
  MotionBuffer motion;
  for (const Odometry& record : recording.odometry) motion.add(record);
  const Pose X_MW = recording.truth.front().X_FR.inverse();
  double worst = 0.0;
  double legs = 0.0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    const Pose X_OR = motion.at(recording.scans[k].stamp);
    const Registration r = odometry->update(deskew(recording.scans[k], motion, recording.calibration), X_OR);
    const Pose X_MR = X_MW * recording.truth[k].X_FR;
    worst = std::max(worst, (r.X_MR.t - X_MR.t).norm());
    legs = std::max(legs, (X_OR.t - motion.at(recording.scans[0].stamp).t - X_MR.t).norm());
    if (k > 0) {
      EXPECT_GT(r.information.diagonal().minCoeff(), 0.0);
    }
  }
  EXPECT_LT(worst, 0.15);
  EXPECT_LT(worst, 0.7 * legs);
}

// Without a beam model a cloud in the order of a file has no rings, and curvature along it tells nothing.
TEST(LoamOdometryTest, IsLostWhereScansGetNoRings) {
  synthetic::WalkConfig config;
  config.duration_s = 1.5;
  synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
  for (const OdometryKind kind : {OdometryKind::floam, OdometryKind::aloam}) {
    LidarOdometryConfig choice;
    choice.kind = kind;
    choice.floam.beam_model = choice.aloam.beam_model = Beams::none;
    const std::unique_ptr<LidarOdometry> odometry = make_lidar_odometry(choice);
    MotionBuffer still;
    still.add({0, Pose{}});
    for (std::size_t k = 0; k < recording.scans.size(); ++k) {
      const Scan scan = synthetic::without_rings(recording.scans[k]);
      const Registration r = odometry->update_alone(deskew(scan, still, recording.calibration), {});
      EXPECT_FALSE(r.accepted);
      EXPECT_EQ(r.lost, k + 1 >= static_cast<std::size_t>(HealthConfig().bad_scans)) << k;
    }
  }
}

TEST(LoamOdometryTest, FollowsAWalkByScansWithoutRings) {
  synthetic::WalkConfig config;
  config.duration_s = 1.5;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
  for (const OdometryKind kind : {OdometryKind::floam, OdometryKind::aloam}) {
    LidarOdometryConfig choice;
    choice.kind = kind;
    const std::unique_ptr<LidarOdometry> odometry = make_lidar_odometry(choice);
    MotionBuffer motion;
    for (const Odometry& record : recording.odometry) motion.add(record);
    for (std::size_t k = 0; k < recording.scans.size(); ++k) {
      const Scan scan = synthetic::without_rings(recording.scans[k]);
      const Registration r = odometry->update_alone(deskew(scan, motion, recording.calibration), {});
      EXPECT_EQ(r.accepted, k > 0) << k;
      const Pose X_MR = recording.truth.front().X_FR.inverse() * recording.truth[k].X_FR;
      EXPECT_LT((r.X_MR.t - X_MR.t).norm(), 0.05) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, LidarOdometryTest,
                         testing::Values(OdometryKind::vgicp, OdometryKind::floam, OdometryKind::aloam),
                         [](const auto& kind) {
                           return std::string(EnumNames<OdometryKind>::names[static_cast<std::size_t>(kind.param)]);
                         });

}  // namespace
}  // namespace plumbline::slam
