// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/ray_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bim/geometry/interval.h"

namespace plumbline::slam {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Bounds are relaxed by this, so that no rounding loses a face.
constexpr double slack = 1e-6;
constexpr double far_m = 40.0;  // beyond the range of a beam of a scan
// A list stops growing here; it is then complete up to the face that came last.
constexpr std::size_t longest_list = 20;
constexpr int block_cells = 8;
// Rays may pass over lower faces: they end no list.
constexpr double high_wall_m = 2.0;

Eigen::Vector2d direction_at(double pseudo) {
  const double p = pseudo - 4.0 * std::floor(pseudo / 4.0);
  const double x = p < 2.0 ? 1.0 - p : p - 3.0;
  const double y = p < 1.0 ? p : p < 3.0 ? 2.0 - p : p - 4.0;
  return Eigen::Vector2d(x, y).normalized();
}

/// The directions between which the rays of each azimuth bin lie.
struct BinEdges {
  std::array<Eigen::Vector2d, RayCandidateTable::azimuth_bins_per_turn> left, right;

  BinEdges() {
    for (int k = 0; k < RayCandidateTable::azimuth_bins_per_turn; ++k) {
      const auto bin = static_cast<std::size_t>(k);
      left[bin] = direction_at((k - slack) / RayCandidateTable::azimuth_bins_per_quadrant);
      right[bin] = direction_at((k + 1 + slack) / RayCandidateTable::azimuth_bins_per_quadrant);
    }
  }
};

double distance_to(const PlanSegment& segment, const Eigen::Vector2d& p) {
  const double s = std::clamp(segment.e.dot(p - segment.a), 0.0, segment.length);
  return (segment.a + s * segment.e - p).norm();
}

using Corners = std::array<Eigen::Vector2d, 4>;

Corners corners_of(const Eigen::Vector2d& center, double size) {
  const double h = 0.5 * size + slack;
  return {center + Eigen::Vector2d(-h, -h), center + Eigen::Vector2d(h, -h), center + Eigen::Vector2d(-h, h),
          center + Eigen::Vector2d(h, h)};
}

/// Pseudo-angles of the rays from a cell to a face; low is at least -4, high less than low + 2.
Interval directions_to(const PlanSegment& segment, const Corners& corners) {
  const Eigen::Vector2d b = segment.a + segment.length * segment.e;
  const double reference = pseudo_angle(segment.a - corners[0]);
  double low = 0.0, high = 0.0;
  for (const Eigen::Vector2d& corner : corners)
    for (const Eigen::Vector2d& end : {segment.a, b}) {
      const double turn = pseudo_angle(end - corner) - reference;
      const double wrapped = turn > 2.0 ? turn - 4.0 : turn <= -2.0 ? turn + 4.0 : turn;
      low = std::min(low, wrapped);
      high = std::max(high, wrapped);
    }
  return {reference + low - slack, reference + high + slack};
}

/// What rays of one azimuth bin from one cell hit of a face.
struct Reach {
  double from = 0.0;     ///< none hits its plane before
  double by = infinity;  ///< all have hit it by then, where it is high and closed there
};

Reach reach_of(const PlanSegment& segment, const Corners& corners, const Eigen::Vector2d& left,
               const Eigen::Vector2d& right) {
  double low = infinity, high = -infinity, s0 = infinity, s1 = -infinity, nearest = infinity;
  const double along_left = left.dot(segment.n), along_right = right.dot(segment.n);
  // Between the two the component along the normal has its extremes at the ends, but for the normal itself.
  const bool normal_between = std::abs(left.dot(segment.e)) < 1e-9 || left.dot(segment.e) * right.dot(segment.e) <= 0.0;
  const double steepest = normal_between ? 1.0 : std::max(std::abs(along_left), std::abs(along_right));
  bool ahead = std::min(std::abs(along_left), std::abs(along_right)) > 1e-3 && along_left * along_right > 0.0;
  bool one_side = true;
  const double side = (segment.a - corners[0]).dot(segment.n);
  for (const Eigen::Vector2d& corner : corners) {
    const double across = (segment.a - corner).dot(segment.n);
    one_side = one_side && across * side > 0.0;
    nearest = std::min(nearest, std::abs(across));
    ahead = ahead && across * along_left > 0.0;
    if (!ahead) continue;
    for (const Eigen::Vector2d& direction : {left, right}) {
      const double t = across / direction.dot(segment.n);
      const double s = (corner + t * direction - segment.a).dot(segment.e);
      low = std::min(low, t);
      high = std::max(high, t);
      s0 = std::min(s0, s);
      s1 = std::max(s1, s);
    }
  }
  Reach reach;
  if (one_side) reach.from = nearest / steepest;
  const bool covers = ahead && s0 > slack && s1 < segment.length - slack && segment.z1 - segment.z0 >= high_wall_m;
  const bool open = std::any_of(segment.holes.begin(), segment.holes.end(),
                                [&](const bim::FaceHole& hole) { return hole.s0 < s1 && hole.s1 > s0; });
  if (covers && !open) reach.by = high;
  return reach;
}

}  // namespace

/// The list of one cell and range of directions in the making.
struct RayCandidateTable::Bin {
  std::vector<Entry> entries;
  double complete = far_m;
};

RayCandidateTable::RayCandidateTable(const std::vector<PlanSegment>& segments, const GridFrame& frame) {
  if (frame.size() > most_cells) return;
  first_.resize(frame.size() * azimuth_bins_per_turn);
  std::vector<Entry> by_distance(segments.size());
  std::vector<Bin> bins(azimuth_bins_per_turn);
  const double block = block_cells * frame.cell;
  for (int y = 0; y < frame.ny; y += block_cells)
    for (int x = 0; x < frame.nx; x += block_cells) {
      const Eigen::Vector2d center =
          frame.origin + frame.cell * Eigen::Vector2d(x, y) + 0.5 * Eigen::Vector2d(block, block);
      for (std::size_t i = 0; i < segments.size(); ++i)
        by_distance[i] = {static_cast<int>(i),
                          static_cast<float>(distance_to(segments[i], center) - 0.71 * block - 10.0 * slack)};
      std::stable_sort(by_distance.begin(), by_distance.end(),
                       [](const Entry& a, const Entry& b) { return a.from < b.from; });
      for (int v = y; v < std::min(y + block_cells, frame.ny); ++v)
        for (int u = x; u < std::min(x + block_cells, frame.nx); ++u) {
          const int cell = v * frame.nx + u;
          fill_cell(segments, frame.center(u, v), frame.cell, by_distance, bins);
          for (int k = 0; k < azimuth_bins_per_turn; ++k) {
            const std::vector<Entry>& list = bins[static_cast<std::size_t>(k)].entries;
            first_[static_cast<std::size_t>(cell * azimuth_bins_per_turn + k)] = static_cast<int>(entries_.size());
            entries_.insert(entries_.end(), list.begin(), list.end());
          }
        }
    }
}

double RayCandidateTable::clearance(int cell) const {
  if (first_.empty()) return 0.0;
  float least = std::numeric_limits<float>::infinity();
  for (int bin = 0; bin < azimuth_bins_per_turn; ++bin) least = std::min(least, list(cell, bin)->from);
  return static_cast<double>(least);
}

void RayCandidateTable::fill_cell(const std::vector<PlanSegment>& segments, const Eigen::Vector2d& center, double cell,
                                  const std::vector<Entry>& by_distance, std::vector<Bin>& bins) {
  static const BinEdges edges;
  for (Bin& bin : bins) {
    bin.entries.clear();
    bin.complete = far_m;
  }
  const Corners corners = corners_of(center, cell);
  double open_to = far_m;
  for (const Entry& next : by_distance) {
    if (next.from > open_to) break;
    const PlanSegment& segment = segments[static_cast<std::size_t>(next.segment)];
    const double least = distance_to(segment, center) - 0.71 * cell - 10.0 * slack;
    const Interval range = least <= 0.0 ? Interval{0.0, 4.0 - slack} : directions_to(segment, corners);
    bool lessens = false;  // open_to
    const int last = static_cast<int>(std::floor(range.high * azimuth_bins_per_quadrant));
    for (int i = static_cast<int>(std::floor(range.low * azimuth_bins_per_quadrant)); i <= last; ++i) {
      const int k = (i + azimuth_bins_per_turn) % azimuth_bins_per_turn;
      Bin& bin = bins[static_cast<std::size_t>(k)];
      if (least > bin.complete || next.from > bin.complete) continue;
      const Reach reach =
          reach_of(segment, corners, edges.left[static_cast<std::size_t>(k)], edges.right[static_cast<std::size_t>(k)]);
      const double from = std::max({0.0, least, reach.from * (1.0 - slack) - slack});
      if (from > bin.complete) continue;
      bin.entries.push_back({next.segment, static_cast<float>(from - 10.0 * slack)});
      lessens = lessens || bin.complete >= open_to;
      bin.complete = std::min(bin.complete, reach.by);
      if (bin.entries.size() >= longest_list) bin.complete = std::min(bin.complete, static_cast<double>(next.from));
    }
    if (!lessens) continue;
    open_to = 0.0;
    for (const Bin& bin : bins) open_to = std::max(open_to, bin.complete);
  }
  for (Bin& bin : bins) {
    std::erase_if(bin.entries, [&](const Entry& entry) { return entry.from > bin.complete; });
    for (auto entry = bin.entries.begin(); entry != bin.entries.end(); ++entry)
      std::rotate(std::upper_bound(bin.entries.begin(), entry, *entry,
                                   [](const Entry& a, const Entry& b) { return a.from < b.from; }),
                  entry, entry + 1);
    bin.entries.push_back({-1, static_cast<float>(bin.complete - 10.0 * slack)});
  }
}

}  // namespace plumbline::slam
