// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/plane_detector.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "slam/planes/horizontal.h"
#include "slam/planes/patch.h"
#include "slam/planes/segments.h"
#include "slam/scan/moments.h"

namespace plumbline::slam {

namespace {

/// A wall while it collects segments.
struct Wall {
  Plane plane;
  Moments moments;
  std::vector<std::size_t> segments;
  double s0 = 0.0, s1 = 0.0;  ///< extent along u at the time of the last join
};

/// Upright plane through a segment, normal towards the sensor.
Plane upright_plane(const RingSegment& segment, const Eigen::Vector3d& sensor_R) {
  const Eigen::Vector3d n(-segment.direction.y(), segment.direction.x(), 0.0);
  const Plane plane{n, -n.dot(segment.moments.mean())};
  return plane.distance(sensor_R) >= 0.0 ? plane : plane.flipped();
}

class WallGrower {
 public:
  WallGrower(const DeskewedScan& scan, const std::vector<RingSegment>& segments, const PlaneDetectorConfig& config)
      : scan_(scan), segments_(segments), config_(config), taken_(segments.size(), false) {
    const double tilt = config.max_tilt_prior_deg * std::numbers::pi / 180.0;
    tilt_weight_ = config.segment_rms_m * config.segment_rms_m / (tilt * tilt);
    ring_starts_.assign(static_cast<std::size_t>(scan.rings) + 1, segments.size());
    for (std::size_t i = segments.size(); i-- > 0;) ring_starts_[static_cast<std::size_t>(segments[i].ring)] = i;
    for (std::size_t ring = ring_starts_.size() - 1; ring-- > 0;)
      ring_starts_[ring] = std::min(ring_starts_[ring], ring_starts_[ring + 1]);
  }

  /// Every segment once as seed, most points first (ties: lower index).
  [[nodiscard]] std::vector<Wall> grow_all() {
    std::vector<std::size_t> order(segments_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return segments_[a].points.size() > segments_[b].points.size();
    });
    std::vector<Wall> walls;
    for (const std::size_t seed : order)
      if (!taken_[seed]) walls.push_back(grow(seed));
    return walls;
  }

 private:
  /// Takes segments of the nearest rings first, so that the tilt is known before far rings are added.
  [[nodiscard]] Wall grow(std::size_t seed) {
    Wall wall;
    wall.plane = upright_plane(segments_[seed], scan_.X_RL.t);
    join(wall, seed);
    const std::size_t rings = ring_starts_.size() - 1, own = static_cast<std::size_t>(segments_[seed].ring);
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t away = 0; away < rings; ++away) {
        if (away <= own) grown |= join_ring(wall, own - away);
        if (away > 0 && own + away < rings) grown |= join_ring(wall, own + away);
      }
    }
    return wall;
  }

  /// What of a ring fits; true where something did.
  bool join_ring(Wall& wall, std::size_t ring) {
    bool grown = false;
    for (std::size_t i = ring_starts_[ring]; i < ring_starts_[ring + 1]; ++i) {
      if (taken_[i] || !fits(wall, segments_[i])) continue;
      join(wall, i);
      grown = true;
    }
    return grown;
  }

  void join(Wall& wall, std::size_t i) {
    taken_[i] = true;
    wall.segments.push_back(i);
    wall.moments.add(segments_[i].moments);
    wall.plane = refine_plane(wall.moments, wall.plane, tilt_weight_);
    const Eigen::Vector3d u = plane_tangents(wall.plane.n).u;
    wall.s0 = std::numeric_limits<double>::infinity();
    wall.s1 = -wall.s0;
    for (const std::size_t k : wall.segments) {
      const double a = u.dot(segments_[k].p0_R);
      const double b = u.dot(segments_[k].p1_R);
      wall.s0 = std::min({wall.s0, a, b});
      wall.s1 = std::max({wall.s1, a, b});
    }
  }

  [[nodiscard]] bool fits(const Wall& wall, const RingSegment& segment) const {
    const double d0 = wall.plane.distance(segment.p0_R);
    const double d1 = wall.plane.distance(segment.p1_R);
    if (std::abs(d0) > config_.max_distance_m || std::abs(d1) > config_.max_distance_m) return false;
    if (std::abs(d0 - d1) > turn_gate(segment)) return false;
    const Eigen::Vector3d u = plane_tangents(wall.plane.n).u;
    const double a = u.dot(segment.p0_R);
    const double b = u.dot(segment.p1_R);
    // Seen along the wall a segment must run along it too, not through it.
    if (std::abs(b - a) < 0.9 * (segment.p1_R - segment.p0_R).head<2>().norm()) return false;
    return std::max(wall.s0, std::min(a, b)) - std::min(wall.s1, std::max(a, b)) <= config_.merge_gap_m;
  }

  /// Of many points the direction is known well: 3 sigma of what noise turns a line's ends apart, over a bias.
  [[nodiscard]] double turn_gate(const RingSegment& segment) const {
    const double noise = 3.0 * std::sqrt(12.0 / segment.moments.n) * 0.5 * config_.segment_rms_m;
    return std::min(config_.max_turn_m, config_.max_turn_m / 3.0 + noise);
  }

  const DeskewedScan& scan_;
  const std::vector<RingSegment>& segments_;
  const PlaneDetectorConfig& config_;
  std::vector<bool> taken_;
  std::vector<std::size_t> ring_starts_;  ///< first segment of each ring, and the end
  double tilt_weight_ = 0.0;              ///< points times m^2: variance of a point over that of the tilt
};

/// Fits the wall to its points without any prior on its tilt; nothing when it is too small for a wall.
std::optional<PlaneObservation> observe_wall(const DeskewedScan& scan, const std::vector<RingSegment>& segments,
                                             const Wall& wall, const PlaneDetectorConfig& config) {
  std::vector<int> rings;
  std::vector<std::uint32_t> points;
  for (const std::size_t k : wall.segments) {
    rings.push_back(segments[k].ring);
    points.insert(points.end(), segments[k].points.begin(), segments[k].points.end());
  }
  std::sort(rings.begin(), rings.end());
  const auto distinct = std::unique(rings.begin(), rings.end()) - rings.begin();
  if (distinct < config.min_rings || points.size() < static_cast<std::size_t>(config.min_points)) return std::nullopt;
  const std::optional<PlaneObservation> patch = fit_patch(scan, points, wall.plane, config);
  if (!patch || (patch->p1_R - patch->p0_R).norm() < config.min_length_m) return std::nullopt;
  if (patch->z1 - patch->z0 < config.min_height_m) return std::nullopt;
  const double tilt = std::asin(std::min(1.0, std::abs(patch->plane_R.n.z())));
  if (tilt > config.vertical_max_tilt_deg * std::numbers::pi / 180.0) return std::nullopt;
  return patch;
}

/// Whether a wall is a mixture of what a longer one runs through: it lies along that one, on the same side and within a
/// niche's depth of it, and yet is turned out of it.
bool runs_through(const PlaneObservation& wall, const PlaneObservation& longer, const PlaneDetectorConfig& config) {
  const double length = (wall.p1_R - wall.p0_R).norm();
  if (length >= (longer.p1_R - longer.p0_R).norm() || wall.plane_R.n.dot(longer.plane_R.n) < 0.9) return false;
  if (std::abs(longer.plane_R.distance(wall.centroid_R)) > config.niche_m) return false;
  const Eigen::Vector3d u = plane_tangents(longer.plane_R.n).u;
  if (std::abs(wall.plane_R.n.dot(u)) * length < config.max_turn_m) return false;
  const auto span = [&](const PlaneObservation& o) { return std::minmax({u.dot(o.p0_R), u.dot(o.p1_R)}); };
  const auto [a0, a1] = span(wall);
  const auto [b0, b1] = span(longer);
  return std::min(a1, b1) - std::max(a0, b0) > 0.5 * (a1 - a0);
}

void drop_mixtures(std::vector<PlaneObservation>& walls, const PlaneDetectorConfig& config) {
  std::vector<PlaneObservation> kept;
  for (const PlaneObservation& wall : walls)
    if (std::none_of(walls.begin(), walls.end(), [&](const auto& other) { return runs_through(wall, other, config); }))
      kept.push_back(wall);
  walls = std::move(kept);
}

}  // namespace

std::vector<PlaneObservation> detect_planes(const DeskewedScan& scan, const PlaneDetectorConfig& config) {
  const std::vector<Facing> facing = classify_returns(scan, config);
  const std::vector<RingSegment> segments = ring_segments(scan, facing, config);
  std::vector<PlaneObservation> planes;
  for (const Wall& wall : WallGrower(scan, segments, config).grow_all())
    if (std::optional<PlaneObservation> patch = observe_wall(scan, segments, wall, config)) {
      patch->vertical = true;
      planes.push_back(*patch);
    }
  drop_mixtures(planes, config);
  for (const PlaneObservation& patch : horizontal_planes(scan, facing, config)) planes.push_back(patch);
  std::stable_sort(planes.begin(), planes.end(), [](const PlaneObservation& a, const PlaneObservation& b) {
    return std::make_tuple(-a.points, a.centroid_R.x(), a.centroid_R.y()) <
           std::make_tuple(-b.points, b.centroid_R.x(), b.centroid_R.y());
  });
  return planes;
}

}  // namespace plumbline::slam
