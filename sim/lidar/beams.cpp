// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/beams.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::sim {

namespace {

constexpr std::int64_t full_turn = 360'000'000'000;  // 1e-9 degrees
constexpr double units_to_rad = std::numbers::pi / 180.0 * 1e-9;

}  // namespace

Beams::Beams(const slam::LidarModel& model, double rpm, std::int64_t phase)
    : model_(model),
      turn_per_firing_(std::llround(6.0 * rpm * static_cast<double>(model.firing_period_ns))),
      phase_(phase),
      laser_of_ring_(model.lasers.size()) {
  for (std::size_t k = 0; k < model.lasers.size(); ++k) {
    const slam::Laser& laser = model.lasers[k];
    const double turn = (6.0 * rpm * static_cast<double>(laser.time_ns) + 1e9 * laser.azimuth_deg) * units_to_rad;
    laser_turns_.push_back({std::cos(turn), std::sin(turn)});
    laser_of_ring_[static_cast<std::size_t>(laser.ring)] = k;
  }
}

std::int64_t Beams::azimuth(std::int64_t firing) const {
  return ((phase_ + firing * turn_per_firing_) % full_turn + full_turn) % full_turn;
}

void Beams::cast(std::int64_t first_firing, std::span<const Pose> X_WL, const bim::RayScene& scene) {
  columns_ = X_WL.size();
  const std::size_t tiles = (columns_ + 2 + tile_columns - 1) / tile_columns;
  heads_.resize(tiles * tile_columns);
  rays_.resize(tiles * tile_columns * lasers());
  hits_.resize(rays_.size());
  const auto last = static_cast<std::int64_t>(columns_) - 1;
  // A neighbour beyond the message's ends is fired from the pose at that end.
  for (std::int64_t column = -1; column + 1 < static_cast<std::int64_t>(heads_.size()); ++column)
    aim(column, first_firing, X_WL[static_cast<std::size_t>(std::clamp(column, std::int64_t{0}, last))]);
  scene.cast(rays_, model_.range_max_m, hits_);
}

Beams::Turn Beams::turn_of(std::int64_t column, std::size_t laser) const {
  const Turn& head = heads_[static_cast<std::size_t>(column + 1)].turn;
  const Turn& turn = laser_turns_[laser];
  return {head.c * turn.c - head.s * turn.s, head.s * turn.c + head.c * turn.s};
}

void Beams::aim(std::int64_t column, std::int64_t first_firing, const Pose& X_WL) {
  const double angle = static_cast<double>(azimuth(first_firing + column)) * units_to_rad;
  Head& head = heads_[static_cast<std::size_t>(column + 1)];
  head = {{std::cos(angle), std::sin(angle)}, X_WL.rotation()};
  for (std::size_t k = 0; k < lasers(); ++k) {
    const Turn turn = turn_of(column, k);
    const slam::Laser& laser = model_.lasers[k];
    bim::Ray& ray = rays_[index(column, k)];
    ray.direction_W = head.R_WL * Eigen::Vector3d(laser.cosine * turn.c, -laser.cosine * turn.s, laser.sine);
    ray.origin_W = X_WL.t + laser.height_m * head.R_WL.col(2);
    ray.time_s = 1e-9 * static_cast<double>((first_firing + column) * model_.firing_period_ns + laser.time_ns);
  }
}

Tangents Beams::tangents(std::size_t column, std::size_t laser) const {
  const Turn turn = turn_of(static_cast<std::int64_t>(column), laser);
  const slam::Laser& tilt = model_.lasers[laser];
  const Eigen::Matrix3d& R_WL = heads_[column + 1].R_WL;
  return {R_WL * Eigen::Vector3d(-turn.s, -turn.c, 0.0),
          R_WL * Eigen::Vector3d(-tilt.sine * turn.c, tilt.sine * turn.s, tilt.cosine)};
}

}  // namespace plumbline::sim
