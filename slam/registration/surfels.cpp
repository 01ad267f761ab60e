// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/surfels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "slam/registration/cell_surfels.h"
#include "slam/scan/range_noise.h"

namespace plumbline::slam {

namespace {

constexpr int reach_columns = 3;       // columns used on each side of a return, spread over the radius
constexpr double scan_rad = 6.336576;  // a scan's columns: one turn, rounded up to whole packets
// Rings three standard deviations of range noise apart: seven returns on each side know the normal to 5 degrees.
constexpr double apart_sigmas = 3.0;

/// Scatter of a return's neighbours in the ring image.
class Neighbourhood {
 public:
  Neighbourhood(const DeskewedScan& scan, const SurfelConfig& config)
      : scan_(scan),
        config_(config),
        azimuth_step_rad_(scan_rad / scan.columns),
        apart_m_(std::min(config.radius_m / reach_columns, apart_sigmas * range_noise(scan))) {}

  [[nodiscard]] std::optional<Surfel> surfel(int column, int ring) const {
    const std::size_t centre = index(column, ring);
    const Eigen::Vector3d& p = scan_.point_R[centre];
    const double range = scan_.range_m[centre];
    const double gap = std::max(config_.radius_m, config_.ring_gap_per_m * range);
    const double step_m = config_.radius_m / reach_columns;
    const int step = std::max(1, static_cast<int>(step_m / (range * azimuth_step_rad_)));

    int n = 0;
    bool other_ring = false;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    // Six sums stay in registers; a matrix is stored and loaded again for every neighbour.
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
    for (const int r : {ring_beside(column, ring, -1), ring, ring_beside(column, ring, 1)}) {
      if (r < 0) continue;
      for (int k = -reach_columns; k <= reach_columns; ++k) {
        const int c = column + k * step;
        if (c < 0 || c >= scan_.columns) continue;
        const std::size_t i = index(c, r);
        const Eigen::Vector3d offset = scan_.point_R[i] - p;
        if (scan_.range_m[i] <= 0.0 || offset.squaredNorm() > gap * gap) continue;
        ++n;
        other_ring |= r != ring;
        sum += offset;
        xx += offset.x() * offset.x();
        xy += offset.x() * offset.y();
        xz += offset.x() * offset.z();
        yy += offset.y() * offset.y();
        yz += offset.y() * offset.z();
        zz += offset.z() * offset.z();
      }
    }
    if (n < config_.min_neighbours || !other_ring) return std::nullopt;
    const Eigen::Vector3d mean = sum / n;
    Eigen::Matrix3d outer;
    outer << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    std::optional<Surfel> surfel = flat(p + mean, outer / n - mean * mean.transpose());
    if (!surfel) return surfel;
    if (!scan_.time_s.empty()) surfel->time_s = scan_.time_s[centre];
    face(*surfel, scan_.X_RL.t);
    return surfel;
  }

  /// Of a return without a surfel, see Surfaces.
  [[nodiscard]] bool is_rough(int column, int ring) const {
    const double range = scan_.range_m[index(column, ring)];
    const int step = std::max(1, static_cast<int>(config_.radius_m / reach_columns / (range * azimuth_step_rad_)));
    return stands_up(column, ring, step) && faces_sensor(column, ring, step);
  }

 private:
  [[nodiscard]] std::size_t index(int column, int ring) const {
    return static_cast<std::size_t>(column * scan_.rings + ring);
  }

  /// A return of the next rings lies more above or below it than beside it, in the robot's frame.
  [[nodiscard]] bool stands_up(int column, int ring, int step) const {
    const Eigen::Vector3d& p = scan_.point_R[index(column, ring)];
    for (const int beside : {ring - 1, ring + 1})
      for (const int c : {column - step, column, column + step}) {
        if (beside < 0 || beside >= scan_.rings || c < 0 || c >= scan_.columns) continue;
        const std::size_t i = index(c, beside);
        const Eigen::Vector3d offset = scan_.point_R[i] - p;
        const double gap = std::max(config_.radius_m, config_.ring_gap_per_m * scan_.range_m[i]);
        if (scan_.range_m[i] > 0.0 && std::abs(offset.z()) > offset.head<2>().norm() && offset.norm() < gap)
          return true;
      }
    return false;
  }

  /// Its ring goes on less than twice as far along the beam as across it, or ends here. Not borders of shadows, which
  /// nearer returns cast.
  [[nodiscard]] bool faces_sensor(int column, int ring, int step) const {
    constexpr double most_slope = 2.0;  // 63 degrees from facing: assumed
    const double range = scan_.range_m[index(column, ring)];
    int sides = 0;
    double along = 0.0;  // from the column before to the one after
    for (const int side : {-1, 1}) {
      const int c = column + side * step;
      const double r = c < 0 || c >= scan_.columns ? 0.0 : scan_.range_m[index(c, ring)];
      if (r > 0.0 && r < range - config_.radius_m) return false;
      if (r <= 0.0 || r > range + config_.radius_m) continue;
      ++sides;
      along += side * (r - range);
    }
    return std::abs(along) <= most_slope * sides * step * azimuth_step_rad_ * range;
  }

  /// The next ring above or below or, where that returns from nearer than `apart_m_`, the first one beyond that does
  /// not. -1 where there is none.
  [[nodiscard]] int ring_beside(int column, int ring, int side) const {
    const Eigen::Vector3d& p = scan_.point_R[index(column, ring)];
    int beside = -1;
    for (int r = ring + side; r >= 0 && r < scan_.rings; r += side) {
      const std::size_t i = index(column, r);
      if (scan_.range_m[i] <= 0.0 && beside >= 0) continue;
      beside = r;
      if (scan_.range_m[i] <= 0.0 || (scan_.point_R[i] - p).squaredNorm() >= apart_m_ * apart_m_) break;
    }
    return beside;
  }

  [[nodiscard]] std::optional<Surfel> flat(const Eigen::Vector3d& mean, const Eigen::Matrix3d& scatter) const {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(scatter);
    const Eigen::Vector3d& l = eigen.eigenvalues();
    const double thickest = config_.max_thickness_m * config_.max_thickness_m;
    // A line of returns has no normal: the second direction must stand out of the first.
    if (l(0) > thickest || l(1) < 2.0 * l(0)) return std::nullopt;
    return Surfel{mean, eigen.eigenvectors().col(0), 0.0F};
  }

  const DeskewedScan& scan_;
  const SurfelConfig& config_;
  const double azimuth_step_rad_;  ///< between columns
  const double apart_m_;           ///< least distance to other rings
};

Surfaces surfaces_of_cells(const DeskewedScan& scan, const SurfelConfig& config) {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> times;
  points.reserve(scan.range_m.size());
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    if (!(scan.range_m[i] >= config.min_range_m && scan.range_m[i] <= config.max_range_m && scan.range_m[i] > 0.0))
      continue;
    points.push_back(scan.point_R[i].cast<float>());
    if (!scan.time_s.empty()) times.push_back(scan.time_s[i]);
  }
  return cell_surfaces(points, {config.voxel_m, config.min_neighbours, config.max_thickness_m, scan.X_RL.t}, times);
}

}  // namespace

bool has_ring_image(const DeskewedScan& scan) {
  // With many rings every voxel has neighbours to all sides, and ten columns of a ring span centimetres.
  constexpr int fewest_rings = 8, most_rings = 40;
  return scan.rings >= fewest_rings && scan.rings <= most_rings;
}

std::vector<Surfel> make_surfels(const DeskewedScan& scan, const SurfelConfig& config) {
  return find_surfaces(scan, config).surfels;
}

Surfaces find_surfaces(const DeskewedScan& scan, const SurfelConfig& config) {
  if (!has_ring_image(scan)) return surfaces_of_cells(scan, config);
  const Neighbourhood neighbourhood(scan, config);
  VoxelIndex seen;
  Surfaces result;
  for (int column = 0; column < scan.columns; ++column)
    for (int ring = 0; ring < scan.rings; ++ring) {
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (scan.range_m[i] < config.min_range_m || scan.range_m[i] > config.max_range_m) continue;
      const int before = seen.size();
      if (seen.insert(VoxelKey::of(scan.point_R[i], config.voxel_m)) < before) continue;
      if (const std::optional<Surfel> surfel = neighbourhood.surfel(column, ring))
        result.surfels.push_back(*surfel);
      else if (neighbourhood.is_rough(column, ring))
        result.rough_R.push_back(scan.point_R[i]);
    }
  return result;
}

void face(Surfel& surfel, const Eigen::Vector3d& sensor_R) {
  // Two standard deviations of a normal of seven returns on each side, see apart_sigmas.
  constexpr double least_cosine = 0.17;
  const Eigen::Vector3d to_sensor = sensor_R - surfel.mean_R;
  const double towards = surfel.normal_R.dot(to_sensor);
  if (towards < 0.0) surfel.normal_R = -surfel.normal_R;
  surfel.faces_sensor = std::abs(towards) > least_cosine * to_sensor.norm();
}

std::optional<SurfelMap::Voxel> SurfelMap::find(const Eigen::Vector3d& p_M, const Eigen::Vector3d& normal_M,
                                                bool faces_sensor, double min_normal_agreement) const {
  const auto seen_at = [&](const VoxelKey& at) -> std::optional<Voxel> {
    const int known = index_.find(at);
    if (known < 0) return std::nullopt;
    const Voxel *of_a_side = nullptr, *of_unknown = nullptr;
    for (int slot = first_[static_cast<std::size_t>(known)]; slot >= 0;) {
      const Voxel& voxel = voxels_[static_cast<std::size_t>(slot)];
      slot = voxel.next;
      if (voxel.n < 0.5 || normal_M.dot(voxel.normals * normal_M) < min_normal_agreement * voxel.n) continue;
      if (voxel.side == 0)
        of_unknown = &voxel;
      else if (!faces_sensor || normal_M.dot(voxel.facing) > 0.0)
        if (of_a_side == nullptr || voxel.n > of_a_side->n) of_a_side = &voxel;
    }
    if (of_a_side == nullptr || of_unknown == nullptr) {
      if (of_a_side == nullptr && of_unknown == nullptr) return std::nullopt;
      return of_a_side != nullptr ? *of_a_side : *of_unknown;
    }
    Voxel both = *of_a_side;
    both.n += of_unknown->n;
    both.sum += of_unknown->sum;
    both.normals += of_unknown->normals;
    return both;
  };
  const VoxelKey key = VoxelKey::of(p_M, voxel_m_);
  if (const std::optional<Voxel> voxel = seen_at(key)) return voxel;

  struct Face {
    double distance;
    VoxelKey beyond;
  };
  const Eigen::Vector3d inside = p_M / voxel_m_ - Eigen::Vector3d(key.x, key.y, key.z);
  const auto side = [](double s) { return s < 0.5 ? -1 : 1; };
  const auto distance = [](double s) { return std::min(s, 1.0 - s); };
  std::array<Face, 3> faces = {Face{distance(inside.x()), {key.x + side(inside.x()), key.y, key.z}},
                               Face{distance(inside.y()), {key.x, key.y + side(inside.y()), key.z}},
                               Face{distance(inside.z()), {key.x, key.y, key.z + side(inside.z())}}};
  // By insertion: std::stable_sort takes memory for each call.
  for (std::size_t k = 1; k < faces.size(); ++k)
    for (std::size_t i = k; i > 0 && faces[i].distance < faces[i - 1].distance; --i) std::swap(faces[i], faces[i - 1]);
  for (const Face& face : faces)
    if (const std::optional<Voxel> voxel = seen_at(face.beyond)) return voxel;
  return std::nullopt;
}

std::size_t SurfelMap::slot_of(const VoxelKey& key, int side) {
  const auto known = static_cast<std::size_t>(index_.insert(key));
  if (known == first_.size()) first_.push_back(-1);
  int* link = &first_[known];
  while (*link >= 0 && voxels_[static_cast<std::size_t>(*link)].side != side)
    link = &voxels_[static_cast<std::size_t>(*link)].next;
  if (*link < 0) {
    *link = static_cast<int>(voxels_.size());  // before the link may move
    Voxel& voxel = voxels_.emplace_back();
    voxel.side = side;
    return voxels_.size() - 1;
  }
  return static_cast<std::size_t>(*link);
}

void SurfelMap::pool(std::span<const Surfel> surfels, const Pose& X_MR, double sign) {
  // Tells the sides of any surface but those along it, by the normal alone: what was added is found again.
  const Eigen::Vector3d oblique(0.36, 0.48, 0.80);
  const Eigen::Matrix3d R_MR = X_MR.rotation();
  for (const Surfel& surfel : surfels) {
    const Eigen::Vector3d mean_M = R_MR * surfel.mean_R + X_MR.t;
    const Eigen::Vector3d normal_M = R_MR * surfel.normal_R;
    const int side = !surfel.faces_sensor ? 0 : normal_M.dot(oblique) < 0.0 ? -1 : 1;
    Voxel& voxel = voxels_[slot_of(VoxelKey::of(mean_M, voxel_m_), side)];
    const bool was_empty = voxel.n < 0.5;
    voxel.n += sign;
    voxel.sum += sign * mean_M;
    voxel.normals += sign * normal_M * normal_M.transpose();
    if (surfel.faces_sensor) voxel.facing += sign * normal_M;
    const bool is_empty = voxel.n < 0.5;
    if (was_empty && !is_empty) ++live_;
    if (!was_empty && is_empty) --live_;
    if (!is_empty) continue;
    voxel.n = 0.0;
    voxel.sum.setZero();
    voxel.normals.setZero();
    voxel.facing.setZero();
  }
}

}  // namespace plumbline::slam
