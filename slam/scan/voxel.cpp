// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/voxel.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "bim/errors.h"

namespace plumbline::slam {

void VoxelKey::fail_too_far() { throw InternalError("a point is too far away for its voxel grid"); }

std::vector<Eigen::Vector3d> voxel_downsample(const std::vector<Eigen::Vector3d>& points, double size) {
  VoxelMeans means(size);
  for (const Eigen::Vector3d& p : points) means.add(p);
  return means.means();
}

int VoxelMeans::add(const Eigen::Vector3d& p) {
  const VoxelKey key = VoxelKey::of(p, size_m_);
  const int slot = index_.insert(key);
  const auto k = static_cast<std::size_t>(slot);
  if (k == sums_.size()) sums_.push_back({key.packed()});
  sums_[k].sum += p;
  ++sums_[k].count;
  return slot;
}

std::vector<Eigen::Vector3d> VoxelMeans::means() const {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(sums_.size());
  for (std::size_t k = 0; k < sums_.size(); ++k) order.emplace_back(sums_[k].key, static_cast<std::uint32_t>(k));
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Vector3d> means;
  means.reserve(order.size());
  for (const auto& [key, k] : order) means.emplace_back(sums_[k].sum / static_cast<double>(sums_[k].count));
  return means;
}

void VoxelIndex::clear() {
  std::fill(entries_.begin(), entries_.end(), Entry{});
  size_ = 0;
}

void VoxelIndex::grow() {
  const std::vector<Entry> old = std::exchange(entries_, {});
  entries_.resize(std::max<std::size_t>(1024, 2 * old.size()));
  for (const Entry& entry : old)
    if (entry.key != no_key) entries_[probe(entry.key)] = entry;
}

}  // namespace plumbline::slam
