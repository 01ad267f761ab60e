// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/voxel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr std::int32_t axis_offset = 1 << 20;
constexpr std::uint64_t no_key = std::numeric_limits<std::uint64_t>::max();

std::int32_t cell(double x, double size) {
  const double c = std::floor(x / size);
  if (!(std::abs(c) < static_cast<double>(axis_offset)))
    throw InternalError("a point is too far away for its voxel grid");
  return static_cast<std::int32_t>(c);
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
  return (bits(z) << 42U) | (bits(y) << 21U) | bits(x);
}

std::vector<Eigen::Vector3d> voxel_downsample(const std::vector<Eigen::Vector3d>& points, double size) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    order.emplace_back(VoxelKey::of(points[i], size).packed(), static_cast<std::uint32_t>(i));
  std::sort(order.begin(), order.end());

  std::vector<Eigen::Vector3d> means;
  for (std::size_t begin = 0; begin < order.size();) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t end = begin;
    for (; end < order.size() && order[end].first == order[begin].first; ++end) sum += points[order[end].second];
    means.emplace_back(sum / static_cast<double>(end - begin));
    begin = end;
  }
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
