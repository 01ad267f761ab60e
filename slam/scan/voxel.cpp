// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/voxel.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr std::int32_t axis_offset = 1 << 20;
constexpr std::uint64_t no_key = std::numeric_limits<std::uint64_t>::max();

std::int32_t cell(double x, double size) {
  const double c = x / size;
  if (!(c >= 1.0 - static_cast<double>(axis_offset) && c < static_cast<double>(axis_offset)))
    throw InternalError("a point is too far away for its voxel grid");
  const auto towards_zero = static_cast<std::int32_t>(c);  // without SSE4, floor is a call
  return towards_zero - (c < static_cast<double>(towards_zero) ? 1 : 0);
}

/// Spreads neighbouring cells over the table (64-bit finaliser of a multiply-xorshift hash).
std::uint64_t scramble(std::uint64_t k) {
  k ^= k >> 31U;
  k *= 0x9e3779b97f4a7c15ULL;
  k ^= k >> 29U;
  return k;
}

}  // namespace

VoxelKey VoxelKey::of(const Eigen::Vector3d& p, double size) {
  return {cell(p.x(), size), cell(p.y(), size), cell(p.z(), size)};
}

std::uint64_t VoxelKey::packed() const {
  const auto bits = [](std::int32_t c) { return static_cast<std::uint64_t>(c + axis_offset); };
  return (bits(z) << 2 * bits_per_axis) | (bits(y) << bits_per_axis) | bits(x);
}

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

int VoxelIndex::insert(const VoxelKey& key) {
  if (2 * (static_cast<std::size_t>(size_) + 1) > keys_.size()) grow();
  const std::uint64_t packed = key.packed();
  const std::size_t i = probe(packed);
  if (keys_[i] == no_key) {
    keys_[i] = packed;
    slots_[i] = size_++;
  }
  return slots_[i];
}

int VoxelIndex::find(const VoxelKey& key) const {
  if (keys_.empty()) return -1;
  const std::size_t i = probe(key.packed());
  return keys_[i] == no_key ? -1 : slots_[i];
}

void VoxelIndex::clear() {
  std::fill(keys_.begin(), keys_.end(), no_key);
  size_ = 0;
}

void VoxelIndex::grow() {
  const std::vector<std::uint64_t> old_keys = std::exchange(keys_, {});
  const std::vector<int> old_slots = std::exchange(slots_, {});
  const std::size_t capacity = std::max<std::size_t>(1024, 2 * old_keys.size());
  keys_.assign(capacity, no_key);
  slots_.assign(capacity, -1);
  for (std::size_t i = 0; i < old_keys.size(); ++i) {
    if (old_keys[i] == no_key) continue;
    const std::size_t j = probe(old_keys[i]);
    keys_[j] = old_keys[i];
    slots_[j] = old_slots[i];
  }
}

std::size_t VoxelIndex::probe(std::uint64_t packed) const {
  const std::size_t mask = keys_.size() - 1;
  std::size_t i = scramble(packed) & mask;
  while (keys_[i] != no_key && keys_[i] != packed) i = (i + 1) & mask;
  return i;
}

}  // namespace plumbline::slam
