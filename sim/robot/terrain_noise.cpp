// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/terrain_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumbline::sim {

namespace {

enum Draw : std::uint32_t { off_x, off_y, half_x, half_y, height, tilt, heading };

std::uint64_t address(const Eigen::Vector2i& cell) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.x())) << 32U) |
         static_cast<std::uint32_t>(cell.y());
}

/// A plate that is not there waits far below every floor.
CollisionBox no_plate() {
  CollisionBox box;
  box.X_WB.t.z() = -50.0;
  box.half.setConstant(0.01);
  return box;
}

}  // namespace

TerrainNoise::TerrainNoise(double height_m, const Eigen::Vector2d& start_W, std::vector<int> geoms, std::uint64_t seed)
    : height_m_(height_m), start_W_(start_W), geoms_(std::move(geoms)), stream_(seed, "sim.ground.uneven") {}

std::optional<CollisionBox> TerrainNoise::plate(const Eigen::Vector2i& cell) const {
  const std::uint64_t tick = address(cell);
  const auto uniform = [&](Draw draw, double low, double high) {
    return low + (high - low) * stream_.uniform(tick, 0, draw);
  };
  const double off = config_.off_center_m;
  const Eigen::Vector2d p_W = config_.cell_m * (cell.cast<double>().array() + 0.5).matrix() +
                              Eigen::Vector2d(uniform(off_x, -off, off), uniform(off_y, -off, off));
  if ((p_W - start_W_).norm() < config_.start_clear_m) return std::nullopt;

  CollisionBox box;
  box.half = {uniform(half_x, config_.half_min_m, config_.half_max_m),
              uniform(half_y, config_.half_min_m, config_.half_max_m), 0.5 * config_.thickness_m};
  // Half of the height is the plate's middle, half the edge above it.
  const double top = uniform(height, 0.0, 0.5 * height_m_);
  const double slope = std::asin(std::min(0.5, 0.5 * height_m_ / box.half.y())) * uniform(tilt, -1.0, 1.0);
  const double yaw = uniform(heading, -std::numbers::pi, std::numbers::pi);
  box.X_WB = {Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(slope, Eigen::Vector3d::UnitX()),
              {p_W.x(), p_W.y(), top - box.half.z()}};
  return box;
}

void TerrainNoise::refresh(mjModel_& model, const Eigen::Vector2d& p_W, double floor_z) {
  const Window here{(p_W / config_.cell_m).array().floor().cast<int>(), floor_z};
  if (window_ == here) return;
  window_ = here;
  // Each plate keeps its geom while it stays in the window.
  const int n = config_.window;
  const auto wrapped = [n](int i) { return static_cast<std::size_t>(((i % n) + n) % n); };
  for (int dy = -n / 2; dy <= n / 2; ++dy)
    for (int dx = -n / 2; dx <= n / 2; ++dx) {
      const Eigen::Vector2i cell = here.cell + Eigen::Vector2i(dx, dy);
      CollisionBox box = plate(cell).value_or(no_plate());
      box.X_WB.t.z() += floor_z;
      const Eigen::Quaterniond& q = box.X_WB.q;
      place_box(model, geoms_[wrapped(cell.y()) * static_cast<std::size_t>(n) + wrapped(cell.x())], box.X_WB.t,
                {q.w(), q.x(), q.y(), q.z()}, box.half);
    }
}

}  // namespace plumbline::sim
