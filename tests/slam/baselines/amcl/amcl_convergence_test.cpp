// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/amcl/amcl_convergence.h"

#include <gtest/gtest.h>

#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

/// Gaussian particles round a place: their share of the mass, standard deviation and number.
struct Group {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double mass = 1.0;
  double sigma_m = 0.1;
  int count = 1000;
};

ParticleSet set_of(const std::vector<Group>& groups) {
  const Stream stream(3, "bim.generate");
  ParticleSet particles;
  std::uint64_t draw = 0;
  for (const Group& group : groups)
    for (int i = 0; i < group.count; ++i, ++draw) {
      LocalParticle particle;
      particle.X_IH.t = group.at + group.sigma_m * Eigen::Vector2d(stream.gauss(draw, 0), stream.gauss(draw, 1));
      particle.X_IH.yaw = 0.05 * stream.gauss(draw, 2);
      particle.weight = group.mass / group.count;
      particles.push_back(particle);
    }
  return particles;
}

PoseClusterConfig every_bin() {
  PoseClusterConfig config;
  config.bin_share = 0.0;
  return config;
}

/// Whether the last of these sets, scan after scan, is one answer. The robot moves by u before each.
bool converged(const std::vector<ParticleSet>& sets, const AmclFilterConfig& config = {}, const Pose2& u = {}) {
  AmclConvergence convergence(config);
  for (ParticleSet particles : sets) {
    const Clustering clustering = find_clusters(particles, every_bin());
    convergence.update(particles, clustering, u);
  }
  return convergence.converged();
}

const Eigen::Vector2d here(2.0, 2.0), there(12.0, 5.0);

ParticleSet shared(double mass_here) { return set_of({{here, mass_here}, {there, 1.0 - mass_here}}); }

TEST(AmclConvergence, IsThatOfTheHeaviestCluster) {
  EXPECT_TRUE(converged({set_of({{here}})}));
  EXPECT_TRUE(converged({shared(0.97)}));
  AmclFilterConfig whole;
  whole.converged_by = ConvergedBy::covariance;
  EXPECT_FALSE(converged({shared(0.97)}, whole)) << "0.03 * 10 m away are 1.7 m of the whole set";
  EXPECT_TRUE(converged({set_of({{here, 1.0, 0.35}})})) << "as wide as the alphas of nav2 make it";
}

TEST(AmclConvergence, NeverWhereTwoPlacesShareTheMass) {
  for (const double mass : {0.5, 0.6, 0.8, 0.9, 0.94}) {
    EXPECT_FALSE(converged({shared(mass)})) << mass;
    EXPECT_FALSE(converged(std::vector<ParticleSet>(20, shared(mass)))) << mass << ", scan after scan";
  }
}

TEST(AmclConvergence, NeverWhereTheClusterIsWide) {
  EXPECT_FALSE(converged({set_of({{here, 1.0, 0.8, 20000}})}));
  EXPECT_FALSE(converged({set_of({{here}}), set_of({{here, 1.0, 0.8, 20000}})}));
}

TEST(AmclConvergence, IsGivenUpWithLessMassThanItTakes) {
  EXPECT_TRUE(converged({shared(0.97), shared(0.85)}));
  EXPECT_FALSE(converged({shared(0.97), shared(0.75)}));
  EXPECT_FALSE(converged({shared(0.97), shared(0.75), shared(0.85)})) << "anew it takes all of it";
}

TEST(AmclConvergence, BeginsAnewInAnotherCluster) {
  EXPECT_FALSE(converged({shared(0.97), shared(0.15)}));
  EXPECT_TRUE(converged({shared(0.97), shared(0.03)}));
}

TEST(AmclConvergence, FollowsTheRobot) {
  const Pose2 u{{2.0, 0.0}, 0.0};
  const auto ahead = [&](double mass) { return set_of({{here + u.t, mass}, {there, 1.0 - mass}}); };
  EXPECT_TRUE(converged({shared(0.97), ahead(0.85)}, {}, u));
  EXPECT_FALSE(converged({shared(0.97), shared(0.85)}, {}, u)) << "it should be 2 m ahead";
}

TEST(AmclConvergence, NeedsOneStorey) {
  ParticleSet particles = set_of({{here}});
  for (std::size_t i = 0; i < particles.size(); i += 4) particles[i].storey = 1;
  for (const ConvergedBy by : {ConvergedBy::particles, ConvergedBy::covariance, ConvergedBy::cluster}) {
    AmclFilterConfig config;
    config.converged_by = by;
    EXPECT_FALSE(converged({particles}, config));
    EXPECT_TRUE(converged({set_of({{here}})}, config));
  }
}

}  // namespace
}  // namespace plumbline::slam
