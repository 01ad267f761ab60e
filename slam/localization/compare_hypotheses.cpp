// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/compare_hypotheses.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

namespace {

/// The plan is cast no farther than this beyond a return: the residual is at its cap there.
constexpr float cast_beyond_m = 2.0F;

PlanRay ray_of(const PredictedScan& predicted, const LocalizationScan& scan, const BeamGridBlock& block,
               std::size_t k) {
  return {predicted.sensor_I, predicted.R_IH * Eigen::Vector2d(block.x[k], block.y[k]),
          predicted.storey->floor_z + scan.sensor_height, block.slope[k]};
}

/// How far to cast beams: a little beyond the return, no farther than floor and ceiling.
Float4 reach_of(const BeamGridBlock& block, const StoreyIndex& storey, const LocalizationScan& scan) {
  const auto height = static_cast<float>(scan.sensor_height),
             above = static_cast<float>(storey.ceiling_z - storey.floor_z - scan.sensor_height);
  const Float4 beyond = block.range + cast_beyond_m;
  const Float4 end =
      choose(block.slope < 0.0F, -height / block.slope, choose(block.slope > 0.0F, above / block.slope, beyond));
  const Float4 reach = choose(end < beyond, end, beyond);
  return choose(reach > 0.0F, reach, all(0.0F));
}

/// Casts beam k by itself.
void cast_beam(const LocalizationScan& scan, const BeamGridBlock& block, std::size_t k, double reach,
               const PredictedScan& predicted, PredictedBlock& hits) {
  const StoreyIndex& storey = *predicted.storey;
  const PlanRay ray = ray_of(predicted, scan, block, k);
  const PlanHit hit = storey.grid.cast(storey.segments, ray, reach, predicted.cell);
  hits.expected[k] = static_cast<float>(hit.distance);
  hits.segment[k] = hit.segment;
  hits.incidence[k] =
      hit.segment < 0
          ? 1.0F
          : static_cast<float>(std::abs(storey.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction)));
}

/// Of four beams in I.
struct Directions {
  Float4 x, y;
};

Directions directions_of(const BeamGridBlock& block, const PredictedScan& predicted) {
  const auto c = static_cast<float>(predicted.R_IH(0, 0)), s = static_cast<float>(predicted.R_IH(1, 0));
  return {c * block.x - s * block.y, s * block.x + c * block.y};
}

/// Azimuth bin of each beam.
Mask4 azimuth_bins_of(const Directions& directions) {
  const auto& [x, y] = directions;
  const Float4 p = y / (choose(x < 0.0F, -x, x) + choose(y < 0.0F, -y, y));
  const Float4 turn = choose(x < 0.0F, 2.0F - p, choose(y < 0.0F, 4.0F + p, p));
  const Float4 bin = turn * static_cast<float>(RayCandidateTable::azimuth_bins_per_quadrant);
  const Float4 last = all(static_cast<float>(RayCandidateTable::azimuth_bins_per_turn - 1));
  return __builtin_convertvector(choose(bin < last, bin, last), Mask4);
}

/// Casts the beams of a block that lie in one azimuth bin, and keeps the hits of those in `wanted`.
void cast_beams(const LocalizationScan& scan, const BeamGridBlock& block, const Directions& directions, int bin,
                int wanted, Float4 reach, const PredictedScan& predicted, PredictedBlock& hits) {
  const StoreyIndex& storey = *predicted.storey;
  const Float4 px = all(static_cast<float>(predicted.sensor_I.x())),
               py = all(static_cast<float>(predicted.sensor_I.y()));
  const auto z = static_cast<float>(storey.floor_z + scan.sensor_height);
  PredictedBlock found{reach, all(1.0F), {-1, -1, -1, -1}};
  const RayCandidateTable::Entry* entry = storey.grid.ray_candidates().list(predicted.cell, bin);
  const auto open = [&] { return lanes(found.expected >= entry->from) & wanted; };
  for (; open() != 0 && entry->segment >= 0; ++entry) {
    const FaceSectors::Intersection meeting = storey.sectors.intersect(
        storey.sectors.face(entry->segment), px, py, z, directions.x, directions.y, block.slope, found.expected);
    found.expected = choose(meeting.hit, meeting.t, found.expected);
    found.incidence = choose(meeting.hit, meeting.across, found.incidence);
    found.segment = meeting.hit ? Mask4{entry->segment, entry->segment, entry->segment, entry->segment} : found.segment;
  }
  const Mask4 taken = (Mask4{wanted, wanted, wanted, wanted} & Mask4{1, 2, 4, 8}) != 0;
  hits.expected = choose(taken, found.expected, hits.expected);
  hits.incidence = choose(taken, choose(found.incidence < 0.0F, -found.incidence, found.incidence), hits.incidence);
  hits.segment = taken ? found.segment : hits.segment;
  const int beyond = entry->segment < 0 ? open() : 0;
  for (std::size_t k = 0; beyond != 0 && k < 4; ++k)
    if ((beyond & (1 << k)) != 0) cast_beam(scan, block, k, static_cast<double>(reach[k]), predicted, hits);
}

/// Negative log-likelihood of ranges where the plan predicts `hits`.
Float4 cost(Float4 range, const PredictedBlock& hits, const HypothesisComparisonConfig& config) {
  const Float4 e = (range - hits.expected) * hits.incidence * static_cast<float>(1.0 / config.sigma_m);
  const Float4 squares = 0.5F * e * e;
  const Float4 cap =
      choose(e > 0.0F, all(static_cast<float>(config.max_nll_long)), all(static_cast<float>(config.max_nll_short)));
  return choose(squares < cap, squares, cap);
}

/// How many columns to either side may explain a beam, as an edge of the plan may be a little off.
Float4 edge_tolerance_columns(Float4 range, int columns, const HypothesisComparisonConfig& config) {
  const auto per_rad = static_cast<float>(columns / (2.0 * std::numbers::pi));
  const Float4 beams =
      whole_of((static_cast<float>(config.edge_m) / range + static_cast<float>(config.edge_rad)) * per_rad);
  const int half_turn = columns / 2;
  const auto most = static_cast<float>(half_turn);
  return choose(beams > 1.0F, choose(beams < most, beams, all(most)), all(1.0F));
}

/// Cost of the beams of block i, each by the best prediction among it and its neighbours on the ring.
Float4 beam_cost(const LocalizationScan& scan, const PredictedScan& predicted, std::size_t i,
                 const HypothesisComparisonConfig& config) {
  if (predicted.cost[i][0] >= 0.0F) return predicted.cost[i];
  const int columns = scan.beam_grid.columns, column = static_cast<int>(i) % columns,
            first = static_cast<int>(i) - column;
  const Float4 range = scan.beam_grid.blocks[i].range;
  const Float4 most = choose(range > 0.0F, edge_tolerance_columns(range, columns, config), all(0.0F));
  Float4 best = cost(range, predicted.blocks[i], config);
  for (int shift = 1;; ++shift) {
    const Mask4 near = most >= static_cast<float>(shift);
    if (lanes(near) == 0) break;
    const int before = column - shift, after = column + shift;
    for (const int neighbour : {before < 0 ? before + columns : before, after >= columns ? after - columns : after}) {
      const auto k = static_cast<std::size_t>(first + neighbour);
      const Float4 other = cost(range, predicted.blocks[k], config);
      best = choose(near & (scan.beam_grid.blocks[k].range > 0.0F) & (other < best), other, best);
    }
  }
  return predicted.cost[i] = best;
}

/// The beam ends at a leaf or pane in an opening of the plan, which is no evidence about the pose.
bool ends_in_opening(const PredictedScan& predicted, const PlanRay& ray, double range,
                     const HypothesisComparisonConfig& config) {
  return predicted.storey->grid.crosses_opening(predicted.storey->segments, ray, range - config.opening_depth_m,
                                                range + config.sigma_m, predicted.cell);
}

OutlierCause cause_of(const PredictedScan& predicted, const PlanRay& ray, double range, int segment, double expected,
                      const HypothesisComparisonConfig& config) {
  if (segment < 0) {
    const Eigen::Vector2d cell = ((ray.origin + range * ray.direction) / config.clutter_cell_m).array().floor();
    return {OutlierCause::Kind::unplanned, static_cast<int>(cell.x()), static_cast<int>(cell.y())};
  }
  if (expected >= range) return {OutlierCause::Kind::in_front_of_face, segment};
  return {OutlierCause::Kind::not_built, predicted.storey->segments[static_cast<std::size_t>(segment)].element};
}

/// Sums the evidence of neighbouring beams for one cause before the cause is looked up.
class EvidenceAccumulator {
 public:
  explicit EvidenceAccumulator(EvidenceByCause& evidence) : evidence_(evidence) {}
  ~EvidenceAccumulator() { flush(); }
  EvidenceAccumulator(const EvidenceAccumulator&) = delete;
  EvidenceAccumulator(EvidenceAccumulator&&) = delete;
  EvidenceAccumulator& operator=(const EvidenceAccumulator&) = delete;
  EvidenceAccumulator& operator=(EvidenceAccumulator&&) = delete;

  void add(const OutlierCause& cause, double log_likelihood) {
    if (cause != cause_) flush();
    cause_ = cause;
    sum_ += log_likelihood;
  }

 private:
  void flush() {
    if (sum_ > 0.0) evidence_.add(cause_, sum_);
    sum_ = 0.0;
  }
  EvidenceByCause& evidence_;
  OutlierCause cause_;
  double sum_ = 0.0;
};

}  // namespace

PredictedScan predict_scan(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                           const HypothesisComparisonConfig& config) {
  const std::vector<BeamGridBlock>& blocks = scan.beam_grid.blocks;
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * scan.sensor_H + X_IH.t;
  PredictedScan predicted{&storey,
                          R_IH,
                          sensor_I,
                          storey.grid.cell_at(sensor_I),
                          std::vector<PredictedBlock>(blocks.size()),
                          std::vector<Float4>(blocks.size(), all(-1.0F))};
  const bool listed = predicted.cell >= 0 && !storey.sectors.empty();
  const Float4 least = all(static_cast<float>(config.min_incidence));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    PredictedBlock& hits = predicted.blocks[i];
    int wanted = lanes(blocks[i].range > 0.0F);
    if (wanted == 0) continue;
    const Float4 reach = reach_of(blocks[i], storey, scan);
    const Directions directions = directions_of(blocks[i], predicted);
    const Mask4 bins = azimuth_bins_of(directions);
    while (wanted != 0) {
      const auto k = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(wanted)));
      const int together = listed ? wanted & lanes(bins == bins[k]) : 1 << k;
      if (listed)
        cast_beams(scan, blocks[i], directions, bins[k], together, reach, predicted, hits);
      else
        cast_beam(scan, blocks[i], k, static_cast<double>(reach[k]), predicted, hits);
      wanted &= ~together;
    }
    hits.incidence = choose(hits.incidence > least, hits.incidence, least);
  }
  return predicted;
}

void EvidenceByCause::add(const EvidenceByCause& more, double scale) {
  for (const auto& [cause, sum] : more.sums_) sums_[cause] += scale * sum;
}

double EvidenceByCause::total(double cap) const {
  double sum = 0.0;
  for (const auto& [cause, one] : sums_) sum += std::min(one, cap);
  return sum;
}

PairwiseLikelihoodRatio compare_hypotheses(const LocalizationScan& scan, const PredictedScan& a, const PredictedScan& b,
                                           const HypothesisComparisonConfig& config) {
  PairwiseLikelihoodRatio result;
  {
    EvidenceAccumulator against_a(result.against_a), against_b(result.against_b);
    for (std::size_t i = 0; i < scan.beam_grid.blocks.size(); ++i) {
      const BeamGridBlock& block = scan.beam_grid.blocks[i];
      const PredictedBlock &at_a = a.blocks[i], &at_b = b.blocks[i];
      const Float4 difference = at_a.expected - at_b.expected;
      const Float4 apart = choose(difference < 0.0F, -difference, difference) *
                           choose(at_a.incidence > at_b.incidence, at_a.incidence, at_b.incidence);
      const int informative = lanes((block.range > 0.0F) & (apart > static_cast<float>(config.gate_m)));
      if (informative == 0) continue;
      const Float4 gains = beam_cost(scan, b, i, config) - beam_cost(scan, a, i, config);
      for (std::size_t k = 0; k < 4; ++k) {
        const double gain = config.weight * static_cast<double>(gains[k]);
        if ((informative & (1 << k)) == 0 || gain == 0.0) continue;
        const PredictedScan& worse = gain > 0.0 ? b : a;
        const double range = block.range[k], expected = worse.blocks[i].expected[k];
        const PlanRay ray = ray_of(worse, scan, block, k);
        if (expected > range && ends_in_opening(worse, ray, range, config)) continue;
        const OutlierCause cause = cause_of(worse, ray, range, worse.blocks[i].segment[k], expected, config);
        (gain > 0.0 ? against_b : against_a).add(cause, std::abs(gain));
        result.ratio += gain;
      }
    }
  }
  return result;
}

}  // namespace plumbline::slam
