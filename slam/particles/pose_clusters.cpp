// SPDX-License-Identifier: Apache-2.0
#include "slam/particles/pose_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <numeric>
#include <utility>

namespace plumbline::slam {

namespace {

/// Storey, x, y, yaw in one number, of the same order.
using Bin = std::uint64_t;
constexpr int yaw_bits = 12, side_bits = 20, side_middle = 1 << (side_bits - 1);
constexpr Bin one_y = Bin{1} << yaw_bits, one_x = one_y << side_bits;

/// As std::floor, for what an int holds.
int floor_of(double value) {
  const int whole = static_cast<int>(value);
  return value < whole ? whole - 1 : whole;
}

Bin bin_of(const LocalParticle& particle, const PoseClusterConfig& config) {
  const auto side = [&](double coordinate) {
    const int i = floor_of(coordinate / config.bin_m);
    return static_cast<Bin>(std::clamp(i + side_middle, 1, 2 * side_middle - 2));
  };
  const double turn = particle.X_IH.yaw / (2.0 * std::numbers::pi);
  const int yaw = floor_of((turn - floor_of(turn)) * config.yaw_bins);
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

using Keyed = std::pair<Bin, std::uint32_t>;

/// Sorts by bin, keeping the order within each: byte by byte, from the lowest, leaving out those that all share.
void sort_stably(std::vector<Keyed>& keyed) {
  Bin differing = 0;
  for (const Keyed& key : keyed) differing |= key.first ^ keyed.front().first;
  std::vector<Keyed> sorted(keyed.size());
  for (int shift = 0; shift < 64; shift += 8) {
    if (((differing >> shift) & 0xFFU) == 0) continue;
    std::array<std::uint32_t, 257> start{};
    for (const Keyed& key : keyed) ++start[((key.first >> shift) & 0xFFU) + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    for (const Keyed& key : keyed) sorted[start[(key.first >> shift) & 0xFFU]++] = key;
    std::swap(keyed, sorted);
  }
}

Binning fill_bins(const ParticleSet& particles, const PoseClusterConfig& config) {
  std::vector<Keyed> order;
  order.reserve(particles.size());
  for (const LocalParticle& particle : particles)
    order.emplace_back(bin_of(particle, config), static_cast<std::uint32_t>(order.size()));
  sort_stably(order);
  Binning binning;
  binning.of_particle.resize(particles.size());
  for (const auto& [bin, i] : order) {
    if (binning.bins.empty() || binning.bins.back().bin != bin) binning.bins.push_back({bin});
    binning.bins.back().mass += particles[i].weight;
    binning.of_particle[i] = static_cast<int>(binning.bins.size()) - 1;
  }
  return binning;
}

/// Sets of bins, each known by its first.
class Components {
 public:
  explicit Components(std::size_t bins) : parent_(bins) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  [[nodiscard]] std::size_t first(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = first(a);
    b = first(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Bins of one storey, x and y, next to each other in a list of bins.
struct Column {
  Bin place = 0;
  std::size_t first = 0, last = 0;  ///< last: behind the end
};

std::vector<Column> columns_of(const std::vector<FilledBin>& bins) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin place = bins[i].bin / one_y;
    if (columns.empty() || columns.back().place != place) columns.push_back({place, i, i});
    columns.back().last = i + 1;
  }
  return columns;
}

/// Joins the bins of two columns whose yaws touch, around the turn.
void join_touching(const std::vector<FilledBin>& bins, const Column& a, const Column& b, int yaw_bins,
                   Components& components) {
  const auto yaw = [&](std::size_t i) { return bins[i].bin % one_y; };
  std::size_t from = b.first;
  for (std::size_t i = a.first; i < a.last; ++i) {
    while (from < b.last && yaw(from) + 1 < yaw(i)) ++from;
    for (std::size_t k = from; k < b.last && yaw(k) <= yaw(i) + 1; ++k) components.join(i, k);
  }
  const Bin top = static_cast<Bin>(yaw_bins) - 1;
  if (yaw(a.first) == 0 && yaw(b.last - 1) == top) components.join(a.first, b.last - 1);
  if (yaw(b.first) == 0 && yaw(a.last - 1) == top) components.join(b.first, a.last - 1);
}

/// Labels the components of these bins in the order of their first; returns their number.
int label_components(std::vector<FilledBin>& bins, int yaw_bins) {
  const std::vector<Column> columns = columns_of(bins);
  Components components(bins.size());
  constexpr Bin one_column = one_x / one_y;
  // Every pair of columns that touch once: each with itself and with the four behind it.
  for (const Bin ahead : {Bin{0}, Bin{1}, one_column - 1, one_column, one_column + 1}) {
    auto other = columns.begin();
    for (const Column& column : columns) {
      while (other != columns.end() && other->place < column.place + ahead) ++other;
      if (other == columns.end()) break;
      if (other->place == column.place + ahead) join_touching(bins, column, *other, yaw_bins, components);
    }
  }
  int count = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const std::size_t first = components.first(i);
    bins[i].cluster = first == i ? count++ : bins[first].cluster;
  }
  return count;
}

/// Labels all components of bins heavy enough; returns their number.
int label_bins(std::vector<FilledBin>& bins, const PoseClusterConfig& config) {
  double top = 0.0;
  for (const FilledBin& bin : bins) top = std::max(top, bin.mass);
  const double least = config.bin_share * top;
  const auto heavy = [&](const FilledBin& bin) { return bin.mass >= least && bin.mass > 0.0; };
  std::vector<FilledBin> kept;
  std::copy_if(bins.begin(), bins.end(), std::back_inserter(kept), heavy);
  const int count = label_components(kept, config.yaw_bins);
  auto next = kept.begin();
  for (FilledBin& bin : bins)
    if (heavy(bin)) bin.cluster = (next++)->cluster;
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
