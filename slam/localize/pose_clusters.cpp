// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/pose_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

namespace {

using Bin = std::array<int, 4>;  ///< storey, x, y, yaw

struct FilledBin {
  Bin bin{};
  double mass = 0.0;
  int cluster = -1;
};

Bin bin_of(const LocalParticle& particle, const PoseClusterConfig& config) {
  const double turn = particle.X_IH.yaw / (2.0 * std::numbers::pi);
  const int yaw = static_cast<int>(std::floor((turn - std::floor(turn)) * config.yaw_bins));
  return {particle.storey, static_cast<int>(std::floor(particle.X_IH.t.x() / config.bin_m)),
          static_cast<int>(std::floor(particle.X_IH.t.y() / config.bin_m)), yaw % config.yaw_bins};
}

int find_bin(const std::vector<FilledBin>& bins, const Bin& bin) {
  const auto at =
      std::lower_bound(bins.begin(), bins.end(), bin, [](const FilledBin& a, const Bin& b) { return a.bin < b; });
  return at != bins.end() && at->bin == bin ? static_cast<int>(at - bins.begin()) : -1;
}

std::vector<FilledBin> filled_bins(const std::vector<Bin>& of_particle, const ParticleSet& particles) {
  std::vector<Bin> keys = of_particle;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<FilledBin> bins(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) bins[i].bin = keys[i];
  for (std::size_t i = 0; i < particles.size(); ++i)
    bins[static_cast<std::size_t>(find_bin(bins, of_particle[i]))].mass += particles[i].weight;
  return bins;
}

/// Labels the component of bins around `start`.
void flood(std::vector<FilledBin>& bins, std::size_t start, int label, double least, int yaw_bins) {
  std::vector<std::size_t> open{start};
  bins[start].cluster = label;
  while (!open.empty()) {
    const Bin center = bins[open.back()].bin;
    open.pop_back();
    for (int k = 0; k < 27; ++k) {
      const Bin bin{center[0], center[1] + k % 3 - 1, center[2] + k / 3 % 3 - 1,
                    (center[3] + k / 9 - 1 + yaw_bins) % yaw_bins};
      const int i = find_bin(bins, bin);
      if (i < 0 || bins[static_cast<std::size_t>(i)].cluster >= 0 || bins[static_cast<std::size_t>(i)].mass < least)
        continue;
      bins[static_cast<std::size_t>(i)].cluster = label;
      open.push_back(static_cast<std::size_t>(i));
    }
  }
}

/// Labels all components heavy enough; returns their number.
int label_bins(std::vector<FilledBin>& bins, const PoseClusterConfig& config) {
  double top = 0.0;
  for (const FilledBin& bin : bins) top = std::max(top, bin.mass);
  const double least = config.bin_share * top;
  int count = 0;
  for (std::size_t i = 0; i < bins.size(); ++i)
    if (bins[i].cluster < 0 && bins[i].mass >= least && bins[i].mass > 0.0)
      flood(bins, i, count++, least, config.yaw_bins);
  return count;
}

/// Mass, mean and covariance of the particles with each label.
std::vector<PoseCluster> moments(const ParticleSet& particles, int count, const PoseClusterConfig& config) {
  const auto n = static_cast<std::size_t>(count);
  std::vector<PoseCluster> clusters(n);
  std::vector<Eigen::Vector4d> sums(n, Eigen::Vector4d::Zero());
  for (const LocalParticle& p : particles) {
    if (p.cluster < 0) continue;
    const auto c = static_cast<std::size_t>(p.cluster);
    clusters[c].storey = p.storey;
    clusters[c].mass += p.weight;
    ++clusters[c].count;
    sums[c] += p.weight * Eigen::Vector4d(p.X_IH.t.x(), p.X_IH.t.y(), std::cos(p.X_IH.yaw), std::sin(p.X_IH.yaw));
  }
  for (std::size_t c = 0; c < n; ++c)
    clusters[c].mean = {sums[c].head<2>() / clusters[c].mass, std::atan2(sums[c][3], sums[c][2])};
  for (const LocalParticle& p : particles) {
    if (p.cluster < 0) continue;
    PoseCluster& cluster = clusters[static_cast<std::size_t>(p.cluster)];
    Eigen::Vector3d e;
    e << p.X_IH.t - cluster.mean.t, wrap_angle(p.X_IH.yaw - cluster.mean.yaw);
    cluster.covariance += p.weight / cluster.mass * e * e.transpose();
  }
  for (PoseCluster& cluster : clusters)
    cluster.compact = cluster.covariance.topLeftCorner<2, 2>().trace() < 2.0 * config.compact_m * config.compact_m &&
                      cluster.covariance(2, 2) < config.compact_rad * config.compact_rad;
  return clusters;
}

/// Puts clusters in the order of their mass and relabels the particles so.
void sort_by_mass(std::vector<PoseCluster>& clusters, ParticleSet& particles) {
  std::vector<int> order(clusters.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto mass = [&](int i) { return clusters[static_cast<std::size_t>(i)].mass; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return mass(a) > mass(b); });
  std::vector<PoseCluster> sorted;
  std::vector<int> rank(clusters.size());
  for (const int i : order) {
    rank[static_cast<std::size_t>(i)] = static_cast<int>(sorted.size());
    sorted.push_back(clusters[static_cast<std::size_t>(i)]);
  }
  for (LocalParticle& particle : particles)
    if (particle.cluster >= 0) particle.cluster = rank[static_cast<std::size_t>(particle.cluster)];
  clusters = std::move(sorted);
}

}  // namespace

Clustering find_clusters(ParticleSet& particles, const PoseClusterConfig& config) {
  std::vector<Bin> of_particle;
  of_particle.reserve(particles.size());
  for (const LocalParticle& particle : particles) of_particle.push_back(bin_of(particle, config));
  std::vector<FilledBin> bins = filled_bins(of_particle, particles);
  const int count = label_bins(bins, config);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles[i].cluster = bins[static_cast<std::size_t>(find_bin(bins, of_particle[i]))].cluster;
  const auto occupied = std::count_if(bins.begin(), bins.end(), [](const FilledBin& bin) { return bin.cluster >= 0; });
  Clustering result{moments(particles, count, config), static_cast<int>(occupied)};
  sort_by_mass(result.clusters, particles);
  return result;
}

}  // namespace plumbline::slam
