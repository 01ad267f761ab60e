// SPDX-License-Identifier: Apache-2.0
#include "slam/particles/pose_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace plumbline::slam {
namespace {

void add_blob(ParticleSet& particles, const Pose2& center, int count, double mass, std::uint64_t tick) {
  const Stream stream(11, "slam.localize.init");
  for (int i = 0; i < count; ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    const Eigen::Vector2d e(0.1 * stream.gauss(tick, lane, 0), 0.1 * stream.gauss(tick, lane, 1));
    const double yaw = wrap_angle(center.yaw + 0.05 * stream.gauss(tick, lane, 2));
    particles.push_back({{center.t + e, yaw}, 0, mass / count, -1});
  }
}

TEST(PoseClusters, SplitsPlacesAndGivesTheirMoments) {
  ParticleSet particles;
  add_blob(particles, {{1.0, 2.0}, 0.5}, 2000, 0.7, 0);
  add_blob(particles, {{9.0, 2.0}, 0.5}, 2000, 0.3, 1);
  const Clustering clustering = find_clusters(particles, {});
  ASSERT_GE(clustering.clusters.size(), 2U);
  const PoseCluster& first = clustering.clusters[0];
  EXPECT_NEAR(first.mass, 0.7, 0.02);
  // 2000 draws of sigma 0.1 and 0.05: 4 sigma of the mean is 0.009 and 0.0045; cut bins take a little more.
  EXPECT_NEAR((first.mean.t - Eigen::Vector2d(1.0, 2.0)).norm(), 0.0, 0.015);
  EXPECT_NEAR(first.mean.yaw, 0.5, 0.006);
  EXPECT_NEAR(std::sqrt(first.covariance(0, 0)), 0.1, 0.015);
  EXPECT_TRUE(first.compact);
  EXPECT_NEAR(clustering.clusters[1].mass, 0.3, 0.02);
}

TEST(PoseClusters, YawWrapsAround) {
  ParticleSet particles;
  add_blob(particles, {{1.0, 2.0}, std::numbers::pi}, 2000, 1.0, 0);
  const Clustering clustering = find_clusters(particles, {});
  ASSERT_EQ(clustering.clusters.size(), 1U);
  EXPECT_NEAR(std::abs(wrap_angle(clustering.clusters[0].mean.yaw - std::numbers::pi)), 0.0, 0.006);
}

TEST(PoseClusters, AreTheBinsThatCanBeReachedFromEachOther) {
  const Stream stream(11, "slam.localize.init");
  PoseClusterConfig config;
  config.yaw_bins = 8;
  config.bin_share = 0.3;
  ParticleSet particles;
  for (std::uint32_t i = 0; i < 900; ++i) {
    const Eigen::Vector2d t(12.0 * stream.uniform(3, i, 0) - 6.0, 9.0 * stream.uniform(3, i, 1) - 4.0);
    particles.push_back({{t, wrap_angle(6.3 * stream.uniform(3, i, 2))}, static_cast<int>(i % 2), 0.5 + i % 5, -1});
  }
  const Clustering clustering = find_clusters(particles, config);
  ASSERT_GT(clustering.clusters.size(), 5U);
  using Place = std::array<int, 4>;
  const auto place_of = [&](const LocalParticle& p) {
    const double turn = p.X_IH.yaw / (2.0 * std::numbers::pi);
    return Place{p.storey, static_cast<int>(std::floor(p.X_IH.t.x() / config.bin_m)),
                 static_cast<int>(std::floor(p.X_IH.t.y() / config.bin_m)),
                 static_cast<int>(std::floor((turn - std::floor(turn)) * config.yaw_bins))};
  };
  std::map<Place, double> mass;
  for (const LocalParticle& p : particles) mass[place_of(p)] += p.weight;
  double top = 0.0;
  for (const auto& [place, m] : mass) top = std::max(top, m);
  std::map<Place, int> label;
  for (const LocalParticle& p : particles) {
    const auto [at, first] = label.emplace(place_of(p), p.cluster);
    EXPECT_EQ(at->second, p.cluster);
    EXPECT_EQ(p.cluster >= 0, mass[at->first] >= config.bin_share * top);
  }
  // Bins that touch have one label; those with one label hang together: as many components as labels.
  std::map<int, std::vector<Place>> members;
  for (const auto& [a, l] : label)
    if (l >= 0) members[l].push_back(a);
  EXPECT_EQ(members.size(), clustering.clusters.size());
  const auto touch = [&](const Place& a, const Place& b) {
    const int turn = std::abs(a[3] - b[3]);
    return a[0] == b[0] && std::abs(a[1] - b[1]) <= 1 && std::abs(a[2] - b[2]) <= 1 &&
           std::min(turn, config.yaw_bins - turn) <= 1;
  };
  for (const auto& [l, places] : members) {
    std::vector<Place> reached{places.front()}, left(places.begin() + 1, places.end());
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (auto at = left.begin(); at != left.end();) {
        const bool next = touch(reached[i], *at);
        if (next) reached.push_back(*at);
        at = next ? left.erase(at) : at + 1;
      }
    EXPECT_TRUE(left.empty());
    for (const auto& [other, m] : label)
      EXPECT_FALSE(m >= 0 && m != l && std::any_of(places.begin(), places.end(), [&, place = other](const Place& own) {
                     return touch(own, place);
                   }));
  }
}

TEST(Resample, KeepsTheMassOfEveryClusterAndItsQuota) {
  ParticleSet particles;
  add_blob(particles, {{1.0, 2.0}, 0.5}, 900, 0.98, 0);
  add_blob(particles, {{9.0, 2.0}, 0.5}, 900, 0.02, 1);
  const Clustering before = find_clusters(particles, {});
  const ParticleSet drawn = resample(particles, before, 1000, 120, {}, 3, 5);
  double mass = 0.0;
  int count = 0;
  for (const LocalParticle& p : drawn) {
    if (p.X_IH.t.x() < 5.0) continue;
    mass += p.weight;
    ++count;
  }
  EXPECT_NEAR(mass, 0.02, 1e-9);
  EXPECT_GE(count, 120);
}

TEST(Resample, KldSizeGrowsWithTheBins) {
  const FilterConfig config;
  EXPECT_EQ(kld_size(1, config), config.min_particles);
  EXPECT_LT(kld_size(200, config), kld_size(400, config));
  // Fox 2001 by hand: k = 101, eps 0.05, z 3: 1000 (1 - 1/450 + 3 sqrt(1/450))^3 = 1475.
  EXPECT_NEAR(kld_size(101, config), 1475, 15);
}

}  // namespace
}  // namespace plumbline::slam
