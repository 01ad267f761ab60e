// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/cloud_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "bim/errors.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::slam {

namespace {

constexpr double column_azimuth =
    0.3 * std::numbers::pi / 180.0;  ///< lasers of a VLP-16 that fire together lie this close

double elevation_deg(const CloudPoint& point) {
  return std::atan2(point.p_L.z(), point.p_L.head<2>().norm()) * (180.0 / std::numbers::pi);
}

/// Rings of a VLP-16 by elevation, for clouds that do not name them. False, and nothing is changed, unless nearly all
/// points lie where its lasers point: by chance three in ten do.
bool find_rings(std::vector<CloudPoint>& points) {
  constexpr double off_deg = 0.3, origin_m = 0.0112;  // of an elevation; of a laser's origin above the sensor's
  constexpr double least_share = 0.8;
  std::size_t valid = 0, on_ring = 0;
  std::vector<int> rings(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid) continue;
    ++valid;
    const double place = (elevation_deg(points[i]) + 15.0) / 2.0;
    const double nearest = std::clamp(std::round(place), 0.0, vlp16::rings - 1.0);
    const double slack_deg = off_deg + origin_m / points[i].p_L.norm() * (180.0 / std::numbers::pi);
    if (2.0 * std::abs(place - nearest) <= slack_deg) ++on_ring;
    rings[i] = static_cast<int>(nearest);
  }
  if (static_cast<double>(on_ring) < least_share * static_cast<double>(valid)) return false;
  for (std::size_t i = 0; i < points.size(); ++i) points[i].ring = rings[i];
  return true;
}

/// Rings of any LiDAR whose lasers turn about one point, by elevation: raw returns then lie on narrow cones with gaps
/// between them. False, and nothing is changed, where they do not: other lasers, or a motion undone.
bool find_cones(std::vector<CloudPoint>& points) {
  // Assumed; cones of the LiDARs here are 0.33 to 2 degrees apart.
  constexpr double gap_deg = 0.05, most_stray = 0.02;        // between cones; share of returns on none
  constexpr std::size_t least_cones = 8, least_points = 20;  // points: of a cone, where a scan is no accident
  constexpr double narrow = 0.5;                             // width of a cone over the gaps beside it
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].valid) order.emplace_back(elevation_deg(points[i]), i);
  std::sort(order.begin(), order.end());
  struct Cone {
    std::size_t begin, end;
  };
  std::vector<Cone> cones;
  std::size_t stray = 0;
  for (std::size_t begin = 0, i = 1; i <= order.size(); ++i) {
    if (i < order.size() && order[i].first - order[i - 1].first < gap_deg) continue;
    if (i - begin >= least_points)
      cones.push_back({begin, i});
    else
      stray += i - begin;
    begin = i;
  }
  if (cones.size() < least_cones || cones.size() > most_cloud_rings) return false;
  if (static_cast<double>(stray) > most_stray * static_cast<double>(order.size())) return false;
  const auto width = [&](const Cone& cone) { return order[cone.end - 1].first - order[cone.begin].first; };
  for (std::size_t k = 1; k < cones.size(); ++k) {
    const double gap = order[cones[k].begin].first - order[cones[k - 1].end - 1].first;
    if (std::max(width(cones[k - 1]), width(cones[k])) > narrow * gap) return false;
  }
  for (std::size_t k = 0; k < cones.size(); ++k)
    for (std::size_t i = cones[k].begin; i < cones[k].end; ++i) points[order[i].second].ring = static_cast<int>(k);
  return true;
}

int ring_count(const std::vector<CloudPoint>& points) {
  int highest = 0;
  for (const CloudPoint& point : points) highest = std::max(highest, point.ring);
  for (const int rings : {16, 32, 64})
    if (highest < rings) return rings;
  return most_cloud_rings;
}

/// Some drivers count from 1: where no point is of ring 0 and the last one is as many as a LiDAR has. Of 128 rings the
/// last one's number says so, even where the first one sees nothing.
void count_from_zero(std::vector<CloudPoint>& points) {
  int lowest = most_cloud_rings, highest = 0;
  for (const CloudPoint& point : points) {
    if (point.ring < 0) continue;
    lowest = std::min(lowest, point.ring);
    highest = std::max(highest, point.ring);
  }
  const bool from_one =
      highest == most_cloud_rings || (lowest == 1 && (highest == 16 || highest == 32 || highest == 64));
  for (CloudPoint& point : points) {
    if (from_one && point.ring > 0) --point.ring;
    if (point.ring >= most_cloud_rings) point.ring = -1;
  }
}

/// Elevation of a ring that has returns.
struct RingElevation {
  int ring = 0;
  double mean_deg = 0.0;
};

/// By ring.
std::vector<RingElevation> elevations_of(const std::vector<CloudPoint>& points, int rings) {
  std::vector<double> sum(static_cast<std::size_t>(rings), 0.0), count(sum);
  for (const CloudPoint& point : points) {
    if (point.ring < 0 || !point.valid) continue;
    sum[static_cast<std::size_t>(point.ring)] += elevation_deg(point);
    count[static_cast<std::size_t>(point.ring)] += 1.0;
  }
  std::vector<RingElevation> seen;
  for (int r = 0; r < rings; ++r)
    if (const auto i = static_cast<std::size_t>(r); count[i] > 0.0) seen.push_back({r, sum[i] / count[i]});
  return seen;
}

/// Where each ring goes.
using RingPlaces = std::array<int, most_cloud_rings>;

/// Nearly all rings rise with their places. Motion may exchange neighbours, of a scan that was deskewed.
bool is_rising(const std::vector<RingElevation>& seen, const RingPlaces& places) {
  constexpr double most_falling = 0.1;
  const auto place = [&](std::size_t i) { return places[static_cast<std::size_t>(seen[i].ring)]; };
  double falling = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t k = i + 1; k < seen.size(); ++k, pairs += 1.0)
      if ((place(i) < place(k)) != (seen[i].mean_deg <= seen[k].mean_deg)) falling += 1.0;
  return falling <= most_falling * pairs;
}

/// Ring 0 is the lowest here; some drivers count from the top, or as a VLP-16's lasers fire.
void order_rings(std::vector<CloudPoint>& points, int rings) {
  const std::vector<RingElevation> seen = elevations_of(points, rings);
  RingPlaces as_named{}, from_top{}, as_fired{};
  for (int r = 0; r < rings; ++r) {
    const auto i = static_cast<std::size_t>(r);
    as_named[i] = r;
    from_top[i] = rings - 1 - r;
    as_fired[i] = rings == vlp16::rings ? vlp16::ring_of_laser(r) : r;
  }
  if (is_rising(seen, as_named)) return;
  RingPlaces sorted = as_named;
  std::vector<RingElevation> rising = seen;
  std::stable_sort(rising.begin(), rising.end(),
                   [](const RingElevation& a, const RingElevation& b) { return a.mean_deg < b.mean_deg; });
  for (std::size_t i = 0; i < seen.size(); ++i) sorted[static_cast<std::size_t>(rising[i].ring)] = seen[i].ring;
  const RingPlaces& places = is_rising(seen, from_top) ? from_top : is_rising(seen, as_fired) ? as_fired : sorted;
  for (CloudPoint& point : points)
    if (point.ring >= 0) point.ring = places[static_cast<std::size_t>(point.ring)];
}

/// Firing of each point from its time, for a VLP-16 with a time for every laser. False where times do not fit the
/// firings.
bool columns_by_time(std::vector<CloudPoint>& points) {
  std::array<Nanoseconds, vlp16::rings> laser_ns{};
  for (int k = 0; k < vlp16::rings; ++k)
    laser_ns[static_cast<std::size_t>(vlp16::ring_of_laser(k))] = k * vlp16::laser_period_ns;
  const auto firing_ns = [&](const CloudPoint& point) {
    return point.time - laser_ns[static_cast<std::size_t>(point.ring)];
  };
  Nanoseconds first = std::numeric_limits<Nanoseconds>::max();
  for (const CloudPoint& point : points)
    if (point.ring >= 0) first = std::min(first, firing_ns(point));
  for (CloudPoint& point : points) {
    if (point.ring < 0) continue;
    const Nanoseconds t = firing_ns(point) - first;
    const Nanoseconds column = (t + vlp16::firing_period_ns / 2) / vlp16::firing_period_ns;
    if (std::abs(t - column * vlp16::firing_period_ns) > vlp16::laser_period_ns / 2) return false;
    point.column = static_cast<int>(column);
  }
  return true;
}

/// Columns in the order of the points, whose place in a firing is place[ring]: a new one where the place does not
/// increase or the azimuth has gone on by more than azimuth_max. Returns their number.
int columns_in_order(std::vector<CloudPoint>& points, const std::array<int, most_cloud_rings>& place,
                     double azimuth_max) {
  int column = -1, last_place = 0;
  double azimuth = 0.0;
  for (CloudPoint& point : points) {
    point.column = std::max(column, 0);
    if (!point.valid || point.ring < 0) continue;
    const double here = std::atan2(point.p_L.y(), point.p_L.x());
    const int here_place = place[static_cast<std::size_t>(point.ring)];
    if (column < 0 || here_place <= last_place || std::abs(wrap_angle(here - azimuth)) > azimuth_max) {
      ++column;
      azimuth = here;
    }
    last_place = here_place;
    point.column = column;
  }
  return column + 1;
}

/// Points of a firing come by ring or, of a VLP-16, as its lasers fire: whichever gives fewer columns.
void columns_by_azimuth(std::vector<CloudPoint>& points, int rings) {
  std::array<int, most_cloud_rings> by_ring{}, by_laser{};
  for (int r = 0; r < most_cloud_rings; ++r)
    by_ring[static_cast<std::size_t>(r)] = by_laser[static_cast<std::size_t>(r)] = r;
  for (int k = 0; k < vlp16::rings && rings == vlp16::rings; ++k)
    by_laser[static_cast<std::size_t>(vlp16::ring_of_laser(k))] = k;
  // Other sensors' lasers may point degrees apart.
  const double azimuth_max = rings == vlp16::rings ? column_azimuth : std::numbers::pi;
  const int columns_by_laser = columns_in_order(points, by_laser, azimuth_max);
  if (columns_by_laser >= columns_in_order(points, by_ring, azimuth_max)) return;
  static_cast<void>(columns_in_order(points, by_laser, azimuth_max));
}

int column_count(const std::vector<CloudPoint>& points) {
  int last = 0;
  for (const CloudPoint& point : points) last = std::max(last, point.column);
  return last + 1;
}

/// Clockwise from straight behind, in turns.
double turn_of(const CloudPoint& point) {
  return 0.5 - std::atan2(point.p_L.y(), point.p_L.x()) / (2.0 * std::numbers::pi);
}

/// The sector in which the points lie: where it begins and how wide it is, in turns. The whole turn where no quarter of
/// it is free of points.
std::pair<double, double> covered_sector(const std::vector<CloudPoint>& points) {
  constexpr int bins = 360, least_free = bins / 4;
  std::array<bool, bins> seen{};
  for (const CloudPoint& point : points)
    if (point.ring >= 0 && point.valid)
      seen[static_cast<std::size_t>(std::clamp(static_cast<int>(turn_of(point) * bins), 0, bins - 1))] = true;
  int free = 0, widest = 0, end = 0;
  for (int i = 0; i < 2 * bins; ++i) {
    free = seen[static_cast<std::size_t>(i % bins)] ? 0 : free + 1;
    if (free <= widest || free > bins) continue;
    widest = free;
    end = i + 1;
  }
  if (widest < least_free || widest >= bins) return {0.0, 1.0};
  return {static_cast<double>(end % bins) / bins, static_cast<double>(bins - widest) / bins};
}

/// Columns by azimuth alone, for points that come ring by ring or in no order: as many as the fullest ring has points,
/// and half as many again for those that fall into a column twice, which move to the next free one or are dropped.
void columns_by_angle(std::vector<CloudPoint>& points, int rings) {
  std::vector<int> filled(static_cast<std::size_t>(rings), 0);
  for (const CloudPoint& point : points)
    if (point.ring >= 0 && point.valid) ++filled[static_cast<std::size_t>(point.ring)];
  const int fullest = *std::max_element(filled.begin(), filled.end());
  const int columns = fullest + fullest / 2 + 1;
  if (static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rings) > most_cloud_points)
    throw InputError({}, "point cloud with most of its points on one ring");
  const auto [from, width] = covered_sector(points);
  std::vector<bool> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rings), false);
  for (CloudPoint& point : points) {
    if (point.ring < 0 || !point.valid) {
      point.ring = -1;
      continue;
    }
    const double turn = turn_of(point), place = (turn < from ? turn + 1.0 - from : turn - from) / width;
    const int column = std::clamp(static_cast<int>(place * columns), 0, columns - 1);
    const auto slot = [&](int c) {
      return static_cast<std::size_t>(c % columns) * static_cast<std::size_t>(rings) +
             static_cast<std::size_t>(point.ring);
    };
    constexpr int reach = 3;
    int step = 0;
    while (step < reach && taken[slot(column + step)]) ++step;
    point.column = (column + step) % columns;
    if (step == reach) point.ring = -1;
    if (step < reach) taken[slot(column + step)] = true;
  }
}

/// Gives every point its column; returns how many there are.
int find_columns(std::vector<CloudPoint>& points, const CloudLines& lines, int rings) {
  const auto count = static_cast<std::uint32_t>(rings);
  const bool row_a_firing = lines.width == count && lines.height > 1;
  const bool row_a_ring = !row_a_firing && lines.height == count && lines.width > 1;
  for (std::size_t i = 0; i < points.size() && (row_a_firing || row_a_ring); ++i)
    points[i].column = static_cast<int>(row_a_firing ? i / lines.width : i % lines.width);
  if (row_a_firing || row_a_ring) return column_count(points);
  if (lines.timed && rings == vlp16::rings && columns_by_time(points)) return column_count(points);
  columns_by_azimuth(points, rings);
  constexpr std::size_t emptiest = 4;  // slots a point
  const auto columns = static_cast<std::size_t>(column_count(points));
  if (columns * static_cast<std::size_t>(rings) > emptiest * std::max(points.size(), columns))
    columns_by_angle(points, rings);
  return column_count(points);
}

/// Rows or columns of an organised cloud as rings, where no field names them. False: it is not organised so.
bool rings_by_layout(std::vector<CloudPoint>& points, const CloudLines& lines) {
  const auto is_ring_count = [](std::uint32_t n) { return n == 16 || n == 32 || n == 64 || n == most_cloud_rings; };
  const bool row_a_firing = is_ring_count(lines.width) && lines.height > lines.width;
  if (!row_a_firing && !(is_ring_count(lines.height) && lines.width > 1)) return false;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].ring = static_cast<int>(row_a_firing ? i % lines.width : i / lines.width);
  return true;
}

/// A scan without order: one ring, a column a point.
int without_rings(std::vector<CloudPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].ring = 0;
    points[i].column = static_cast<int>(i);
  }
  return static_cast<int>(points.size());
}

/// One ring for all returns, though they lie on many cones: a converter without rings fills the field so.
bool is_one_ring_of_many(const std::vector<CloudPoint>& points) {
  constexpr double widest_cone_deg = 2.0;  // of one laser, with the motion that deskewing undoes
  std::vector<double> elevations;
  const CloudPoint* first = nullptr;
  for (const CloudPoint& point : points) {
    if (!point.valid) continue;
    if (first == nullptr) first = &point;
    if (point.ring != first->ring) return false;
    elevations.push_back(elevation_deg(point));
  }
  std::sort(elevations.begin(), elevations.end());
  const std::size_t end = elevations.size() / 20;  // strays
  return !elevations.empty() && elevations[elevations.size() - 1 - end] - elevations[end] > widest_cone_deg;
}

/// Rows of a solid-state LiDAR, or numbers that are none, of returns: a spinning LiDAR has 128 rings and fewer.
bool is_beyond_rings(const std::vector<CloudPoint>& points) {
  int lowest = most_cloud_rings, highest = 0;
  for (const CloudPoint& point : points) {
    if (!point.valid) continue;
    lowest = std::min(lowest, point.ring);
    highest = std::max(highest, point.ring);
  }
  return lowest < 0 || highest > most_cloud_rings || (highest == most_cloud_rings && lowest == 0);
}

}  // namespace

CloudOrder order_points(std::vector<CloudPoint>& points, const CloudLines& lines) {
  const bool left_out = lines.named_rings && (is_one_ring_of_many(points) || is_beyond_rings(points));
  for (CloudPoint& point : points)
    if (left_out) point.ring = -1;
  const bool named = lines.named_rings && !left_out;
  if (!named && !rings_by_layout(points, lines) && !find_rings(points) && !find_cones(points))
    return {1, without_rings(points), left_out};
  if (named) count_from_zero(points);
  const int rings = ring_count(points);
  order_rings(points, rings);
  return {rings, find_columns(points, lines, rings), left_out};
}

}  // namespace plumbline::slam
