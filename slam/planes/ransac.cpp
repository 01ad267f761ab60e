// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/ransac.h"

#include <emmintrin.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "bim/random/stream.h"
#include "slam/planes/forms.h"
#include "slam/planes/patch.h"
#include "slam/planes/sac_segmentation.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

/// First return of every voxel in the range gate, in firing order.
std::vector<std::uint32_t> thinned(const DeskewedScan& scan, const RansacConfig& config) {
  std::vector<std::uint32_t> points;
  VoxelIndex voxels;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    if (scan.range_m[i] < config.min_range_m || scan.range_m[i] > config.max_range_m) continue;
    if (voxels.insert(VoxelKey::of(scan.point_R[i], config.voxel_m)) == static_cast<int>(points.size()))
      points.push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

std::optional<Plane> plane_through(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double size = normal.norm();
  if (size < 1e-6) return std::nullopt;
  const Eigen::Vector3d n = normal / size;
  return Plane{n, -n.dot(a)};
}

/// Points two by two, so that a plane is tested against both at once; the second of an odd last pair is no number.
class Sampler {
 public:
  Sampler(const DeskewedScan& scan, const std::vector<std::uint32_t>& points, const RansacConfig& config)
      : config_(config) {
    points_.reserve(points.size());
    for (const std::uint32_t i : points) points_.push_back(scan.point_R[i]);
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < points_.size(); k += 2) {
      const Eigen::Vector3d& a = points_[k];
      const Eigen::Vector3d b = k + 1 < points_.size() ? points_[k + 1] : Eigen::Vector3d::Constant(none);
      pairs_.push_back({_mm_setr_pd(a.x(), b.x()), _mm_setr_pd(a.y(), b.y()), _mm_setr_pd(a.z(), b.z())});
    }
  }

  /// The plane with most inliers (ties: the earlier sample); nothing when no three points span one.
  [[nodiscard]] std::optional<Plane> best(const Stream& stream, std::uint64_t tick, std::uint32_t round) const {
    std::optional<Plane> best;
    std::int64_t most = 0;
    double needed = config_.iterations;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(needed); ++i) {
      const auto point = [&](std::uint32_t draw) -> Eigen::Vector3d {
        const double u = stream.uniform(tick, round, 3 * i + draw);
        return points_[static_cast<std::size_t>(u * static_cast<double>(points_.size()))];
      };
      const std::optional<Plane> plane = plane_through(point(0), point(1), point(2));
      if (!plane) continue;
      const std::int64_t inliers = count(*plane);
      if (inliers <= most) continue;
      most = inliers;
      best = plane;
      needed = std::min(needed, samples(static_cast<double>(most) / static_cast<double>(points_.size())));
    }
    return best;
  }

 private:
  struct Pair {
    __m128d x, y, z;
  };

  [[nodiscard]] std::int64_t count(const Plane& plane) const {
    const __m128d nx = _mm_set1_pd(plane.n.x()), ny = _mm_set1_pd(plane.n.y()), nz = _mm_set1_pd(plane.n.z());
    const __m128d d = _mm_set1_pd(plane.d), reach = _mm_set1_pd(config_.distance_m), sign = _mm_set1_pd(-0.0);
    __m128i within = _mm_setzero_si128();
    for (const Pair& p : pairs_) {
      const __m128d sum = _mm_add_pd(_mm_add_pd(_mm_mul_pd(nx, p.x), _mm_mul_pd(ny, p.y)), _mm_mul_pd(nz, p.z));
      const __m128d near = _mm_cmple_pd(_mm_andnot_pd(sign, _mm_add_pd(sum, d)), reach);  // all bits: -1
      within = _mm_sub_epi64(within, _mm_castpd_si128(near));
    }
    alignas(16) std::array<std::int64_t, 2> counts{};
    _mm_store_si128(reinterpret_cast<__m128i*>(counts.data()), within);
    return counts[0] + counts[1];
  }

  /// Samples until one of three inliers has come up with the wanted confidence.
  [[nodiscard]] double samples(double share) const {
    const double clean = share * share * share;
    if (clean >= 1.0) return 1.0;
    return std::ceil(std::log(1.0 - config_.confidence) / std::log1p(-clean));
  }

  const RansacConfig& config_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Pair> pairs_;
};

/// A plane and its returns.
struct PlanePoints {
  Plane plane;
  std::vector<std::uint32_t> inliers;
};

/// Takes the inliers out of `points`; nothing when no three points span a plane.
std::optional<PlanePoints> take_plane(const DeskewedScan& scan, const RansacConfig& config, const Stream& stream,
                                      std::uint32_t round, std::vector<std::uint32_t>& points) {
  const std::optional<Plane> plane =
      Sampler(scan, points, config).best(stream, static_cast<std::uint64_t>(scan.stamp), round);
  if (!plane) return std::nullopt;
  std::vector<std::uint32_t> inliers, rest;
  for (const std::uint32_t i : points)
    (std::abs(plane->distance(scan.point_R[i])) <= config.distance_m ? inliers : rest).push_back(i);
  points = std::move(rest);
  return PlanePoints{*plane, std::move(inliers)};
}

/// The same by PCL.
std::optional<PlanePoints> take_pcl_plane(const DeskewedScan& scan, const RansacConfig& config,
                                          std::vector<std::uint32_t>& points) {
  std::vector<Eigen::Vector3d> points_R;
  points_R.reserve(points.size());
  for (const std::uint32_t i : points) points_R.push_back(scan.point_R[i]);
  const std::optional<SacPlane> found = sac_plane(points_R, config.distance_m, config.iterations, config.confidence);
  if (!found) return std::nullopt;
  PlanePoints taken{found->plane, {}};
  std::vector<std::uint32_t> rest;
  auto inlier = found->inliers.begin();
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    const bool in = inlier != found->inliers.end() && *inlier == k;
    (in ? taken.inliers : rest).push_back(points[k]);
    if (in) ++inlier;
  }
  points = std::move(rest);
  return taken;
}

/// Stretches of a plane's points: those at most two cells of half the gap apart belong together. By first point.
std::vector<std::vector<std::uint32_t>> stretches(const DeskewedScan& scan, const Plane& plane,
                                                  const std::vector<std::uint32_t>& points, double gap_m) {
  const Tangents t = plane_tangents(plane.n);
  struct Cell {
    int i, j;
    std::size_t point;
  };
  std::vector<Cell> cells;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d& p = scan.point_R[points[k]];
    cells.push_back({static_cast<int>(std::floor(2.0 * t.u.dot(p) / gap_m)),
                     static_cast<int>(std::floor(2.0 * t.v.dot(p) / gap_m)), k});
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return std::tie(a.i, a.j, a.point) < std::tie(b.i, b.j, b.point); });
  std::vector<std::size_t> parent(points.size());
  for (std::size_t k = 0; k < parent.size(); ++k) parent[k] = k;
  const auto root = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  const auto find = [&](int i, int j) {
    return std::lower_bound(
        cells.begin(), cells.end(), std::pair{i, j},
        [](const Cell& c, const std::pair<int, int>& k) { return std::tie(c.i, c.j) < std::tie(k.first, k.second); });
  };
  for (const Cell& cell : cells)
    for (int di = 0; di <= 2; ++di) {
      const auto from = find(cell.i + di, cell.j - 2);
      for (auto it = from; it != cells.end() && it->i == cell.i + di && it->j <= cell.j + 2; ++it) {
        const std::size_t a = root(cell.point), b = root(it->point);
        parent[std::max(a, b)] = std::min(a, b);
        while (std::next(it) != cells.end() && std::next(it)->i == it->i && std::next(it)->j == it->j) ++it;
      }
    }
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<std::size_t> slot(points.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t r = root(k);
    if (slot[r] == points.size()) {
      slot[r] = result.size();
      result.emplace_back();
    }
    result[slot[r]].push_back(points[k]);
  }
  return result;
}

/// The patches of one plane: small stretches are dropped, the others pooled where they lie near each other.
void add_patches(const DeskewedScan& scan, const Plane& plane, const std::vector<std::uint32_t>& inliers,
                 const RansacConfig& config, const PlaneDetectorConfig& noise, std::vector<PlaneObservation>& planes) {
  std::vector<std::uint32_t> clean;
  for (const std::vector<std::uint32_t>& stretch : stretches(scan, plane, inliers, config.cluster_gap_m))
    if (stretch.size() >= static_cast<std::size_t>(config.cluster_points))
      clean.insert(clean.end(), stretch.begin(), stretch.end());
  const bool level = axis_of(plane.n) == PlaneAxis::horizontal;
  PlaneDetectorConfig fit = noise;
  fit.max_distance_m = config.distance_m;
  fit.min_points = level ? config.min_horizontal : config.min_inliers;
  for (const std::vector<std::uint32_t>& stretch : stretches(scan, plane, clean, config.merge_gap_m)) {
    std::optional<PlaneObservation> patch = fit_patch(scan, stretch, plane, fit);
    if (!patch) continue;
    patch->vertical = !level;
    planes.push_back(*patch);
  }
}

}  // namespace

std::vector<PlaneObservation> ransac_planes(const DeskewedScan& scan, const RansacConfig& config,
                                            const PlaneDetectorConfig& noise, std::uint64_t seed) {
  const Stream stream(seed, "slam.ransac");
  std::vector<std::uint32_t> points = thinned(scan, config);
  std::vector<PlaneObservation> planes;
  for (std::uint32_t round = 0; points.size() > static_cast<std::size_t>(config.min_left); ++round) {
    const std::optional<PlanePoints> found = config.source == RansacSource::pcl
                                                 ? take_pcl_plane(scan, config, points)
                                                 : take_plane(scan, config, stream, round, points);
    if (!found) break;
    const bool level = axis_of(found->plane.n) == PlaneAxis::horizontal;
    const auto enough = static_cast<std::size_t>(level ? config.min_horizontal : config.min_inliers);
    if (found->inliers.size() >= enough) add_patches(scan, found->plane, found->inliers, config, noise, planes);
  }
  return planes;
}

}  // namespace plumbline::slam
