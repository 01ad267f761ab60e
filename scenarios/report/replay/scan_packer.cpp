// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/scan_packer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "scenarios/report/replay/deflate.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_returns = 7296;  // of a scan: every fourth column of a VLP-16
constexpr double full_turn = 2.0 * std::numbers::pi;

std::uint16_t folded(int difference) {
  const std::uint32_t bits = static_cast<std::uint16_t>(difference);
  return static_cast<std::uint16_t>((bits << 1U) ^ ((bits & 0x8000U) != 0 ? 0xFFFFU : 0U));
}

/// Azimuth of the first column, as the mean over its returns.
double first_azimuth(const slam::Scan& scan, const ScanGrid& grid) {
  double sine = 0.0, cosine = 0.0;
  constexpr std::size_t sampled = 13;  // one return of so many, of every ring: it has no divisor of the rings
  for (std::size_t i = 0; i < scan.size(); i += sampled) {
    if (!(scan.range_m[i] > 0.0)) continue;
    const auto column = static_cast<double>(i / static_cast<std::size_t>(scan.rings));
    const std::size_t ring = i % static_cast<std::size_t>(scan.rings);
    const double seen = std::atan2(-scan.point_L[i].y(), scan.point_L[i].x());
    const double start = seen - grid.turn_rad / grid.every * column - grid.azimuth_rad[ring];
    sine += std::sin(start);
    cosine += std::cos(start);
  }
  return std::atan2(sine, cosine);
}

}  // namespace

ScanPacker::ScanPacker(const slam::LidarModel& model, double rpm, bool vertical_offsets) {
  const auto columns = static_cast<std::size_t>(slam::firings_per_message(model, rpm));
  const auto rings = static_cast<std::size_t>(model.rings());
  const std::size_t every = std::max<std::size_t>(1, (columns * rings + most_returns - 1) / most_returns);
  const double rate = full_turn * rpm / 60.0, period_s = slam::seconds(model.firing_period_ns);
  grid_.rings = model.rings();
  grid_.every = static_cast<int>(every);
  grid_.columns = static_cast<int>((columns + every - 1) / every);
  grid_.column_s = static_cast<double>(every) * period_s;
  grid_.turn_rad = rate * grid_.column_s;
  grid_.span_s = static_cast<double>(columns - 1) * period_s + slam::seconds(slam::last_laser_ns(model));
  for (std::vector<double>* table : {&grid_.azimuth_rad, &grid_.cosine, &grid_.sine, &grid_.height_m})
    table->assign(rings, 0.0);
  for (const slam::Laser& laser : model.lasers) {
    const auto ring = static_cast<std::size_t>(laser.ring);
    grid_.azimuth_rad[ring] = laser.azimuth_deg * full_turn / 360.0 + rate * slam::seconds(laser.time_ns);
    grid_.cosine[ring] = laser.cosine;
    grid_.sine[ring] = laser.sine;
    grid_.height_m[ring] = vertical_offsets ? laser.height_m : 0.0;
  }
}

void ScanPacker::add(const slam::Scan& scan) {
  const auto rings = static_cast<std::size_t>(grid_.rings), columns = static_cast<std::size_t>(grid_.columns);
  const std::size_t n = rings * columns;
  std::string bytes(2 * n, '\0');
  for (std::size_t ring = 0, k = 0; ring < rings; ++ring) {
    int before = 0;
    for (std::size_t column = 0; column < columns; ++column, ++k) {
      const std::size_t i = column * static_cast<std::size_t>(grid_.every) * rings + ring;
      const double units = i < scan.size() ? std::round(scan.range_m[i] / grid_.unit_m) : 0.0;
      const int here = static_cast<int>(std::clamp(units, 0.0, 65535.0));
      const std::uint16_t value = folded(here - before);
      bytes[k] = static_cast<char>(value & 0xFFU);
      bytes[n + k] = static_cast<char>(value >> 8U);
      before = here;
    }
  }
  scans_.push_back({scan.stamp, first_azimuth(scan, grid_), deflated(bytes)});
}

std::string ScanPacker::ranges(std::size_t scan) const {
  const std::size_t size = 2 * static_cast<std::size_t>(grid_.rings) * static_cast<std::size_t>(grid_.columns);
  return inflated(scans_.at(scan).bytes, size);
}

ScanPacker packer_of(const ResolvedScenario& resolved) {
  const sim::WorldConfig& world = resolved.world;
  return {slam::lidar_model(world.lidar.model), world.rpm, world.vertical_offsets};
}

}  // namespace plumbline::scenarios
