// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/refine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "bim/random/stream.h"
#include "slam/localization/hypotheses.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"
#include "tests/slam/plan_map/box_mesh.h"

namespace plumbline::slam {
namespace {

struct ScanAtPose {
  PlanIndex index;
  LocalizationScan scan;
  Pose2 X_IH;  ///< true
};

ScanAtPose scan_at(const Pose& X_WR) {
  const synthetic::House house = synthetic::corridor_house();
  ScanAtPose at{
      make_plan_index(synthetic::plan_of(house), "ground", {}), synthetic::house_scan(house, X_WR, Pose{}).scan, {}};
  at.X_IH = heading(at.index.X_WI.inverse() * X_WR);
  return at;
}

TEST(Refine, FindsBackFromRandomOffsets) {
  const ScanAtPose at = scan_at(Pose::from_xyz_yaw({3.1, 0.9, 0.46}, 0.3));
  const StoreyIndex& storey = at.index.storeys.front();
  RefineConfig free;
  free.prior_sigma_m = 10.0;
  free.prior_sigma_rad = 10.0;
  free.iterations = 10;
  const Stream stream(9, "slam.localize.init");
  for (std::uint32_t i = 0; i < 30; ++i) {
    Pose2 start = at.X_IH;
    start.t += 0.12 * Eigen::Vector2d(stream.gauss(0, i, 0), stream.gauss(0, i, 1));
    start.yaw += 0.03 * stream.gauss(0, i, 2);
    const Refined refined = refine(storey, start, at.scan, {}, free);
    // 12 mm range noise over 180 beams; measured: 1.5 mm, 0.3 mrad from every start.
    EXPECT_LT((refined.X_IH.t - at.X_IH.t).norm(), 0.005) << i;
    EXPECT_LT(std::abs(wrap_angle(refined.X_IH.yaw - at.X_IH.yaw)), 0.001) << i;
  }
}

// Most of one wall is seen, some of it behind fronts a hand before it.
TEST(Refine, FrontsBeforeAWallDoNotPull) {
  const synthetic::House room = synthetic::one_room(8.0, 4.0);
  synthetic::House built = room;
  for (const double x : {1.0, 3.0, 5.0}) built.boxes.push_back({{x, 0.0, 0.0}, {x + 1.0, 0.10, 2.8}});
  const PlanIndex index = make_plan_index(synthetic::plan_of(room), "ground", {});
  const Pose X_WR = Pose::from_xyz_yaw({3.6, 1.4, 0.46}, 0.3);
  const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}).scan;
  const Pose2 X_IH = heading(index.X_WI.inverse() * X_WR);
  RefineConfig tracking;
  tracking.first_gate_m = tracking.tracking_gate_m;
  RefineConfig least_squares = tracking;
  least_squares.cauchy_share = 100.0;
  const auto error = [&](const RefineConfig& config) {
    return (refine(index.storeys.front(), X_IH, scan, {}, config).X_IH.t - X_IH.t).norm();
  };
  // Measured: 13 and 26 mm.
  EXPECT_LT(error(tracking), 0.6 * error(least_squares));
  EXPECT_LT(error(tracking), 0.02);
}

// A planned wall that is not there, and crates a hand behind where it should be, which few beams end at.
TEST(Refine, AWallThatMostLightGoesThroughHoldsNothing) {
  const synthetic::House room = synthetic::one_room(8.0, 4.0);
  synthetic::House planned = room, built = room;
  planned.boxes.push_back({{3.0, 0.0, 0.0}, {3.1, 4.0, 2.8}});
  for (const double y : {0.3, 1.9, 3.3}) built.boxes.push_back({{3.12, y, 0.0}, {3.5, y + 0.35, 1.0}});
  const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const Pose X_WR = Pose::from_xyz_yaw({1.2, 2.1, 0.46}, 0.3);
  const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}).scan;
  const Pose2 X_IH = heading(index.X_WI.inverse() * X_WR);
  const Refined refined = refine(index.storeys.front(), X_IH, scan, {}, {});
  EXPECT_LT((refined.X_IH.t - X_IH.t).norm(), 0.01);
}

TEST(Refine, AgreementSeparatesTheTruePoseFromAWrongOne) {
  const ScanAtPose at = scan_at(Pose::from_xyz_yaw({3.1, 0.9, 0.46}, 0.3));
  const StoreyIndex& storey = at.index.storeys.front();
  const Agreement right = agreement(storey, at.X_IH, at.scan, {}, {});
  EXPECT_GT(right.inliers, 0.9);
  EXPECT_LT(right.penetration_ratio, 0.05);
  Pose2 wrong = at.X_IH;
  wrong.yaw = wrap_angle(wrong.yaw + 1.57);
  EXPECT_LT(agreement(storey, wrong, at.scan, {}, {}).inliers, 0.5);
}

// The robot walks through a planned wall that is not there: beams leave it by both of its faces.
TEST(Refine, AWallThatWasNotBuiltIsOneWallFromItsInsideToo) {
  const synthetic::House built = synthetic::one_room(8.0, 4.0);
  synthetic::House planned = built;
  planned.boxes.push_back({{3.7, 0.0, 0.0}, {4.1, 4.0, 2.8}});
  const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const StoreyIndex& storey = index.storeys.front();
  const Pose X_WR = Pose::from_xyz_yaw({3.9, 1.7, 0.46}, 1.57);
  const LocalizationScan scan = synthetic::house_scan(built, X_WR, Pose{}).scan;
  const Agreement inside = agreement(storey, heading(index.X_WI.inverse() * X_WR), scan, {}, {});
  EXPECT_GT(inside.penetration_ratio, 0.8);
  EXPECT_LT(inside.penetration_ratio_otherwise(), 0.1);
}

/// What the plan, where one wall of 9 m stands in a hall, says of scans in a building where that wall has openings
/// (from and to along it, m).
Agreement behind_openings(const std::vector<std::pair<double, double>>& openings) {
  const synthetic::House hall = synthetic::one_room(11.0, 6.0);
  synthetic::House planned = hall, built = hall;
  planned.boxes.push_back({{1.0, 3.0, 0.0}, {10.0, 3.2, 2.8}});
  double x = 1.0;
  const auto build_up_to = [&](double end) {
    if (end > x) built.boxes.push_back({{x, 3.0, 0.0}, {end, 3.2, 2.8}});
  };
  for (const auto& [from, to] : openings) {
    build_up_to(1.0 + from);
    x = 1.0 + to;
  }
  build_up_to(10.0);
  const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const Pose X_WR = Pose::from_xyz_yaw({5.5, 1.0, 0.46}, 0.2);
  return agreement(index.storeys.front(), heading(index.X_WI.inverse() * X_WR),
                   synthetic::house_scan(built, X_WR, Pose{}).scan, {}, {});
}

TEST(Refine, OneOpeningThatIsNotPlannedIsOneChange) {
  const Agreement seen = behind_openings({{4.0, 5.0}});
  EXPECT_GT(seen.penetration_ratio, 0.05);
  EXPECT_LT(seen.penetration_ratio_otherwise(), 0.01);
}

// The doors of another building: the wall stands, and no single change explains its openings.
TEST(Refine, ManyOpeningsInAWallThatStandsAreMoreThanOneChange) {
  const Agreement seen = behind_openings({{2.3, 3.3}, {4.1, 4.9}, {5.7, 6.7}});
  EXPECT_GT(seen.penetration_ratio_one_change, 0.03);
  EXPECT_GT(seen.penetration_ratio_otherwise(), FitConfig{}.misfit_penetration);
}

TEST(Refine, OpeningsAtBothEndsOfAWallAreNotOne) {
  const Agreement left = behind_openings({{0.0, 2.5}}), both = behind_openings({{0.0, 2.5}, {6.5, 9.0}});
  EXPECT_GT(both.penetration_ratio, left.penetration_ratio + 0.03);
  EXPECT_GT(both.penetration_ratio_otherwise(), 0.03);
}

// Which gap of a railing a beam passes depends on a centimetre: what ends behind it contradicts no pose.
TEST(Refine, BeamsThatPassARailingPenetrateNothing) {
  const synthetic::House room = synthetic::one_room(8.0, 4.0);
  const auto railing = [](double shift_m) {
    std::vector<Eigen::AlignedBox3d> bars;
    for (int k = 0; k < 26; ++k) {
      const double y = 0.5 + 0.12 * k + shift_m;
      bars.push_back({Eigen::Vector3d(5.0, y, 0.0), Eigen::Vector3d(5.03, y + 0.03, 1.0)});
    }
    return bars;
  };
  synthetic::House built = room;
  for (const Eigen::AlignedBox3d& bar : railing(0.04)) built.boxes.push_back({bar.min(), bar.max()});
  bim::Plan planned = synthetic::plan_of(room);
  for (const synthetic::Box& wall : room.boxes)
    synthetic::add_boxes(bim::ElementKind::wall, {Eigen::AlignedBox3d(wall.min, wall.max)}, planned.structure);
  synthetic::add_boxes(bim::ElementKind::obstacle, railing(0.0), planned.structure);
  const PlanIndex index = make_plan_index(planned, "ground", {});
  const Pose X_WR = Pose::from_xyz_yaw({4.4, 1.9, 0.46}, 0.3);
  const Agreement seen = agreement(index.storeys.front(), heading(index.X_WI.inverse() * X_WR),
                                   synthetic::house_scan(built, X_WR, Pose{}).scan, {}, {});
  EXPECT_LT(seen.penetration_ratio, 0.01);
  EXPECT_GT(seen.inliers, 0.5);
}

TEST(Refine, BeamResidualIsTheShiftAcrossTheWall) {
  const ScanAtPose at = scan_at(Pose::from_xyz_yaw({3.1, 0.9, 0.46}, 0.0));
  const StoreyIndex& storey = at.index.storeys.front();
  const Eigen::Matrix2d R_IH = at.X_IH.rotation();
  const Eigen::Vector2d sensor_I = at.X_IH * at.scan.sensor_H;
  const LikelihoodConfig config;
  const Beam level{{0.0, 1.0}, 1.0, 0.0};
  const BeamResidual before = beam_residual(storey, sensor_I, storey.grid.cell_at(sensor_I), R_IH, level, 0.66, config);
  const Eigen::Vector2d moved = sensor_I + R_IH * Eigen::Vector2d(0.0, 0.1);
  const BeamResidual after = beam_residual(storey, moved, storey.grid.cell_at(moved), R_IH, level, 0.66, config);
  EXPECT_EQ(before.segment, after.segment);
  EXPECT_NEAR(after.across - before.across, 0.1, 1e-9);
}

}  // namespace
}  // namespace plumbline::slam
