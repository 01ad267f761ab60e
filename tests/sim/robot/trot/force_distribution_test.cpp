// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/force_distribution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::sim {
namespace {

const PerLeg<Eigen::Vector3d> corners = {
    Eigen::Vector3d(0.3, 0.17, -0.5), {0.3, -0.17, -0.5}, {-0.3, 0.17, -0.5}, {-0.3, -0.17, -0.5}};
const PerLeg<double> all_legs = {450.0, 450.0, 450.0, 450.0};

Wrench wrench_of(const PerLeg<Eigen::Vector3d>& force, const PerLeg<Eigen::Vector3d>& lever) {
  Wrench w = Wrench::Zero();
  for (std::size_t i = 0; i < leg_count; ++i) {
    w.head<3>() += force[i];
    w.tail<3>() += lever[i].cross(force[i]);
  }
  return w;
}

/// Many steps with the same task: the warm start has converged.
PerLeg<Eigen::Vector3d> settled(const Wrench& wrench, const PerLeg<double>& fz_max) {
  ForceDistribution distribution{ForceConfig{}};
  PerLeg<Eigen::Vector3d> force = zero_per_leg();
  for (int i = 0; i < 100; ++i) force = distribution.solve(wrench, corners, fz_max);
  return force;
}

TEST(ForceDistribution, CarriesTheWeightEvenly) {
  Wrench weight = Wrench::Zero();
  weight[2] = 330.0;
  for (const Eigen::Vector3d& f : settled(weight, all_legs)) {
    EXPECT_NEAR(f.z(), 82.5, 0.1);
    EXPECT_LT(f.head<2>().norm(), 0.1);
  }
}

TEST(ForceDistribution, GivesAWrenchThatItsFeetCanGive) {
  const Stream stream(1, "sim.gait.command");
  for (std::uint64_t i = 0; i < 100; ++i) {
    PerLeg<Eigen::Vector3d> feasible;
    for (std::uint32_t leg = 0; leg < leg_count; ++leg) {
      const double fz = 60.0 + 80.0 * stream.uniform(i, leg, 0);
      feasible[leg] = {0.4 * fz * (stream.uniform(i, leg, 1) - 0.5), 0.4 * fz * (stream.uniform(i, leg, 2) - 0.5), fz};
    }
    const Wrench asked = wrench_of(feasible, corners);
    const Wrench given = wrench_of(settled(asked, all_legs), corners);
    // alpha = 1e-5 trades some of the wrench for smaller forces: measured at most 2.4e-6.
    EXPECT_LT((given - asked).norm(), 1e-5 * asked.norm());
  }
}

TEST(ForceDistribution, StaysInsideTheFrictionPyramids) {
  const Stream stream(2, "sim.gait.command");
  ForceDistribution distribution{ForceConfig{}};
  for (std::uint64_t i = 0; i < 500; ++i) {
    Wrench asked;
    for (std::uint32_t k = 0; k < 6; ++k) asked[k] = 400.0 * stream.gauss(i, k);
    PerLeg<double> fz_max;
    for (std::uint32_t leg = 0; leg < leg_count; ++leg) fz_max[leg] = stream.uniform(i, leg, 1) < 0.5 ? 0.0 : 450.0;
    const PerLeg<Eigen::Vector3d> force = distribution.solve(asked, corners, fz_max);
    for (std::size_t leg = 0; leg < leg_count; ++leg) {
      EXPECT_GE(force[leg].z(), 0.0);
      EXPECT_LE(force[leg].z(), fz_max[leg]);
      EXPECT_LE(std::abs(force[leg].x()), 0.6 * force[leg].z() + 1e-12);
      EXPECT_LE(std::abs(force[leg].y()), 0.6 * force[leg].z() + 1e-12);
    }
  }
}

TEST(ForceDistribution, ALiftedLegCarriesNothing) {
  Wrench weight = Wrench::Zero();
  weight[2] = 330.0;
  const PerLeg<Eigen::Vector3d> force = settled(weight, {0.0, 450.0, 450.0, 0.0});
  EXPECT_EQ(force[0], Eigen::Vector3d::Zero());
  EXPECT_EQ(force[3], Eigen::Vector3d::Zero());
  EXPECT_NEAR(force[1].z() + force[2].z(), 330.0, 2.0);
}

}  // namespace
}  // namespace plumbline::sim
