// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace plumbline::slam {

/// Integer cell of a voxel grid that is aligned with its frame's axes; ordered by z, y, x.
struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;

  /// InternalError beyond a million cells from the origin.
  [[nodiscard]] static VoxelKey of(const Eigen::Vector3d& p, double size);
  /// bits_per_axis bits an axis, z first: order-preserving, and the voxel beside along x, y, z is 1, packed_row,
  /// packed_layer away.
  [[nodiscard]] std::uint64_t packed() const;
  static constexpr unsigned bits_per_axis = 21;
  static constexpr std::int64_t packed_row = std::int64_t{1} << bits_per_axis;
  static constexpr std::int64_t packed_layer = packed_row << bits_per_axis;
  friend bool operator==(const VoxelKey&, const VoxelKey&) = default;
};

/// One point per occupied voxel (the mean of its points, summed in their order), ordered by voxel; size in m.
[[nodiscard]] std::vector<Eigen::Vector3d> voxel_downsample(const std::vector<Eigen::Vector3d>& points, double size);

/// Voxels by key, for lookups only: its order of iteration is the order of insertion, so it is deterministic. Open
/// addressing; never shrinks.
class VoxelIndex {
 public:
  /// Slot of a voxel: existing, or the next free one (0, 1, 2, ...).
  [[nodiscard]] int insert(const VoxelKey& key);
  /// Slot of a voxel, -1 when it is not there.
  [[nodiscard]] int find(const VoxelKey& key) const;
  [[nodiscard]] int size() const { return size_; }
  void clear();

 private:
  void grow();
  [[nodiscard]] std::size_t probe(std::uint64_t packed) const;

  std::vector<std::uint64_t> keys_;
  std::vector<int> slots_;
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
