// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/wall_blocks.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumbline::slam {

namespace {

/// A line of the plan as the sensor sees it.
struct Line4 {
  Float4 azimuth, distance, foot, end;  ///< end: of the line, lengthened
};

}  // namespace

WallBlocks::WallBlocks(const LocalizationScan& scan, const LikelihoodConfig& config) : config_(config) {
  const double outlier = config.plane_outlier / (4.0 * config.azimuth_gate * config.distance_gate_m);
  const Block nothing{all(0.0F), all(0.0F), all(0.0F), all(0.0F), all(0.0F),
                      all(0.0F), all(0.0F), all(0.0F), all(1.0F)};
  for (std::size_t i = 0; i < scan.walls.size(); ++i) {
    const std::size_t k = i % 4;
    if (k == 0) blocks_.push_back(nothing);
    Block& block = blocks_.back();
    const WallObservation& wall = scan.walls[i];
    const WallInformation v = information(wall, config);
    const auto set = [k](Float4& lane, double value) { lane[k] = static_cast<float>(value); };
    set(block.azimuth, wall.azimuth);
    set(block.distance, wall.distance);
    set(block.s0, wall.s0);
    set(block.s1, wall.s1);
    set(block.least_overlap, config.overlap_min * (wall.s1 - wall.s0));
    set(block.azimuth_information, v.azimuth);
    set(block.distance_information, v.distance);
    set(block.peak, peak_density(v, config));
    set(block.outlier, outlier);
  }
}

double WallBlocks::log_likelihood(const StoreyIndex& storey, const SensorPose2& pose) const {
  constexpr float infinity = std::numeric_limits<float>::infinity(), turn = static_cast<float>(2.0 * std::numbers::pi);
  std::array<Float4, max_walls / 4> best;
  best.fill(all(infinity));
  const Float4 gate = all(static_cast<float>(config_.azimuth_gate)),
               margin = all(static_cast<float>(config_.overlap_margin_m));
  if (pose.cell >= 0)
    for (const int i : storey.visible[static_cast<std::size_t>(pose.cell)]) {
      const WallLine& line = storey.lines[static_cast<std::size_t>(i)];
      const double distance = line.n.dot(pose.sensor_I) + line.d;
      if (distance <= 0.0) continue;
      const auto f = [](double value) { return all(static_cast<float>(value)); };
      const Line4 expected{f(line.azimuth - pose.X_IH.yaw), f(distance), f(line.e.dot(pose.sensor_I - line.a)),
                           f(line.length + config_.overlap_margin_m)};
      for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const Block& block = blocks_[k];
        const Float4 apart = block.azimuth - expected.azimuth;
        const Float4 turned = apart - turn * whole_of(apart * (1.0F / turn));
        const Float4 to = expected.foot + block.s1, from = expected.foot + block.s0;
        const Float4 overlap = (to < expected.end ? to : expected.end) - (from > -margin ? from : -margin);
        const Float4 off = block.distance - expected.distance;
        const Float4 mismatch = turned * turned * block.azimuth_information + off * off * block.distance_information;
        const Mask4 fits =
            (turned <= gate) & (turned >= -gate) & (overlap >= block.least_overlap) & (mismatch < best[k]);
        best[k] = choose(fits, mismatch, best[k]);
      }
    }
  double sum = 0.0, product = 1.0;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Float4 density =
        blocks_[k].outlier + choose(best[k] < 100.0F, blocks_[k].peak * exp_of(-0.5F * best[k]), all(0.0F));
    product *= (static_cast<double>(density[0]) * static_cast<double>(density[1])) *
               (static_cast<double>(density[2]) * static_cast<double>(density[3]));
    if (product > 1e-200 && product < 1e200) continue;
    sum += std::log(product);
    product = 1.0;
  }
  return config_.plane_weight * (sum + std::log(product));
}

}  // namespace plumbline::slam
