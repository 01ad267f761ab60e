// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "slam/particles/pose_clusters.h"

namespace plumbline::slam {

namespace {

struct Group {
  std::vector<int> members;
  double mass = 0.0;
};

/// Members and mass by label; the last group holds the particles without one.
std::vector<Group> groups_of(const ParticleSet& particles, std::size_t clusters) {
  std::vector<Group> groups(clusters + 1);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles[i].weight <= 0.0) continue;
    const int label = particles[i].cluster;
    Group& group = groups[label < 0 ? clusters : static_cast<std::size_t>(label)];
    group.members.push_back(static_cast<int>(i));
    group.mass += particles[i].weight;
  }
  return groups;
}

/// Systematic resampling of one group with one uniform number.
void draw_group(const ParticleSet& particles, const Group& group, int count, double start, ParticleSet& drawn) {
  const double step = group.mass / count;
  double reached = 0.0;
  std::size_t next = 0;
  for (int k = 0; k < count; ++k) {
    const double target = (k + start) * step;
    while (next + 1 < group.members.size() &&
           reached + particles[static_cast<std::size_t>(group.members[next])].weight <= target)
      reached += particles[static_cast<std::size_t>(group.members[next++])].weight;
    drawn.push_back(particles[static_cast<std::size_t>(group.members[next])]);
    drawn.back().weight = step;
  }
}

/// Standard deviations by which particles are moved.
struct Roughness {
  double way = 0.0, turn = 0.0;
};

/// By cluster; the last is of particles without one.
std::vector<Roughness> roughness_of(const Clustering& clustering, const FilterConfig& config) {
  std::vector<Roughness> roughness;
  for (const PoseCluster& cluster : clustering.clusters) {
    const Eigen::Matrix3d& P = cluster.covariance;
    const double scale = config.rough_scale;
    roughness.push_back(
        {std::clamp(scale * std::sqrt(0.5 * (P(0, 0) + P(1, 1))), config.rough_min_m, config.rough_max_m),
         std::clamp(scale * std::sqrt(P(2, 2)), config.rough_min_rad, config.rough_max_rad)});
  }
  roughness.push_back({config.rough_max_m, config.rough_max_rad});
  return roughness;
}

void roughen(ParticleSet& drawn, const Clustering& clustering, const FilterConfig& config, const Stream& stream,
             std::uint64_t tick) {
  const std::vector<Roughness> roughness = roughness_of(clustering, config);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    LocalParticle& particle = drawn[i];
    const Roughness& by =
        particle.cluster < 0 ? roughness.back() : roughness[static_cast<std::size_t>(particle.cluster)];
    const auto lane = static_cast<std::uint32_t>(i);
    const std::array<double, 4> noise = stream.gauss4(tick, lane, 1);
    particle.X_IH.t += by.way * Eigen::Vector2d(noise[0], noise[1]);
    particle.X_IH.yaw = wrap_angle(particle.X_IH.yaw + by.turn * noise[2]);
  }
}

}  // namespace

double kld_bound(int occupied_bins, double error, double quantile) {
  const double k = occupied_bins - 1.0;
  const double c = 2.0 / (9.0 * k);
  const double root = 1.0 - c + std::sqrt(c) * quantile;
  return k / (2.0 * error) * root * root * root;
}

int kld_size(int occupied_bins, const FilterConfig& config) {
  if (occupied_bins < 2) return config.min_particles;
  const double n = kld_bound(occupied_bins, config.kld_error, config.kld_quantile);
  return static_cast<int>(
      std::clamp(n, static_cast<double>(config.min_particles), static_cast<double>(config.max_particles)));
}

ParticleSet resample(const ParticleSet& particles, const Clustering& clustering, int count, int quota,
                     const FilterConfig& config, std::uint64_t seed, std::uint64_t tick) {
  const Stream stream(seed, "slam.localize.resample");
  const std::vector<Group> groups = groups_of(particles, clustering.clusters.size());
  ParticleSet drawn;
  drawn.reserve(static_cast<std::size_t>(count) + clustering.clusters.size() * static_cast<std::size_t>(quota + 1));
  double total = 0.0;
  for (const Group& group : groups) total += group.mass;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double share = groups[g].mass / total * count;
    const bool is_cluster = g + 1 < groups.size();
    const int size = std::max(static_cast<int>(std::lround(share)), is_cluster ? quota : 0);
    if (groups[g].members.empty() || size == 0) continue;
    draw_group(particles, groups[g], size, stream.uniform(tick, static_cast<std::uint32_t>(g), 0), drawn);
  }
  roughen(drawn, clustering, config, stream, tick);
  normalise(drawn);
  return drawn;
}

}  // namespace plumbline::slam
