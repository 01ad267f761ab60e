// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/cell_surfels.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/scan/moments.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

/// Sums over one voxel's points, less its centre: far from the origin squares would drown differences.
struct Cell {
  VoxelKey key;
  Moments moments;
  double time_s = 0.0;  ///< sum
};

class Cells {
 public:
  Cells(std::span<const Eigen::Vector3f> points, std::span<const float> times_s, const CellSurfels& config)
      : size_(config.size_m) {
    std::size_t slot = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f& point = points[i];
      if (!point.allFinite()) continue;
      const Eigen::Vector3d p = point.cast<double>();
      const VoxelKey key = VoxelKey::of(p, size_);
      // Points come along scan lines: most fall into the last one's cell.
      if (cells_.empty() || !(key == cells_[slot].key)) slot = slot_of(key);
      cells_[slot].moments.add(p - centre(key));
      if (!times_s.empty()) cells_[slot].time_s += static_cast<double>(times_s[i]);
    }
  }

  /// Twice as large.
  [[nodiscard]] Cells doubled() const {
    Cells large(2.0 * size_);
    for (const Cell& cell : cells_) {
      Cell& sum = large.cells_[large.slot_of(half(cell.key))];
      sum.moments.add(cell.moments.moved(centre(cell.key) - large.centre(sum.key)));
    }
    return large;
  }
  /// The one of doubled() that holds a voxel.
  [[nodiscard]] static VoxelKey half(const VoxelKey& key) { return {key.x >> 1, key.y >> 1, key.z >> 1}; }

  [[nodiscard]] const std::vector<Cell>& all() const { return cells_; }
  [[nodiscard]] Eigen::Vector3d centre(const VoxelKey& key) const {
    return size_ * (Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5));
  }

  /// Of a voxel and the six that share a face with it, about its centre.
  [[nodiscard]] Moments round(const VoxelKey& key) const {
    Moments sum;
    if (const Cell* here = find(key)) sum = here->moments;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const Eigen::Vector3i step = side * Eigen::Vector3i::Unit(axis);
        if (const Cell* beside = find({key.x + step.x(), key.y + step.y(), key.z + step.z()}))
          sum.add(beside->moments.moved_along(axis, size_ * side));
      }
    return sum;
  }

 private:
  explicit Cells(double size) : size_(size) {}

  [[nodiscard]] const Cell* find(const VoxelKey& key) const {
    const int slot = index_.find(key);
    return slot < 0 ? nullptr : &cells_[static_cast<std::size_t>(slot)];
  }
  [[nodiscard]] std::size_t slot_of(const VoxelKey& key) {
    const auto slot = static_cast<std::size_t>(index_.insert(key));
    if (slot == cells_.size()) cells_.push_back({key, {}, 0.0});
    return slot;
  }

  double size_;
  VoxelIndex index_;
  std::vector<Cell> cells_;
};

/// Whether points are seen in one line: their second standard deviation across the beam is below a twentieth of the
/// first, or below 1 mrad. The cone of a ring bends less within a voxel, unless it is steep and near; two rings of a
/// VLP-16 are 35 mrad apart. Chosen on lc1, a copy of it without doors, quickstart, se3 and a street with 64 rings.
bool is_line_of_sight(const Moments& moments, const Eigen::Vector3d& origin_from_sensor) {
  constexpr double least_width = 0.05, least_rad = 0.001;
  const Eigen::Matrix3d c = moments.covariance();
  const Eigen::Vector3d mean = moments.mean() + origin_from_sensor;
  const Eigen::Vector3d beam = mean.normalized();
  // Variances across the beam from their sum and, by the adjugate, their product.
  Eigen::Matrix3d adjugate;
  adjugate << c.col(1).cross(c.col(2)), c.col(2).cross(c.col(0)), c.col(0).cross(c.col(1));
  const double half = 0.5 * (c.trace() - beam.dot(c * beam)), product = beam.dot(adjugate * beam);
  const double length2 = half + std::sqrt(std::max(0.0, half * half - product));
  const double width2 = length2 > 0.0 ? product / length2 : 0.0;
  return width2 < least_rad * least_rad * mean.squaredNorm() || width2 < least_width * least_width * length2;
}

/// flatness: least ratio of the second variance to that across.
std::optional<Eigen::Vector3d> normal_of(const Moments& moments, double thickest, double flatness) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(moments.covariance());
  const Eigen::Vector3d& l = eigen.eigenvalues();
  if (l(0) > thickest * thickest || l(1) < flatness * l(0)) return std::nullopt;
  return eigen.eigenvectors().col(0);
}

/// Whether points round a voxel are enough, and seen as more than a line.
bool span_a_surface(const Moments& round, const Eigen::Vector3d& centre, const CellSurfels& config) {
  return round.n >= config.min_points && !(config.sensor && is_line_of_sight(round, centre - *config.sensor));
}

/// Of a voxel and those round it, else of the larger ones. A line of points has no normal: the second direction must
/// stand out of the first. In voxels twice as large it is twice as long, and noise is the same.
std::optional<Eigen::Vector3d> normal_at(const Cells& cells, const VoxelKey& key, const std::optional<Cells>& larger,
                                         const CellSurfels& config) {
  constexpr double flatness = 2.0;
  const Moments round = cells.round(key);
  if (span_a_surface(round, cells.centre(key), config)) return normal_of(round, config.max_thickness_m, flatness);
  if (!larger) return std::nullopt;
  const Moments beyond = larger->round(Cells::half(key));
  if (!span_a_surface(beyond, larger->centre(Cells::half(key)), config)) return std::nullopt;
  return normal_of(beyond, config.max_thickness_m, 4.0 * flatness);
}

/// Whether the points of a voxel and of those round it lie neither in a plane nor, as seen, in a line. Few do not tell:
/// along a bare tunnel they go along with the robot.
bool is_rough(const Cells& cells, const VoxelKey& key, const CellSurfels& config) {
  constexpr double few = 4.0;
  const Moments round = cells.round(key);
  if (round.n < few) return false;
  if (config.sensor && is_line_of_sight(round, cells.centre(key) - *config.sensor)) return false;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(round.covariance(), Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(1) > config.max_thickness_m * config.max_thickness_m;
}

}  // namespace

std::vector<Surfel> cell_surfels(std::span<const Eigen::Vector3f> points, const CellSurfels& config,
                                 std::span<const float> times_s) {
  return cell_surfaces(points, config, times_s).surfels;
}

Surfaces cell_surfaces(std::span<const Eigen::Vector3f> points, const CellSurfels& config,
                       std::span<const float> times_s) {
  const Cells cells(points, times_s, config);
  const std::optional<Cells> larger = config.sensor ? std::optional(cells.doubled()) : std::nullopt;
  Surfaces result;
  for (const Cell& cell : cells.all()) {
    const Eigen::Vector3d mean = cells.centre(cell.key) + cell.moments.mean();
    if (const std::optional<Eigen::Vector3d> normal = normal_at(cells, cell.key, larger, config)) {
      result.surfels.push_back({mean, *normal, static_cast<float>(cell.time_s / cell.moments.n)});
      if (config.sensor) face(result.surfels.back(), *config.sensor);
    } else if (is_rough(cells, cell.key, config))
      result.rough_R.push_back(mean);
  }
  return result;
}

}  // namespace plumbline::slam
