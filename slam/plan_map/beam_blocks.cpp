// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/beam_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace plumbline::slam {

namespace {

constexpr double sectors_per_rad = FaceSectors::per_turn / (2.0 * std::numbers::pi);

/// An angle in sectors, 0 to per_turn.
double in_sectors(double angle) {
  const double sectors = angle * sectors_per_rad;
  if (sectors >= 0.0 && sectors < FaceSectors::per_turn) return sectors;
  return sectors - FaceSectors::per_turn * std::floor(sectors / FaceSectors::per_turn);
}

/// Range residual beyond which a penalty is at its cap at any incidence, and a little more.
double certain(double cap, const LikelihoodConfig& config) {
  if (config.beam_min_incidence <= 0.0) return std::numeric_limits<double>::infinity();
  return 1.001 * std::sqrt(2.0 * cap) * config.beam_sigma_m / std::min(config.beam_min_incidence, 1.0);
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

BeamBlocks::BeamBlocks(const StoreyIndex& storey, const LocalizationScan& scan, int stride,
                       const LikelihoodConfig& config)
    : storey_(storey),
      scan_(scan),
      stride_(stride),
      config_(config),
      least_incidence_(all(static_cast<float>(config.beam_min_incidence))),
      inverse_sigma_(all(static_cast<float>(1.0 / config.beam_sigma_m))),
      long_cap_(all(static_cast<float>(config.beam_max_nll_long))),
      short_cap_(all(static_cast<float>(config.beam_max_nll_short))) {
  const double certain_long = certain(config.beam_max_nll_long, config),
               certain_short = certain(config.beam_max_nll_short, config);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < scan.beams.size(); i += static_cast<std::size_t>(stride)) {
    const Eigen::Vector2d& direction = scan.beams[i].direction_H;
    order.emplace_back(in_sectors(std::atan2(direction.y(), direction.x())), i);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t first = 0; first < order.size(); first += 4) {
    Block block{all(1.0F), all(0.0F), all(0.0F), all(-1.0F), all(-1.0F), all(0.0F), 0.0, 0.0, {}};
    block.from = order[first].first;
    for (std::size_t k = 0; k < 4 && first + k < order.size(); ++k) {
      const auto [azimuth, i] = order[first + k];
      const Beam& beam = scan.beams[i];
      block.x[k] = static_cast<float>(beam.direction_H.x());
      block.y[k] = static_cast<float>(beam.direction_H.y());
      block.range[k] = static_cast<float>(beam.range);
      block.reach[k] =
          static_cast<float>(std::min(beam_reach(storey, beam, scan.sensor_height), beam.range + certain_short));
      block.enough[k] = static_cast<float>(beam.range - certain_long);
      block.slope[k] = static_cast<float>(beam.slope);
      block.span = azimuth - block.from;
      block.beams[k] = i;
    }
    blocks_.push_back(block);
  }
}

BeamBlocks::Hits BeamBlocks::cast(const Block& block, const Sensor& sensor) const {
  const Float4 x = sensor.c * block.x - sensor.s * block.y, y = sensor.s * block.x + sensor.c * block.y;
  Float4 distance = block.reach, incidence = all(1.0F);
  const auto first = static_cast<int>(sensor.yaw_sectors + block.from);
  const auto last = static_cast<int>(sensor.yaw_sectors + block.from + block.span);
  int far = 0;
  const auto open = [&](float from) { return lanes((distance >= from) & (distance > block.enough)); };
  const Float4 px = all(sensor.p_I.x()), py = all(sensor.p_I.y());
  for (int sector = first; sector <= last; sector += FaceSectors::wide) {
    const FaceSectors::Entry* entry = storey_.sectors.list(sensor.cell, sector % FaceSectors::per_turn);
    for (; open(entry->from) != 0 && entry->segment >= 0; ++entry) {
      const FaceSectors::Intersection meeting = storey_.sectors.intersect(storey_.sectors.face(entry->segment), px, py,
                                                                          sensor.z, x, y, block.slope, distance);
      distance = choose(meeting.hit, meeting.t, distance);
      incidence = choose(meeting.hit, meeting.across, incidence);
    }
    if (entry->segment < 0) far |= open(entry->from);
  }
  Hits hits{distance, incidence < 0.0F ? -incidence : incidence};
  for (std::size_t k = 0; far != 0 && k < 4; ++k)
    if ((far & (1 << k)) != 0 && distance[k] >= storey_.sectors.complete(sensor.cell, {x[k], y[k]}))
      cast_one(block, sensor, k, hits);
  return hits;
}

void BeamBlocks::cast_one(const Block& block, const Sensor& sensor, std::size_t k, Hits& hits) const {
  const Eigen::Matrix2d R_IH = (Eigen::Matrix2d() << sensor.c, -sensor.s, sensor.s, sensor.c).finished();
  const PlanRay ray{sensor.p_I.cast<double>(), R_IH * scan_.beams[block.beams[k]].direction_H, sensor.z,
                    block.slope[k]};
  const PlanHit hit = storey_.grid.cast(storey_.segments, ray, block.reach[k], sensor.cell);
  hits.distance[k] = static_cast<float>(hit.distance);
  hits.incidence[k] =
      hit.segment < 0
          ? 1.0F
          : static_cast<float>(std::abs(storey_.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction)));
}

Float4 BeamBlocks::penalty(const Block& block, const Hits& hits) const {
  const Float4 incidence = choose(hits.incidence > least_incidence_, hits.incidence, least_incidence_);
  const Float4 e = (block.range - hits.distance) * incidence * inverse_sigma_;
  const Float4 cap = choose(e > 0.0F, long_cap_, short_cap_);
  const Float4 squares = 0.5F * e * e;
  return choose(block.reach < 0.0F, all(0.0F), choose(squares < cap, squares, cap));
}

double BeamBlocks::log_likelihood(const SensorPose2& pose) const {
  if (pose.cell < 0 || storey_.sectors.empty()) return beam_log_likelihood(storey_, pose.X_IH, scan_, stride_, config_);
  const Sensor sensor{pose.sensor_I.cast<float>(),
                      static_cast<float>(storey_.floor_at(pose.sensor_I) + scan_.sensor_height),
                      static_cast<float>(pose.R_IH(0, 0)),
                      static_cast<float>(pose.R_IH(1, 0)),
                      pose.cell,
                      in_sectors(pose.X_IH.yaw)};
  Float4 sum = all(0.0F);
  for (const Block& block : blocks_) sum += penalty(block, cast(block, sensor));
  const double total = static_cast<double>(sum[0]) + static_cast<double>(sum[1]) + static_cast<double>(sum[2]) +
                       static_cast<double>(sum[3]);
  return -config_.beam_weight * stride_ * total;
}

}  // namespace plumbline::slam
