// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace plumbline::slam {

/// Integer cell of a voxel grid that is aligned with its frame's axes; ordered by z, y, x.
struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;

  /// InternalError beyond a million cells from the origin.
  [[nodiscard]] static VoxelKey of(const Eigen::Vector3d& p, double size) {
    return {cell(p.x() / size), cell(p.y() / size), cell(p.z() / size)};
  }
  /// bits_per_axis bits an axis, z first: order-preserving, and the voxel beside along x, y, z is 1, packed_row,
  /// packed_layer away.
  [[nodiscard]] std::uint64_t packed() const {
    const auto bits = [](std::int32_t c) { return static_cast<std::uint64_t>(c + axis_offset); };
    return (bits(z) << 2 * bits_per_axis) | (bits(y) << bits_per_axis) | bits(x);
  }
  static constexpr unsigned bits_per_axis = 21;
  static constexpr std::int64_t packed_row = std::int64_t{1} << bits_per_axis;
  static constexpr std::int64_t packed_layer = packed_row << bits_per_axis;
  friend bool operator==(const VoxelKey&, const VoxelKey&) = default;

 private:
  static constexpr std::int32_t axis_offset = 1 << (bits_per_axis - 1);

  [[nodiscard]] static std::int32_t cell(double c) {
    if (!(c >= 1.0 - static_cast<double>(axis_offset) && c < static_cast<double>(axis_offset))) fail_too_far();
    const auto towards_zero = static_cast<std::int32_t>(c);  // without SSE4, floor is a call
    return towards_zero - (c < static_cast<double>(towards_zero) ? 1 : 0);
  }
  [[noreturn]] static void fail_too_far();
};

/// One point per occupied voxel (the mean of its points, summed in their order), ordered by voxel; size in m.
[[nodiscard]] std::vector<Eigen::Vector3d> voxel_downsample(const std::vector<Eigen::Vector3d>& points, double size);

/// Voxels by key, for lookups only: its order of iteration is the order of insertion, so it is deterministic. Open
/// addressing; never shrinks.
class VoxelIndex {
 public:
  /// Slot of a voxel: existing, or the next free one (0, 1, 2, ...).
  [[nodiscard]] int insert(const VoxelKey& key) {
    if (2 * (static_cast<std::size_t>(size_) + 1) > entries_.size()) grow();
    const std::uint64_t packed = key.packed();
    Entry& entry = entries_[probe(packed)];
    if (entry.key == no_key) entry = {packed, size_++};
    return entry.slot;
  }
  /// Slot of a voxel, -1 when it is not there.
  [[nodiscard]] int find(const VoxelKey& key) const {
    return entries_.empty() ? -1 : entries_[probe(key.packed())].slot;
  }
  [[nodiscard]] int size() const { return size_; }
  void clear();

 private:
  static constexpr std::uint64_t no_key = std::numeric_limits<std::uint64_t>::max();
  struct Entry {
    std::uint64_t key = no_key;
    int slot = -1;
  };

  void grow();
  /// Spreads neighbouring cells over the table (64-bit finaliser of a multiply-xorshift hash).
  [[nodiscard]] static std::uint64_t scramble(std::uint64_t k) {
    k ^= k >> 31U;
    k *= 0x9e3779b97f4a7c15ULL;
    k ^= k >> 29U;
    return k;
  }
  /// Where an entry is, or would be.
  [[nodiscard]] std::size_t probe(std::uint64_t packed) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t i = scramble(packed) & mask;
    while (entries_[i].key != no_key && entries_[i].key != packed) i = (i + 1) & mask;
    return i;
  }

  std::vector<Entry> entries_;
  int size_ = 0;
};

/// Mean points of voxels, point by point; size in m.
class VoxelMeans {
 public:
  explicit VoxelMeans(double size_m) : size_m_(size_m) {}

  /// Slot of the point's voxel: 0, 1, 2, ... as voxels come.
  int add(const Eigen::Vector3d& p);
  /// Slot of the voxel that holds p, -1 when no point was in it.
  [[nodiscard]] int find(const Eigen::Vector3d& p) const { return index_.find(VoxelKey::of(p, size_m_)); }
  /// Summed in the order in which points came, ordered by voxel.
  [[nodiscard]] std::vector<Eigen::Vector3d> means() const;

 private:
  struct Sum {
    std::uint64_t key = 0;
    std::size_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  };

  double size_m_;
  VoxelIndex index_;
  std::vector<Sum> sums_;  ///< index = slot
};

}  // namespace plumbline::slam
