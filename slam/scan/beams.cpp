// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/beams.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace plumbline::slam {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// A beam's number counted upwards, with the share of the step to the next one.
double beam_at(Beams beams, double elevation_deg) {
  constexpr double middle_deg = -8.83, upper_step_deg = 1.0 / 3.0;  // HDL-64E: two blocks of 32 lasers
  switch (beams) {
    case Beams::vlp16:
      return (elevation_deg + 15.0) / 2.0;
    case Beams::hdl32:
      return (elevation_deg + 92.0 / 3.0) * 3.0 / 4.0;
    case Beams::hdl64:
      return elevation_deg >= middle_deg ? 63.0 - (2.0 - elevation_deg) / upper_step_deg
                                         : 31.0 - 2.0 * (middle_deg - elevation_deg);
    default:
      return -1.0;
  }
}

/// Mean distance to the nearest beam in steps: 1/4 of elevations that are no beams.
double mean_distance(Beams beams, const std::vector<double>& elevations) {
  double sum = 0.0;
  for (const double elevation : elevations) {
    const double beam = beam_at(beams, elevation / degree);
    sum += std::abs(beam - std::round(beam));
  }
  return sum / static_cast<double>(elevations.size());
}

/// Columns that a ring's returns take, by their share of a turn: in order, and each its own.
std::vector<int> columns_of_ring(const std::vector<double>& turns, int columns) {
  std::vector<int> result;
  for (const double turn : turns) {
    const int own = std::min(static_cast<int>(turn * columns), columns - 1);
    result.push_back(result.empty() ? own : std::max(own, result.back() + 1));
  }
  int last = columns;
  for (auto column = result.rbegin(); column != result.rend(); ++column) last = *column = std::min(*column, last - 1);
  return result;
}

}  // namespace

int rings_of(Beams beams) {
  switch (beams) {
    case Beams::vlp16:
      return 16;
    case Beams::hdl32:
      return 32;
    case Beams::hdl64:
      return 64;
    default:
      return 0;
  }
}

int ring_of(Beams beams, double elevation_rad) {
  const double beam = std::floor(beam_at(beams, elevation_rad / degree) + 0.5);
  return beam >= 0.0 && beam < rings_of(beams) ? static_cast<int>(beam) : -1;
}

Beams beams_of(const std::vector<double>& elevations) {
  constexpr std::size_t fewest = 1000;
  if (elevations.size() < fewest) return Beams::none;
  // A twentieth may lie anywhere: mounts are tilted, and motion that was undone moves near returns most.
  const auto hold = [&](Beams beams) {
    const auto held =
        std::count_if(elevations.begin(), elevations.end(), [&](double e) { return ring_of(beams, e) >= 0; });
    return 20 * static_cast<std::size_t>(held) >= 19 * elevations.size();
  };
  constexpr double most_apart = 0.2;
  if (hold(Beams::vlp16) && mean_distance(Beams::vlp16, elevations) < most_apart) return Beams::vlp16;
  if (hold(Beams::hdl32) && mean_distance(Beams::hdl32, elevations) < most_apart) return Beams::hdl32;
  // Lasers of an HDL-64E stand too close, and too far from where they should, to be told apart.
  return hold(Beams::hdl64) && !hold(Beams::vlp16) ? Beams::hdl64 : Beams::none;
}

Beams BeamsOfRecording::known(const std::vector<double>& elevations) {
  if (beams_ != Beams::automatic) return beams_;
  const Beams seen = beams_of(elevations);
  if (seen != Beams::none) beams_ = seen;
  return seen;
}

Beams BeamsOfRecording::of(const Scan& scan) {
  if (has_rings(scan)) return Beams::none;
  std::vector<double> elevations;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0 && scan.point_L[i].allFinite()) elevations.push_back(elevation(scan.point_L[i]));
  return known(elevations);
}

std::optional<DeskewedScan> BeamsOfRecording::in_rings(const DeskewedScan& scan) {
  if (has_rings(scan)) return std::nullopt;
  struct Return {
    std::size_t from;
    double turn;  ///< from behind, clockwise
  };
  std::vector<std::size_t> returns;
  std::vector<double> elevations;
  for (std::size_t i = 0; i < scan.elevation.size(); ++i) {
    if (!(scan.range_m[i] > 0.0)) continue;
    returns.push_back(i);
    elevations.push_back(scan.elevation[i]);
  }
  const Beams beams = known(elevations);
  if (beams == Beams::none || beams == Beams::automatic) return std::nullopt;
  std::vector<std::vector<Return>> rings(static_cast<std::size_t>(rings_of(beams)));
  const Pose X_LR = scan.X_RL.inverse();
  for (std::size_t k = 0; k < returns.size(); ++k) {
    const int ring = ring_of(beams, elevations[k]);
    if (ring < (beams == Beams::hdl64 ? lowest_of_64_ : 0)) continue;
    const Eigen::Vector3d p_L = X_LR * scan.point_R[returns[k]];
    const double turn = 0.5 - std::atan2(p_L.y(), p_L.x()) / (2.0 * std::numbers::pi);
    rings[static_cast<std::size_t>(ring)].push_back({returns[k], turn});
  }
  DeskewedScan out = scan;
  out.rings = rings_of(beams);
  out.columns = 0;
  for (const std::vector<Return>& ring : rings) out.columns = std::max(out.columns, static_cast<int>(ring.size()));
  const std::size_t size = rings.size() * static_cast<std::size_t>(out.columns);
  out.elevation.clear();
  out.range_m.assign(size, 0.0);
  out.point_R.assign(size, Eigen::Vector3d::Zero());
  if (!scan.time_s.empty()) out.time_s.assign(size, 0.0F);
  for (std::size_t r = 0; r < rings.size(); ++r) {
    std::stable_sort(rings[r].begin(), rings[r].end(),
                     [](const Return& a, const Return& b) { return a.turn < b.turn; });
    std::vector<double> turns;
    for (const Return& one : rings[r]) turns.push_back(one.turn);
    const std::vector<int> columns = columns_of_ring(turns, out.columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::size_t to = static_cast<std::size_t>(columns[k]) * rings.size() + r, from = rings[r][k].from;
      out.range_m[to] = scan.range_m[from];
      out.point_R[to] = scan.point_R[from];
      if (!scan.time_s.empty()) out.time_s[to] = scan.time_s[from];
    }
  }
  return out;
}

}  // namespace plumbline::slam
