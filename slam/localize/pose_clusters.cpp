// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/pose_clusters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace plumbline::slam {

namespace {

/// Storey, x, y, yaw in one number, of the same order.
using Bin = std::uint64_t;
constexpr int yaw_bits = 12, side_bits = 20, side_middle = 1 << (side_bits - 1);
constexpr Bin one_y = Bin{1} << yaw_bits, one_x = one_y << side_bits;

Bin bin_of(const LocalParticle& particle, const PoseClusterConfig& config) {
  const auto side = [&](double coordinate) {
    const int i = static_cast<int>(std::floor(coordinate / config.bin_m));
    return static_cast<Bin>(std::clamp(i + side_middle, 1, 2 * side_middle - 2));
  };
  const double turn = particle.X_IH.yaw / (2.0 * std::numbers::pi);
  const int yaw = static_cast<int>(std::floor((turn - std::floor(turn)) * config.yaw_bins));
  return (static_cast<Bin>(particle.storey) << (2 * side_bits + yaw_bits)) + one_x * side(particle.X_IH.t.x()) +
         one_y * side(particle.X_IH.t.y()) + static_cast<Bin>(yaw % config.yaw_bins);
}

struct FilledBin {
  Bin bin = 0;
  double mass = 0.0;
  int cluster = -1;
};

/// Bins in ascending order, and the one of each particle.
struct Binning {
  std::vector<FilledBin> bins;
  std::vector<int> of_particle;
};

Binning fill_bins(const ParticleSet& particles, const PoseClusterConfig& config) {
  std::vector<std::pair<Bin, std::size_t>> order;
  order.reserve(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) order.emplace_back(bin_of(particles[i], config), i);
  std::sort(order.begin(), order.end());
  Binning binning;
  binning.of_particle.resize(particles.size());
  for (const auto& [bin, i] : order) {
    if (binning.bins.empty() || binning.bins.back().bin != bin) binning.bins.push_back({bin});
    binning.bins.back().mass += particles[i].weight;
    binning.of_particle[i] = static_cast<int>(binning.bins.size()) - 1;
  }
  return binning;
}

/// Calls visit(index) for the filled bins that touch a bin, itself among them.
template <class Visit>
void visit_neighbours(const std::vector<FilledBin>& bins, Bin center, int yaw_bins, Visit visit) {
  const auto visit_range = [&](Bin first, Bin last) {
    auto at =
        std::lower_bound(bins.begin(), bins.end(), first, [](const FilledBin& b, Bin bin) { return b.bin < bin; });
    for (; at != bins.end() && at->bin <= last; ++at) visit(static_cast<std::size_t>(at - bins.begin()));
  };
  const Bin yaw = center % one_y, top = static_cast<Bin>(yaw_bins) - 1;
  for (int k = 0; k < 9; ++k) {
    const Bin column = center - yaw + one_x * static_cast<Bin>(k % 3) + one_y * static_cast<Bin>(k / 3) - one_x - one_y;
    visit_range(column + (yaw > 0 ? yaw - 1 : 0), column + std::min(yaw + 1, top));
    if (yaw == 0) visit_range(column + top, column + top);
    if (yaw == top) visit_range(column, column);
  }
}

/// Labels the component of bins around `start`.
void flood(std::vector<FilledBin>& bins, std::size_t start, int label, double least, int yaw_bins) {
  std::vector<std::size_t> open{start};
  bins[start].cluster = label;
  while (!open.empty()) {
    const Bin center = bins[open.back()].bin;
    open.pop_back();
    visit_neighbours(bins, center, yaw_bins, [&](std::size_t i) {
      if (bins[i].cluster >= 0 || bins[i].mass < least) return;
      bins[i].cluster = label;
      open.push_back(i);
    });
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
  auto [bins, of_particle] = fill_bins(particles, config);
  const int count = label_bins(bins, config);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles[i].cluster = bins[static_cast<std::size_t>(of_particle[i])].cluster;
  const auto occupied = std::count_if(bins.begin(), bins.end(), [](const FilledBin& bin) { return bin.cluster >= 0; });
  Clustering result{moments(particles, count, config), static_cast<int>(occupied)};
  sort_by_mass(result.clusters, particles);
  return result;
}

}  // namespace plumbline::slam
