// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/predicted_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace plumbline::slam {

namespace {

/// Cost of a beam that needs no other explanation: a standard deviation.
constexpr float fits = 0.5F;
/// Neighbouring beams of a ring that are cast one after another.
constexpr std::size_t columns_together = 8;
/// Rays cast in one call, so that their memory stays near.
constexpr std::size_t rays_together = 256;

/// How far to cast to see beyond every return.
double ray_length(const std::vector<BeamGridBlock>& blocks) {
  Float4 range = all(0.0F), steepness = all(0.0F);
  for (const BeamGridBlock& block : blocks) {
    const Float4 squares = block.slope * block.slope;
    range = choose(block.range > range, block.range, range);
    steepness = choose(squares > steepness, squares, steepness);
  }
  double farthest = 0.0, steepest = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    farthest = std::max(farthest, static_cast<double>(range[k]));
    steepest = std::max(steepest, static_cast<double>(steepness[k]));
  }
  return (farthest + cast_beyond_m) * std::sqrt(1.0 + steepest);
}

/// Eighth of a turn that a normal points to.
int side_of(const Eigen::Vector2d& n) {
  const int octant = static_cast<int>(2.0 * pseudo_angle(n) + 0.5);
  return octant % 8;
}

/// Takes what a ray hits over into lane k.
void take(const StructureHit& hit, const Eigen::Vector2d& direction, std::size_t k, PredictedBlock& block) {
  const auto distance = static_cast<float>(hit.distance);
  if (hit.element < 0 || distance > block.expected[k]) return;
  block.expected[k] = distance;
  if (!hit.upright) return;
  block.incidence[k] = static_cast<float>(std::abs(hit.n.dot(direction)));
  block.element[k] = hit.element;
  block.side[k] = side_of(hit.n);
}

/// How many columns to either side may explain a beam, as an edge of the plan at this distance may be a little off, and
/// as the beam began beside the place that all are cast from.
Float4 edge_tolerance_columns(Float4 distance, const BeamGridBlock& block, int columns,
                              const HypothesisComparisonConfig& config) {
  const auto per_rad = static_cast<float>(columns / (2.0 * std::numbers::pi));
  const Float4 beams = whole_of((static_cast<float>(config.edge_m) / distance + static_cast<float>(config.edge_rad) +
                                 block.aside * (1.0F / distance - 1.0F / block.range)) *
                                per_rad);
  const int half_turn = columns / 2;
  const auto most = static_cast<float>(half_turn);
  return choose(beams > 1.0F, choose(beams < most, beams, all(most)), all(1.0F));
}

/// How far the face that a beam `shift` columns away hits is in the direction of the own one: the reciprocals of ranges
/// to a plane are nearly linear in the angle, and the beam behind that one hits it, too. Else the neighbour's own
/// range.
Float4 extended(const PredictedBlock& near, const PredictedBlock& behind, int shift) {
  const Float4 own = near.reciprocal + static_cast<float>(shift) * (near.reciprocal - behind.reciprocal);
  const Mask4 same = (near.element >= 0) & (near.element == behind.element) & (near.side == behind.side);
  const auto beyond = static_cast<float>(1.0 / 1000.0);
  return choose(same & (own > beyond), 1.0F / own, near.expected);
}

/// Cost of the beams of a block, each at most as given, where the sensor is tilted up or down as far as its roll and
/// pitch are uncertain: either side of a horizontal edge may be hit, as of a step, a sill or a lintel.
Float4 tilted_cost(const LocalizationScan& scan, const PredictedScan& predicted, const BeamGridBlock& block,
                   Float4 untilted, const HypothesisComparisonConfig& config) {
  const double tilt = config.edge_tilts * scan.tilt_sigma;
  const Eigen::Vector3d origin_I{predicted.sensor_I.x(), predicted.sensor_I.y(),
                                 predicted.floor_z + scan.sensor_height};
  std::array<SensorRay, 8> rays;
  std::array<StructureHit, 8> hits;
  std::array<std::size_t, 8> lane_of;
  std::size_t count = 0;
  double farthest = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (block.range[k] <= 0.0F || untilted[k] <= fits) continue;
    const Eigen::Vector2d direction = predicted.R_IH * Eigen::Vector2d(block.x[k], block.y[k]);
    const double slope = block.slope[k], steepest = std::abs(slope) + tilt;
    farthest = std::max(farthest, (block.range[k] + cast_beyond_m) * std::sqrt(1.0 + steepest * steepest));
    for (const double tilted : {slope - tilt, slope + tilt}) {
      rays[count] = {direction, tilted};
      lane_of[count++] = k;
    }
  }
  if (count == 0) return untilted;
  predicted.storey->structure->cast(origin_I, std::span(rays).first(count), farthest, std::span(hits).first(count));
  Float4 best = untilted;
  for (std::size_t r = 0; r < count; ++r) {
    const std::size_t k = lane_of[r];
    PredictedBlock tilted;
    tilted.expected[k] = block.range[k] + cast_beyond_m;
    take(hits[r], rays[r].direction, k, tilted);
    tilted.incidence[k] = std::max(tilted.incidence[k], static_cast<float>(config.min_incidence));
    best[k] = std::min(best[k], cost_of(block.range, tilted, config)[k]);
  }
  return best;
}

/// Cost of the beams of a block, each at most as given, by the faces on either side of what may be an edge, as far as
/// they go on in the beam's own direction. For beams whose neighbours on the ring gave no return and were not
/// predicted.
Float4 cost_beside(const LocalizationScan& scan, const PredictedScan& predicted, const BeamGridBlock& block,
                   int unpredicted, Float4 tolerance_columns, Float4 direct, const HypothesisComparisonConfig& config) {
  constexpr double along_face = 1e-3;
  const double rad_per_column = 2.0 * std::numbers::pi / scan.beam_grid.columns;
  const Eigen::Vector3d origin_I{predicted.sensor_I.x(), predicted.sensor_I.y(),
                                 predicted.floor_z + scan.sensor_height};
  std::array<SensorRay, 8> rays;
  std::array<StructureHit, 8> hits;
  std::array<std::size_t, 8> lane_of;
  std::array<Eigen::Vector2d, 4> own;
  std::size_t count = 0;
  double farthest = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    if ((unpredicted & (1 << k)) == 0 || direct[k] <= fits) continue;
    own[k] = predicted.R_IH * Eigen::Vector2d(block.x[k], block.y[k]);
    const double slope = block.slope[k], angle = rad_per_column * tolerance_columns[k];
    farthest = std::max(farthest, (block.range[k] + cast_beyond_m) * std::sqrt(1.0 + slope * slope));
    for (const double turned : {angle, -angle}) {
      rays[count] = {Eigen::Rotation2Dd(turned) * own[k], slope};
      lane_of[count++] = k;
    }
  }
  if (count == 0) return direct;
  predicted.storey->structure->cast(origin_I, std::span(rays).first(count), farthest, std::span(hits).first(count));
  Float4 best = direct;
  for (std::size_t r = 0; r < count; ++r) {
    const std::size_t k = lane_of[r];
    if (hits[r].element < 0 || !hits[r].upright) continue;
    const double across = hits[r].n.dot(own[k]), ratio = hits[r].n.dot(rays[r].direction) / across;
    if (std::abs(across) < along_face || ratio <= 0.0) continue;
    PredictedBlock face;
    face.expected[k] = static_cast<float>(ratio * hits[r].distance);
    face.incidence[k] = std::max(static_cast<float>(std::abs(across)), static_cast<float>(config.min_incidence));
    best[k] = std::min(best[k], cost_of(block.range, face, config)[k]);
  }
  return best;
}

}  // namespace

Float4 cost_of(Float4 range, const PredictedBlock& hits, const HypothesisComparisonConfig& config) {
  const Float4 e = (range - hits.expected) * hits.incidence * static_cast<float>(1.0 / config.sigma_m);
  const Float4 squares = 0.5F * e * e;
  const Float4 cap =
      choose(e > 0.0F, all(static_cast<float>(config.max_nll_long)), all(static_cast<float>(config.max_nll_short)));
  return choose(squares < cap, squares, cap);
}

Float4 beam_cost(const LocalizationScan& scan, const PredictedScan& predicted, std::size_t i,
                 const HypothesisComparisonConfig& config) {
  if (predicted.cost[i][0] >= 0.0F) return predicted.cost[i];
  const int columns = scan.beam_grid.columns, column = static_cast<int>(i) % columns,
            first = static_cast<int>(i) - column;
  const Float4 range = scan.beam_grid.blocks[i].range;
  // A beam that passes an edge, as a baluster's, passes it at the distance expected.
  const Float4 expected = predicted.blocks[i].expected, nearer = choose(expected < range, expected, range);
  const Float4 most =
      choose(range > 0.0F, edge_tolerance_columns(nearer, scan.beam_grid.blocks[i], columns, config), all(0.0F));
  Float4 best = cost_of(range, predicted.blocks[i], config);
  int unpredicted = 0;  // lanes with a neighbour that gave no return
  for (int shift = 1;; ++shift) {
    const Mask4 near = (most >= static_cast<float>(shift)) & (best > fits);
    if (lanes(near) == 0) break;
    const auto on_ring = [&](int of_ring) { return static_cast<std::size_t>(first + (of_ring + columns) % columns); };
    for (const int side : {-1, 1}) {
      const std::size_t k = on_ring(column + side * shift);
      const Mask4 seen = scan.beam_grid.blocks[k].range > 0.0F;
      unpredicted |= lanes(near & ~seen);
      PredictedBlock there = predicted.blocks[k];
      there.expected = extended(there, predicted.blocks[on_ring(column + side * (shift + 1))], shift);
      const Float4 other = cost_of(range, there, config);
      best = choose(near & seen & (other < best), other, best);
    }
  }
  if (unpredicted != 0) best = cost_beside(scan, predicted, scan.beam_grid.blocks[i], unpredicted, most, best, config);
  if (scan.tilt_sigma > 0.0) best = tilted_cost(scan, predicted, scan.beam_grid.blocks[i], best, config);
  return predicted.cost[i] = best;
}
PredictedScan predict_scan(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                           const HypothesisComparisonConfig& config) {
  const std::vector<BeamGridBlock>& blocks = scan.beam_grid.blocks;
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * scan.sensor_H + X_IH.t;
  PredictedScan predicted{&storey,
                          R_IH,
                          sensor_I,
                          storey.floor_at(sensor_I),
                          storey.grid.cell_at(sensor_I),
                          std::vector<PredictedBlock>(blocks.size()),
                          std::vector<Float4>(blocks.size(), all(-1.0F))};
  const Eigen::Vector3d origin_I{sensor_I.x(), sensor_I.y(), predicted.floor_z + scan.sensor_height};
  const double farthest = ray_length(blocks);
  std::array<SensorRay, rays_together> rays;
  std::array<StructureHit, rays_together> hits;
  std::array<std::pair<std::size_t, std::size_t>, rays_together> lanes_of;  // block and lane of each ray
  std::size_t count = 0;
  const auto cast = [&] {
    storey.structure->cast(origin_I, std::span(rays).first(count), farthest, std::span(hits).first(count));
    for (std::size_t r = 0; r < count; ++r)
      take(hits[r], rays[r].direction, lanes_of[r].second, predicted.blocks[lanes_of[r].first]);
    count = 0;
  };
  const auto columns = static_cast<std::size_t>(scan.beam_grid.columns);
  for (std::size_t first = 0; first < blocks.size(); first += columns)
    for (std::size_t begin = first; begin < first + columns; begin += columns_together)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = begin; i < std::min(begin + columns_together, first + columns); ++i) {
          const BeamGridBlock& block = blocks[i];
          if (block.range[k] <= 0.0F) continue;
          predicted.blocks[i].expected[k] = block.range[k] + cast_beyond_m;
          rays[count] = {R_IH * Eigen::Vector2d(block.x[k], block.y[k]), block.slope[k]};
          lanes_of[count] = {i, k};
          if (++count == rays.size()) cast();
        }
  cast();
  const Float4 least = all(static_cast<float>(config.min_incidence));
  for (PredictedBlock& block : predicted.blocks) {
    block.incidence = choose(block.incidence > least, block.incidence, least);
    block.reciprocal = 1.0F / block.expected;
  }
  return predicted;
}

double total_cost(const LocalizationScan& scan, const PredictedScan& predicted,
                  const HypothesisComparisonConfig& config) {
  double sum = 0.0;
  for (std::size_t i = 0; i < scan.beam_grid.blocks.size(); ++i) {
    const Float4 costs = beam_cost(scan, predicted, i, config);
    for (std::size_t k = 0; k < 4; ++k)
      if (scan.beam_grid.blocks[i].range[k] > 0.0F) sum += static_cast<double>(costs[k]);
  }
  return sum;
}

}  // namespace plumbline::slam
