// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/edges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plumbline::sim {

namespace {

constexpr std::size_t batch_probes = 128;
constexpr std::size_t tile = Beams::tile_columns;

}  // namespace

EdgeFinder::EdgeFinder(const LidarConfig& config, const bim::RayScene& scene) : config_(config), scene_(scene) {
  const std::size_t most = batch_probes + 2 * tile * slam::lidar_model(config.model).lasers.size();
  probes_.reserve(most);
  rays_.reserve(most);
  hits_.reserve(most);
}

bool EdgeFinder::breaks_at(const Beams& beams, std::size_t a, std::size_t b) const {
  return breaks(beams.ray(a), beams.hit(a), beams.ray(b), beams.hit(b), config_.edge_jump_m);
}

/// True when two neighbouring beams of a ring do not meet one flat face without a jump.
bool EdgeFinder::differ(const Beams& beams, std::size_t a, std::size_t b) const {
  return breaks_at(beams, a, b) ||
         (beams.hit(a).element >= 0 && std::abs(beams.hit(a).range_m - beams.hit(b).range_m) > config_.edge_jump_m);
}

/// True when the end of a footprint surely meets the face of the beam's middle: it lies in the same triangle, and the
/// plane of the face that the next ring hits lies behind it there.
bool EdgeFinder::settled(const Beams& beams, std::size_t beam, std::size_t other, const bim::Ray& end) const {
  const bim::Hit& here = beams.hit(beam);
  if (here.triangle < 0 || !scene_.meets(here.triangle, end)) return false;
  const bim::Hit& there = beams.hit(other);
  if (there.element < 0) return true;
  if (there.triangle < 0) return false;
  const double slope = there.normal_W.dot(end.direction_W);
  if (!(slope < 0.0)) return true;
  const bim::Ray& ray = beams.ray(beam);
  const double range = here.range_m * here.normal_W.dot(ray.direction_W) / here.normal_W.dot(end.direction_W);
  const Eigen::Vector3d point_W = beams.ray(other).origin_W + there.range_m * beams.ray(other).direction_W;
  return there.normal_W.dot(point_W - end.origin_W) / slope >= range;
}

void EdgeFinder::find_in_tile(const Beams& beams, std::size_t first, std::span<std::uint8_t> at_edge) {
  const double end = 0.5 * config_.divergence_vertical_rad;
  const double unit = 1.0 / std::sqrt(1.0 + end * end);
  const std::size_t last = std::min(first + tile, beams.columns() + 1);
  for (std::size_t ring = 0; ring < beams.lasers(); ++ring) {
    const std::size_t laser = beams.laser_of(ring);
    for (std::size_t c = std::max<std::size_t>(first, 1); c < last; ++c) {
      const auto column = static_cast<std::int64_t>(c) - 1;
      const std::size_t beam = beams.index(column, laser);
      const std::size_t out = (c - 1) * beams.lasers() + laser;
      if (differ(beams, beam, beams.index(column - 1, laser)) || differ(beams, beam, beams.index(column + 1, laser))) {
        at_edge[out] = 1;
        continue;
      }
      const auto probe = [&](std::size_t other, double up) {
        if (!breaks_at(beams, beam, other)) return;
        const bim::Ray ray = sub_ray(beams.ray(beam), beams.tangents(c - 1, laser), {0.0, up, unit});
        if (settled(beams, beam, other, ray)) return;
        probes_.push_back({beam, out});
        rays_.push_back(ray);
      };
      if (ring > 0) probe(beam - tile, -end);
      if (ring + 1 < beams.lasers()) probe(beam + tile, end);
    }
  }
}

void EdgeFinder::cast_probes(const Beams& beams, std::span<std::uint8_t> at_edge) {
  hits_.resize(rays_.size());
  scene_.cast(rays_, slam::lidar_model(config_.model).range_max_m, hits_);
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    const std::size_t beam = probes_[i].beam;
    if (breaks(beams.ray(beam), beams.hit(beam), rays_[i], hits_[i], config_.edge_jump_m)) at_edge[probes_[i].out] = 1;
  }
  probes_.clear();
  rays_.clear();
}

void EdgeFinder::find(const Beams& beams, std::span<std::uint8_t> at_edge) {
  for (std::size_t first = 0; first < beams.columns() + 1; first += tile) {
    find_in_tile(beams, first, at_edge);
    if (probes_.size() >= batch_probes) cast_probes(beams, at_edge);
  }
  cast_probes(beams, at_edge);
}

}  // namespace plumbline::sim
