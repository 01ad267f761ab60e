// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/segments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace plumbline::slam {

namespace {

constexpr std::size_t step_candidates = 16;  ///< positions in a stretch where a step is searched for

/// Line in the plane by least squares: centre, unit direction and rms across.
struct Line2 {
  Eigen::Vector2d centre;
  Eigen::Vector2d direction;
  double rms = 0.0;
};

/// Prefix sums of x, y, xx, xy, yy along a ring, so that any stretch is fitted in constant time.
class LineSums {
 public:
  explicit LineSums(const std::vector<Eigen::Vector3d>& points) : sums_(points.size() + 1) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d& p = points[i];
      const Sums& s = sums_[i];
      sums_[i + 1] = {s.x + p.x(), s.y + p.y(), s.xx + p.x() * p.x(), s.xy + p.x() * p.y(), s.yy + p.y() * p.y()};
    }
  }

  /// Of points [begin, end).
  [[nodiscard]] Line2 fit(std::size_t begin, std::size_t end) const {
    const Spread s = spread(begin, end);
    // Of two equal forms of the long axis the one that does not cancel.
    Eigen::Vector2d axis =
        s.half >= 0.0 ? Eigen::Vector2d(s.root + s.half, s.xy) : Eigen::Vector2d(s.xy, s.root - s.half);
    const double norm = axis.norm();
    axis = norm > 0.0 ? Eigen::Vector2d(axis / norm) : Eigen::Vector2d::UnitX();
    return {{s.x, s.y}, axis, s.rms()};
  }

  /// The fit's rms alone.
  [[nodiscard]] double rms(std::size_t begin, std::size_t end) const { return spread(begin, end).rms(); }

 private:
  struct Sums {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  };
  /// Mean and second moments about it, in the form of their eigenvalues: mean +- root.
  struct Spread {
    double x, y, xy, half, root, mean;
    [[nodiscard]] double rms() const { return std::sqrt(std::max(0.0, mean - root)); }
  };

  [[nodiscard]] Spread spread(std::size_t begin, std::size_t end) const {
    const Sums &a = sums_[begin], &b = sums_[end];
    const auto n = static_cast<double>(end - begin);
    const double x = (b.x - a.x) / n, y = (b.y - a.y) / n;
    const double xx = (b.xx - a.xx) / n - x * x;
    const double xy = (b.xy - a.xy) / n - x * y;
    const double yy = (b.yy - a.yy) / n - y * y;
    const double half = 0.5 * (xx - yy);
    return {x, y, xy, half, std::sqrt(half * half + xy * xy), 0.5 * (xx + yy)};
  }

  std::vector<Sums> sums_;
};

/// Cuts one ring.
class RingCutter {
 public:
  RingCutter(const DeskewedScan& scan, int ring, std::vector<std::uint32_t> points, const PlaneDetectorConfig& config)
      : scan_(scan),
        ring_(ring),
        points_(std::move(points)),
        config_(config),
        points_R_(points_of(scan, points_)),
        sums_(points_R_) {}

  void cut(std::vector<RingSegment>& out) const {
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= points_.size(); ++i) {
      if (i < points_.size() && !jumps(i)) continue;
      split(begin, i, out);
      begin = i;
    }
  }

 private:
  [[nodiscard]] Eigen::Vector2d xy(std::size_t i) const { return points_R_[i].head<2>(); }

  [[nodiscard]] bool jumps(std::size_t i) const {
    const double gap = config_.gap_m + config_.gap_per_m * scan_.range_m[points_[i]];
    return (xy(i) - xy(i - 1)).squaredNorm() > gap * gap;
  }

  void split(std::size_t begin, std::size_t end, std::vector<RingSegment>& out) const {
    if (end - begin < static_cast<std::size_t>(config_.segment_points)) return;
    const Line2 line = sums_.fit(begin, end);
    const std::size_t middle = line.rms > config_.segment_rms_m ? corner(begin, end) : step(begin, end, line);
    if (middle == end) {
      keep(begin, end, line, out);
      return;
    }
    split(begin, middle, out);
    split(middle, end, out);
  }

  /// Where two lines explain the stretch so much better than one that noise cannot be the cause; `end` where nowhere. A
  /// leaf set back in its wall, or a pillar before it, gives a line that runs along neither.
  [[nodiscard]] std::size_t step(std::size_t begin, std::size_t end, const Line2& line) const {
    constexpr std::size_t least = 2;  // what a cut corner left over may be less than a segment
    const std::size_t stride = std::max<std::size_t>(1, (end - begin) / step_candidates);
    const auto square_sum = [&](std::size_t from, std::size_t to) {
      const double rms = sums_.rms(from, to);
      return rms * rms * static_cast<double>(to - from);
    };
    std::size_t best = end;
    double apart = std::numeric_limits<double>::infinity();
    const auto look = [&](std::size_t first, std::size_t last, std::size_t by) {
      for (std::size_t i = first; i <= last; i += by) {
        const double sum = square_sum(begin, i) + square_sum(i, end);
        if (sum >= apart) continue;
        apart = sum;
        best = i;
      }
    };
    look(begin + least, end - least, stride);
    look(std::max(begin + least, best - (stride - 1)), std::min(end - least, best + (stride - 1)), 1);
    const auto n = static_cast<double>(end - begin);
    const double variance = std::max(config_.step_sigma_m * config_.step_sigma_m, apart / n);
    return line.rms * line.rms * n - apart > config_.step_chi2 * variance ? best : end;
  }

  /// Point farthest from the chord (ties: the first), never an end.
  [[nodiscard]] std::size_t corner(std::size_t begin, std::size_t end) const {
    const Eigen::Vector2d a = (xy(begin) + xy(begin + 1) + xy(begin + 2)) / 3.0;
    const Eigen::Vector2d b = (xy(end - 1) + xy(end - 2) + xy(end - 3)) / 3.0;
    const Eigen::Vector2d across(a.y() - b.y(), b.x() - a.x());
    std::size_t best = begin + (end - begin) / 2;
    double most = -1.0;
    for (std::size_t i = begin + 2; i + 2 < end; ++i) {
      const double distance = std::abs(across.dot(xy(i) - a));
      if (distance > most) {
        most = distance;
        best = i;
      }
    }
    return best;
  }

  void keep(std::size_t begin, std::size_t end, const Line2& line, std::vector<RingSegment>& out) const {
    const auto on_line = [&](std::size_t i) -> Eigen::Vector3d {
      const Eigen::Vector3d& p = points_R_[i];
      const Eigen::Vector2d q = line.centre + line.direction * line.direction.dot(p.head<2>() - line.centre);
      return {q.x(), q.y(), p.z()};
    };
    RingSegment segment;
    segment.ring = ring_;
    segment.p0_R = on_line(begin);
    segment.p1_R = on_line(end - 1);
    segment.direction = line.direction;
    if ((segment.p1_R - segment.p0_R).head<2>().norm() < config_.segment_length_m) return;
    segment.points.assign(points_.begin() + static_cast<std::ptrdiff_t>(begin),
                          points_.begin() + static_cast<std::ptrdiff_t>(end));
    MomentSums sums;
    for (std::size_t i = begin; i < end; ++i) sums.add(points_R_[i]);
    segment.moments = sums.moments();
    out.push_back(std::move(segment));
  }

  const DeskewedScan& scan_;
  int ring_;
  std::vector<std::uint32_t> points_;
  const PlaneDetectorConfig& config_;
  std::vector<Eigen::Vector3d> points_R_;
  LineSums sums_;
};

}  // namespace

std::vector<Facing> classify_returns(const DeskewedScan& scan, const PlaneDetectorConfig& config) {
  const auto rings = static_cast<std::size_t>(scan.rings);
  std::vector<Facing> facing(scan.range_m.size(), Facing::none);
  std::vector<double> reach(rings);  // horizontal distance from the sensor
  std::vector<std::uint8_t> flat(rings), steep(rings);
  for (std::size_t first = 0; first + rings <= facing.size(); first += rings) {
    for (std::size_t r = 0; r < rings; ++r) {
      const double range = scan.range_m[first + r];
      if (range < config.min_range_m || range > config.max_range_m) continue;
      facing[first + r] = Facing::upright;
      reach[r] = (scan.point_R[first + r] - scan.X_RL.t).head<2>().norm();
    }
    // Links to the ring above; a steep one wins, so that a depth jump over a wall does not take the wall's edge away.
    std::fill(flat.begin(), flat.end(), std::uint8_t{0});
    std::fill(steep.begin(), steep.end(), std::uint8_t{0});
    for (std::size_t r = 0; r + 1 < rings; ++r) {
      if (facing[first + r] == Facing::none || facing[first + r + 1] == Facing::none) continue;
      const double rise = std::abs(scan.point_R[first + r + 1].z() - scan.point_R[first + r].z());
      const double run = std::abs(reach[r + 1] - reach[r]);
      if (rise <= config.flat_slope * run) flat[r] = flat[r + 1] = 1;
      if (rise >= run) steep[r] = steep[r + 1] = 1;
    }
    for (std::size_t r = 0; r < rings; ++r)
      if (flat[r] != 0 && steep[r] == 0) facing[first + r] = Facing::flat;
  }
  return facing;
}

std::vector<RingSegment> ring_segments(const DeskewedScan& scan, const std::vector<Facing>& facing,
                                       const PlaneDetectorConfig& config) {
  const auto rings = static_cast<std::size_t>(scan.rings);
  std::vector<std::vector<std::uint32_t>> points(rings);
  for (std::vector<std::uint32_t>& ring : points) ring.reserve(static_cast<std::size_t>(scan.columns));
  for (std::size_t i = 0, ring = 0; i < facing.size(); ++i, ring = ring + 1 == rings ? 0 : ring + 1)
    if (facing[i] == Facing::upright) points[ring].push_back(static_cast<std::uint32_t>(i));
  std::vector<RingSegment> segments;
  for (std::size_t ring = 0; ring < rings; ++ring)
    RingCutter(scan, static_cast<int>(ring), std::move(points[ring]), config).cut(segments);
  return segments;
}

}  // namespace plumbline::slam
