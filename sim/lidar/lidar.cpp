// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::sim {

namespace {

namespace vlp16 = slam::vlp16;

constexpr std::size_t lasers = 16;
constexpr std::size_t tile_columns = 8;              // one packet of rays: eight neighbouring columns of one laser
constexpr std::int64_t full_turn = 360'000'000'000;  // 1e-9 degrees
constexpr double units_to_rad = std::numbers::pi / 180.0 * 1e-9;
constexpr std::int64_t units_per_cdeg = 10'000'000;

/// Random draws of one sensor and run. Each is addressed by firing and laser alone.
struct Draws {
  explicit Draws(std::uint64_t seed)
      : bias(seed, "sim.lidar.bias"),
        dropout(seed, "sim.lidar.dropout"),
        phase(seed, "sim.lidar.phase"),
        range(seed, "sim.lidar.range") {}
  Stream bias;
  Stream dropout;
  Stream phase;
  Stream range;
};

/// Turn of the motor from the start of a firing to the shot of each laser.
struct LaserTurns {
  std::array<double, lasers> cosine{};
  std::array<double, lasers> sine{};
};

/// Rays and hits of eight columns, laser by laser: index laser * 8 + column.
struct Tile {
  std::array<bim::Ray, lasers * tile_columns> rays;
  std::array<bim::Hit, lasers * tile_columns> hits;
};

}  // namespace

struct Lidar::Impl {
  LidarConfig config;
  const bim::RayScene& scene;
  Draws draws;
  std::int64_t turn_per_firing;  ///< 1e-9 degrees
  std::int64_t phase;            ///< azimuth of firing 0, 1e-9 degrees
  LaserTurns turns;
  std::array<double, lasers> bias_m{};

  Impl(const LidarConfig& config_in, double rpm, std::uint64_t seed, const bim::RayScene& scene_in);

  [[nodiscard]] std::int64_t azimuth(std::int64_t firing) const {
    return (phase + firing * turn_per_firing) % full_turn;
  }
  void aim(std::int64_t firing, const Pose& X_WL, std::size_t column, Tile& tile) const;
  [[nodiscard]] std::uint16_t measure(std::int64_t firing, std::size_t laser, const bim::Ray& ray,
                                      const bim::Hit& hit) const;
  void fire_tile(std::int64_t first_firing, std::span<const Pose> X_WL, Tile& tile,
                 std::span<slam::Vlp16Firing> firings, std::size_t first_column, ReturnLabels& labels) const;
};

Lidar::Impl::Impl(const LidarConfig& config_in, double rpm, std::uint64_t seed, const bim::RayScene& scene_in)
    : config(config_in), scene(scene_in), draws(seed) {
  if (!(rpm >= 300.0 && rpm <= 1200.0))
    throw InputError({}, "LiDAR speed of " + std::to_string(rpm) + " rpm; 300 to 1200 would be right");
  turn_per_firing = std::llround(6.0 * rpm * static_cast<double>(vlp16::firing_period_ns));
  phase = static_cast<std::int64_t>(draws.phase.uniform(0) * static_cast<double>(full_turn));
  for (std::size_t k = 0; k < lasers; ++k) {
    const double turn = 6.0 * rpm * static_cast<double>(vlp16::laser_period_ns) * static_cast<double>(k) * units_to_rad;
    turns.cosine[k] = std::cos(turn);
    turns.sine[k] = std::sin(turn);
    bias_m[k] = config.unit_bias_sigma_m * draws.bias.gauss(0, 0) +
                config.laser_bias_sigma_m * draws.bias.gauss(0, 1 + static_cast<std::uint32_t>(k));
  }
}

/// Rays of one firing into one column of the tile.
void Lidar::Impl::aim(std::int64_t firing, const Pose& X_WL, std::size_t column, Tile& tile) const {
  const double angle = static_cast<double>(azimuth(firing)) * units_to_rad;
  const double c0 = std::cos(angle);
  const double s0 = std::sin(angle);
  const Eigen::Matrix3d R_WL = X_WL.rotation();
  for (std::size_t k = 0; k < lasers; ++k) {
    const int laser = static_cast<int>(k);
    const double c = c0 * turns.cosine[k] - s0 * turns.sine[k];
    const double s = s0 * turns.cosine[k] + c0 * turns.sine[k];
    const double flat = vlp16::cos_elevation(laser);
    bim::Ray& ray = tile.rays[k * tile_columns + column];
    ray.direction_W = R_WL * Eigen::Vector3d(flat * c, -flat * s, vlp16::sin_elevation(laser));
    ray.origin_W = X_WL.t + vlp16::vertical_offset_m(laser) * R_WL.col(2);
    ray.time_s = 1e-9 * static_cast<double>(firing * vlp16::firing_period_ns + laser * vlp16::laser_period_ns);
  }
}

/// Distance word of one shot, 0 where nothing returns.
std::uint16_t Lidar::Impl::measure(std::int64_t firing, std::size_t laser, const bim::Ray& ray,
                                   const bim::Hit& hit) const {
  if (hit.element < 0) return 0;
  const auto tick = static_cast<std::uint64_t>(firing);
  const auto lane = static_cast<std::uint32_t>(laser);
  const double share = return_share(config, hit.range_m, std::abs(hit.normal_W.dot(ray.direction_W)));
  if (share < 1.0 && draws.dropout.uniform(tick, lane) >= share) return 0;
  const double sigma = range_sigma(config, hit.range_m);
  const double noise = sigma > 0.0 ? sigma * draws.range.gauss(tick, lane) : 0.0;
  const double range = hit.range_m + bias_m[laser] + noise;
  if (range < config.range_min_m || range > config.range_max_m) return 0;
  return static_cast<std::uint16_t>(std::lround(range / vlp16::range_unit_m));
}

/// Fires eight columns: aims, casts, measures.
void Lidar::Impl::fire_tile(std::int64_t first_firing, std::span<const Pose> X_WL, Tile& tile,
                            std::span<slam::Vlp16Firing> firings, std::size_t first_column,
                            ReturnLabels& labels) const {
  for (std::size_t c = 0; c < tile_columns; ++c) aim(first_firing + static_cast<std::int64_t>(c), X_WL[c], c, tile);
  scene.cast(tile.rays, config.range_max_m, tile.hits);
  for (std::size_t c = 0; c < tile_columns; ++c) {
    const std::int64_t firing = first_firing + static_cast<std::int64_t>(c);
    const std::int64_t cdeg = (azimuth(firing) + units_per_cdeg / 2) / units_per_cdeg;
    firings[c].azimuth_cdeg = static_cast<std::uint16_t>(cdeg % (full_turn / units_per_cdeg));
    for (std::size_t k = 0; k < lasers; ++k) {
      const bim::Ray& ray = tile.rays[k * tile_columns + c];
      const bim::Hit& hit = tile.hits[k * tile_columns + c];
      const std::uint16_t distance = measure(firing, k, ray, hit);
      firings[c].distance[k] = distance;
      if (distance == 0) continue;
      const double cosine = std::abs(hit.normal_W.dot(ray.direction_W));
      firings[c].reflectivity[k] = static_cast<std::uint8_t>(std::lround(100.0 * config.reflectivity * cosine));
      const auto ring = static_cast<std::size_t>(vlp16::ring_of_laser(static_cast<int>(k)));
      const std::size_t slot = (first_column + c) * lasers + ring;
      labels.element[slot] = hit.element;
      labels.point_W[slot] = ray.origin_W + hit.range_m * ray.direction_W;
    }
  }
}

Lidar::Lidar(LidarPreset preset, double rpm, std::uint64_t seed, const bim::RayScene& scene)
    : Lidar(lidar_config(preset), rpm, seed, scene) {}
Lidar::Lidar(const LidarConfig& config, double rpm, std::uint64_t seed, const bim::RayScene& scene)
    : impl_(std::make_unique<Impl>(config, rpm, seed, scene)) {}
Lidar::~Lidar() = default;

Sweep Lidar::sweep(std::int64_t first_firing, std::span<const Pose> X_WL) const {
  constexpr std::size_t per_packet = vlp16::firings_per_packet;
  static_assert(per_packet % tile_columns == 0);
  if (first_firing < 0 || X_WL.empty() || X_WL.size() % per_packet != 0)
    throw InternalError("Lidar::sweep: poses of whole packets are needed");
  Sweep sweep;
  sweep.packets.reserve(X_WL.size() / per_packet);
  sweep.labels.element.assign(X_WL.size() * lasers, -1);
  sweep.labels.point_W.assign(X_WL.size() * lasers, Eigen::Vector3d::Zero());
  Tile tile;
  for (std::size_t packet = 0; packet < X_WL.size(); packet += per_packet) {
    std::array<slam::Vlp16Firing, per_packet> firings;
    for (std::size_t c = 0; c < per_packet; c += tile_columns) {
      const std::size_t column = packet + c;
      impl_->fire_tile(first_firing + static_cast<std::int64_t>(column), X_WL.subspan(column, tile_columns), tile,
                       std::span(firings).subspan(c, tile_columns), column, sweep.labels);
    }
    const std::int64_t firing = first_firing + static_cast<std::int64_t>(packet);
    sweep.packets.push_back(slam::encode_packet(firing * vlp16::firing_period_ns, firings));
  }
  return sweep;
}

}  // namespace plumbline::sim
