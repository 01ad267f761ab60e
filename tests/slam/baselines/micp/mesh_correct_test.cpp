// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/micp/mesh_correct.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/random/stream.h"
#include "slam/plan_map/plan_mesh.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

constexpr double pi = std::numbers::pi;

double upright_area(const bim::BuildingMesh& mesh) {
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (std::abs(normal.z()) < 1e-9) area += 0.5 * normal.norm();
  }
  return area;
}

TEST(PlanMesh, HasFacesWithoutTheirHoles) {
  bim::Plan plan = synthetic::plan_of(synthetic::one_room());
  const double whole = upright_area(plan_mesh(synthetic::storey_of(plan)));
  double expected = 0.0;
  for (const bim::PlanFace& face : plan.faces) expected += (face.p1 - face.p0).norm() * (face.z1 - face.z0);
  EXPECT_NEAR(whole, expected, 1e-6);
  double holes = 0.0;
  for (bim::PlanFace& face : plan.faces)
    if ((face.p1 - face.p0).norm() > 3.0) {
      // Two that overlap in part, and a door that reaches the floor.
      face.holes = {{0.5, 1.5, 1.0, 2.0}, {1.0, 1.6, 0.5, 1.2}, {2.0, 2.9, -0.1, 2.1}};
      holes += 1.0 * 1.0 + 0.6 * 0.7 - 0.5 * 0.2 + 0.9 * 2.1;
    }
  EXPECT_NEAR(whole - upright_area(plan_mesh(synthetic::storey_of(plan))), holes, 1e-6);
}

MeshBeams beams_at(const synthetic::House& house, const Pose& X_WR) {
  MotionBuffer motion;
  motion.add({0, X_WR});
  return pick_beams(deskew(synthetic::standing_scan(house, X_WR, {}), motion, synthetic::calibration()), {});
}

// Inside the basin of attraction, docs/methods/baselines.md.
TEST(MeshCorrect, ComesBackFromHalfAMeterAndFifteenDegrees) {
  const synthetic::House house = synthetic::corridor_house();
  const MeshCorrector corrector(synthetic::storey_of(synthetic::plan_of(house)), {});
  const Stream stream(9, "bim.generate");
  const Eigen::Vector2d places[] = {{3.0, 1.1}, {11.0, 1.0}};
  for (std::uint64_t i = 0; i < 24; ++i) {
    const Eigen::Vector2d& place = places[i % 2];
    const double yaw = 2.0 * pi * stream.uniform(i, 0), side = 2.0 * pi * stream.uniform(i, 1);
    const Pose truth = Pose::from_xyz_yaw({place.x(), place.y(), 0.5}, yaw);
    const Pose start = Pose::from_xyz_yaw({place.x() + 0.5 * std::cos(side), place.y() + 0.5 * std::sin(side), 0.5},
                                          yaw + (i % 4 < 2 ? 1.0 : -1.0) * 15.0 * pi / 180.0);
    const MeshCorrection correction = corrector.correct(beams_at(house, truth), start, 20, 1.0);
    EXPECT_LT((correction.X_IR.t - truth.t).norm(), 0.02) << "trial " << i;
    EXPECT_LT(log_so3(correction.X_IR.q.conjugate() * truth.q).norm(), 0.29 * pi / 180.0) << "trial " << i;
    EXPECT_GT(correction.inliers, 0.9);
  }
}

TEST(MeshCorrect, BothSolversAgree) {
  const synthetic::House house = synthetic::corridor_house();
  const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(house));
  MeshCorrectConfig config;
  config.solver = MeshSolver::umeyama;
  const MeshCorrector umeyama(storey, config), gauss_newton(storey, {});
  const Pose truth = Pose::from_xyz_yaw({3.0, 1.1, 0.5}, 0.3);
  const Pose start = Pose::from_xyz_yaw({3.1, 1.0, 0.5}, 0.35);
  const MeshBeams beams = beams_at(house, truth);
  const Pose a = umeyama.correct(beams, start, 40, 0.5).X_IR, b = gauss_newton.correct(beams, start, 10, 0.5).X_IR;
  EXPECT_LT((a.t - b.t).norm(), 0.02);
  EXPECT_LT((a.t - truth.t).norm(), 0.03);
}

TEST(MeshCorrect, WithoutBeamsOrHitsStaysPut) {
  const MeshCorrector corrector(synthetic::storey_of(synthetic::plan_of(synthetic::one_room())), {});
  const Pose start = Pose::from_xyz_yaw({3.0, 2.0, 0.5}, 0.1), far = Pose::from_xyz_yaw({300.0, 2.0, 50.0}, 0.1);
  EXPECT_EQ(corrector.correct({}, start, 5, 1.0).X_IR.t, start.t);
  EXPECT_EQ(corrector.correct({}, start, 5, 1.0).inliers, 0.0);
  MeshBeams up;
  up.ends_R.assign(50, Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_EQ(corrector.correct(up, far, 5, 1.0).X_IR.t, far.t);
}

}  // namespace
}  // namespace plumbline::slam
