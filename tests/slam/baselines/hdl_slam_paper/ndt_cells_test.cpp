// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/ndt_cells.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"

namespace plumbline::slam::hdl {
namespace {

std::vector<Eigen::Vector3d> random_points(std::uint64_t seed, std::uint32_t count) {
  const Stream stream(seed, "bim.generate");
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    Eigen::Vector3d p;
    for (std::uint32_t k = 0; k < 3; ++k) p[k] = 3.0 * stream.uniform(0, i, k);
    points.push_back(p);
  }
  return points;
}

TEST(NdtCells, DerivativesAreThoseOfTheValue) {
  NdtCells cells({.cell_m = 1.0});
  cells.set(random_points(1, 3000));
  for (std::uint64_t seed = 2; seed < 12; ++seed) {
    const Stream stream(seed, "bim.generate");
    // One point well inside of a cell: the value jumps where a point changes its cells.
    std::vector<Eigen::Vector3d> points = {
        {1.3 + 0.4 * stream.uniform(0, 0), 1.3 + 0.4 * stream.uniform(0, 1), 1.3 + 0.4 * stream.uniform(0, 2)}};
    const Pose X_TS = Pose::from_xyz_yaw({0.4, -0.2, 0.1}, 0.7);
    points[0] = X_TS.inverse() * points[0];
    const NdtScore score = cells.score(points, X_TS);
    ASSERT_LT(score.value, 0.0);
    constexpr double h = 1e-4;
    for (int i = 0; i < 6; ++i) {
      const auto at = [&](double step) { return cells.score(points, retract(X_TS, step * Vector6d::Unit(i))); };
      // Central differences err by h^2 times derivatives of order 1 to 100 here.
      EXPECT_NEAR((at(h).value - at(-h).value) / (2.0 * h), score.gradient[i], 1e-5) << i;
      EXPECT_NEAR((at(h).value - 2.0 * score.value + at(-h).value) / (h * h), score.hessian(i, i), 1e-4) << i;
      for (int j = 0; j < 3; ++j) {
        // Steps in turn are one step where the last is a translation's, or both are.
        const Vector6d both = h * Vector6d::Unit(j);
        const double mixed = (cells.score(points, retract(X_TS, both + h * Vector6d::Unit(i))).value -
                              cells.score(points, retract(X_TS, both - h * Vector6d::Unit(i))).value -
                              cells.score(points, retract(X_TS, -both + h * Vector6d::Unit(i))).value +
                              cells.score(points, retract(X_TS, -both - h * Vector6d::Unit(i))).value) /
                             (4.0 * h * h);
        EXPECT_NEAR(mixed, score.hessian(i, j), 1e-4) << i << " " << j;
      }
    }
    EXPECT_TRUE(score.hessian.isApprox(score.hessian.transpose(), 1e-12));
  }
}

}  // namespace
}  // namespace plumbline::slam::hdl
