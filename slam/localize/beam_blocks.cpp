// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/beam_blocks.h"

#include <emmintrin.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumbline::slam {

namespace {

using Mask4 = int __attribute__((vector_size(16)));

constexpr double sectors_per_rad = FaceSectors::per_turn / (2.0 * std::numbers::pi);

Float4 all(float value) { return Float4{value, value, value, value}; }
Float4 choose(Mask4 mask, Float4 yes, Float4 no) { return mask ? yes : no; }
/// Bit i is set where lane i is.
int lanes(Mask4 mask) { return _mm_movemask_ps(reinterpret_cast<__m128>(mask)); }

/// An angle in sectors, 0 to per_turn.
double in_sectors(double angle) {
  const double sectors = angle * sectors_per_rad;
  return sectors - FaceSectors::per_turn * std::floor(sectors / FaceSectors::per_turn);
}

}  // namespace

/// Where the beams leave from.
struct BeamBlocks::Sensor {
  Eigen::Vector2f p_I;
  float z = 0.0F, c = 1.0F, s = 0.0F;  ///< height in I, cosine and sine of the heading
  int cell = -1;
  double yaw_sectors = 0.0;
};

struct BeamBlocks::Hits {
  Float4 distance;   ///< of the hit, the reach where there is none
  Float4 incidence;  ///< cosine, 1 where there is none
};

BeamBlocks::BeamBlocks(const StoreyIndex& storey, const View& view, int stride, const LikelihoodConfig& config)
    : storey_(storey), view_(view), stride_(stride), config_(config) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < view.beams.size(); i += static_cast<std::size_t>(stride)) {
    const Eigen::Vector2d& direction = view.beams[i].direction_H;
    order.emplace_back(in_sectors(std::atan2(direction.y(), direction.x())), i);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t first = 0; first < order.size(); first += 4) {
    Block block{all(1.0F), all(0.0F), all(0.0F), all(-1.0F), all(0.0F), 0.0, 0.0, {}};
    block.from = order[first].first;
    for (std::size_t k = 0; k < 4 && first + k < order.size(); ++k) {
      const auto [azimuth, i] = order[first + k];
      const Beam& beam = view.beams[i];
      block.x[k] = static_cast<float>(beam.direction_H.x());
      block.y[k] = static_cast<float>(beam.direction_H.y());
      block.range[k] = static_cast<float>(beam.range);
      block.reach[k] = static_cast<float>(beam_reach(storey, beam, view.sensor_height));
      block.slope[k] = static_cast<float>(beam.slope);
      block.span = azimuth - block.from;
      block.beams[k] = i;
    }
    blocks_.push_back(block);
  }
}

BeamBlocks::Hits BeamBlocks::meet(const Block& block, const Sensor& sensor) const {
  const Float4 x = sensor.c * block.x - sensor.s * block.y, y = sensor.s * block.x + sensor.c * block.y;
  Float4 distance = block.reach, incidence = all(1.0F);
  const auto first = static_cast<int>(sensor.yaw_sectors + block.from);
  const auto last = static_cast<int>(sensor.yaw_sectors + block.from + block.span);
  int far = 0;
  for (int sector = first; sector <= last; sector += FaceSectors::wide) {
    const FaceSectors::Entry* entry = storey_.sectors.list(sensor.cell, sector % FaceSectors::per_turn);
    for (; lanes(distance >= entry->from) != 0 && entry->segment >= 0; ++entry) {
      const FaceSectors::Face& face = storey_.sectors.face(entry->segment);
      const float ax = face.ax - sensor.p_I.x(), ay = face.ay - sensor.p_I.y();
      const Float4 across = face.nx * x + face.ny * y;
      const Float4 t = (face.nx * ax + face.ny * ay) / across;
      const Float4 s = t * (face.ex * x + face.ey * y) - (face.ex * ax + face.ey * ay);
      const Float4 z = sensor.z + t * block.slope;
      Mask4 hit = (t > 1e-9F) & (t < distance) & (s >= 0.0F) & (s <= face.whole.s1) & (z >= face.whole.z0) &
                  (z <= face.whole.z1);
      for (int i = face.first_hole; i < face.last_hole; ++i) {
        const FaceSectors::Window& hole = storey_.sectors.holes()[static_cast<std::size_t>(i)];
        hit &= ~((s > hole.s0) & (s < hole.s1) & (z > hole.z0) & (z < hole.z1));
      }
      distance = choose(hit, t, distance);
      incidence = choose(hit, across, incidence);
    }
    if (entry->segment < 0) far |= lanes(distance >= entry->from);
  }
  Hits hits{distance, incidence < 0.0F ? -incidence : incidence};
  for (std::size_t k = 0; far != 0 && k < 4; ++k)
    if ((far & (1 << k)) != 0 && distance[k] >= storey_.sectors.complete(sensor.cell, {x[k], y[k]}))
      settle(block, sensor, k, hits);
  return hits;
}

void BeamBlocks::settle(const Block& block, const Sensor& sensor, std::size_t k, Hits& hits) const {
  const Eigen::Matrix2d R_IH = (Eigen::Matrix2d() << sensor.c, -sensor.s, sensor.s, sensor.c).finished();
  const PlanRay ray{sensor.p_I.cast<double>(), R_IH * view_.beams[block.beams[k]].direction_H, sensor.z,
                    block.slope[k]};
  const PlanHit hit = storey_.grid.cast(storey_.segments, ray, block.reach[k], sensor.cell);
  hits.distance[k] = static_cast<float>(hit.distance);
  hits.incidence[k] =
      hit.segment < 0
          ? 1.0F
          : static_cast<float>(std::abs(storey_.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction)));
}

Float4 BeamBlocks::penalty(const Block& block, const Hits& hits) const {
  const Float4 least = all(static_cast<float>(config_.beam_min_incidence));
  const Float4 incidence = choose(hits.incidence > least, hits.incidence, least);
  const Float4 e = (block.range - hits.distance) * incidence / static_cast<float>(config_.beam_sigma_m);
  const Float4 cap =
      choose(e > 0.0F, all(static_cast<float>(config_.beam_long_cap)), all(static_cast<float>(config_.beam_short_cap)));
  const Float4 squares = 0.5F * e * e;
  return choose(block.reach < 0.0F, all(0.0F), choose(squares < cap, squares, cap));
}

double BeamBlocks::log_likelihood(const Pose2& X_IH) const {
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * view_.sensor_H + X_IH.t;
  Sensor sensor{sensor_I.cast<float>(),         static_cast<float>(storey_.floor_z + view_.sensor_height),
                static_cast<float>(R_IH(0, 0)), static_cast<float>(R_IH(1, 0)),
                storey_.grid.cell_at(sensor_I), in_sectors(X_IH.yaw)};
  if (sensor.cell < 0 || storey_.sectors.empty()) return beam_log_likelihood(storey_, X_IH, view_, stride_, config_);
  Float4 sum = all(0.0F);
  for (const Block& block : blocks_) sum += penalty(block, meet(block, sensor));
  const double total = static_cast<double>(sum[0]) + static_cast<double>(sum[1]) + static_cast<double>(sum[2]) +
                       static_cast<double>(sum[3]);
  return -config_.beam_weight * stride_ * total;
}

}  // namespace plumbline::slam
