// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/compare_hypotheses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "slam/localization/outlier_cause.h"

namespace plumbline::slam {

namespace {

PlanRay ray_of(const PredictedScan& predicted, const LocalizationScan& scan, const BeamGridBlock& block,
               std::size_t k) {
  return {predicted.sensor_I, predicted.R_IH * Eigen::Vector2d(block.x[k], block.y[k]),
          predicted.floor_z + scan.sensor_height, block.slope[k]};
}

/// The beam ends at a leaf or pane in an opening of the plan, which is no evidence about the pose.
bool ends_in_opening(const PredictedScan& predicted, const PlanRay& ray, double range,
                     const HypothesisComparisonConfig& config) {
  return predicted.storey->grid.crosses_opening(predicted.storey->segments, ray, range - config.opening_depth_m,
                                                range + config.sigma_m, predicted.cell);
}

/// The beam ends where the plan has furniture. It may stand there still, so that this is no evidence against the pose;
/// as it may have moved, it is none for it either.
bool ends_at_planned_furniture(const PredictedScan& predicted, const PlanRay& ray, double range,
                               const HypothesisComparisonConfig& config) {
  const Structure* furniture = predicted.storey->furniture.get();
  if (furniture == nullptr) return false;
  // Beside, above and below it, too: a pose that is a little off sees its edges elsewhere.
  const double off = config.planned_furniture_m / range;
  const Eigen::Vector2d left = Eigen::Rotation2Dd(off) * ray.direction,
                        right = Eigen::Rotation2Dd(-off) * ray.direction;
  const std::array<SensorRay, 5> rays = {{{ray.direction, ray.slope},
                                          {left, ray.slope},
                                          {right, ray.slope},
                                          {ray.direction, ray.slope + off},
                                          {ray.direction, ray.slope - off}}};
  std::array<StructureHit, 5> hits;
  const double longest =
      (range + cast_beyond_m) * std::sqrt(1.0 + (std::abs(ray.slope) + off) * (std::abs(ray.slope) + off));
  furniture->cast({ray.origin.x(), ray.origin.y(), ray.z}, rays, longest, hits);
  return std::any_of(hits.begin(), hits.end(), [&](const StructureHit& hit) {
    if (hit.element < 0) return false;
    const double incidence = hit.upright ? std::max(std::abs(hit.n.dot(ray.direction)), config.min_incidence) : 1.0;
    return std::abs(range - hit.distance) * incidence <= config.planned_furniture_m;
  });
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

  void add(const OutlierCause& cause, double log_likelihood, const Eigen::Vector2d& end_I, bool passes_wall = false,
           double before_m = 0.0) {
    if (cause != cause_) flush();
    cause_ = cause;
    sum_.log_likelihood += log_likelihood;
    if (passes_wall) sum_.passed += log_likelihood;
    sum_.before_m += log_likelihood * before_m;
    sum_.before_m2 += log_likelihood * before_m * before_m;
    sum_.within.extend(end_I);
    sum_.ends += log_likelihood * end_I;
    sum_.ends2 += log_likelihood * end_I * end_I.transpose();
  }

 private:
  void flush() {
    if (sum_.log_likelihood > 0.0) evidence_.add(cause_, sum_);
    sum_ = {};
  }
  EvidenceByCause& evidence_;
  OutlierCause cause_;
  EvidenceByCause::Sum sum_;
};

/// Adds to each object of `against` what ends next to it and is too short at the better pose, too: furniture is seldom
/// as large as the plan's element that it is taken for.
void add_unexplained(const LocalizationScan& scan, const PredictedScan& better, const PredictedScan& worse,
                     const HypothesisComparisonConfig& config, EvidenceByCause& against) {
  std::vector<std::pair<Eigen::AlignedBox2d, EvidenceByCause::Sum*>> objects;
  for (auto& [cause, sum] : against.sums()) {
    const bool is_object =
        cause.kind == OutlierCause::Kind::in_front_of_face || cause.kind == OutlierCause::Kind::unplanned;
    if (!is_object || sum.within.isEmpty()) continue;
    const Eigen::Vector2d gap = Eigen::Vector2d::Constant(config.outline_gap_m);
    objects.push_back({{sum.within.min() - gap, sum.within.max() + gap}, &sum});
  }
  if (objects.empty()) return;
  constexpr double no_fit = 0.75;  // of the largest cost
  for (std::size_t i = 0; i < scan.beam_grid.blocks.size(); ++i) {
    const BeamGridBlock& block = scan.beam_grid.blocks[i];
    const int short_of_face = lanes((block.range > 0.0F) & (block.range < better.blocks[i].expected));
    if (short_of_face == 0) continue;
    const Float4 costs = beam_cost(scan, better, i, config);
    for (std::size_t k = 0; k < 4; ++k) {
      const double range = block.range[k], at_better = costs[k];
      if ((short_of_face & (1 << k)) == 0 || at_better < no_fit * config.max_nll_short) continue;
      const Eigen::Vector2d end = worse.sensor_I + worse.R_IH * (range * Eigen::Vector2d(block.x[k], block.y[k]));
      // What is near two of them is near one object, see EvidenceByCause::total.
      const auto object =
          std::find_if(objects.begin(), objects.end(), [&](const auto& each) { return each.first.contains(end); });
      if (object == objects.end()) continue;
      if (ends_at_planned_furniture(better, ray_of(better, scan, block, k), range, config)) continue;
      object->second->unexplained += config.weight * at_better;
    }
  }
}

/// Adds to each element of `against` that beams pass what meets it where the worse pose has it: a wall with a door
/// elsewhere is not missing.
void add_met(const LocalizationScan& scan, const PredictedScan& worse, const HypothesisComparisonConfig& config,
             EvidenceByCause& against) {
  std::vector<std::pair<int, EvidenceByCause::Sum*>> elements;
  for (auto& [cause, sum] : against.sums())
    if (cause.kind == OutlierCause::Kind::not_built && sum.passed > 0.0) elements.push_back({cause.x, &sum});
  if (elements.empty()) return;
  constexpr float meets = 2.0F;  // two standard deviations
  for (std::size_t i = 0; i < scan.beam_grid.blocks.size(); ++i) {
    const BeamGridBlock& block = scan.beam_grid.blocks[i];
    const Float4 costs = cost_of(block.range, worse.blocks[i], config);
    for (std::size_t k = 0; k < 4; ++k) {
      if (block.range[k] <= 0.0F || costs[k] >= std::min(meets, static_cast<float>(config.max_nll_short))) continue;
      for (auto& [element, sum] : elements)
        if (worse.blocks[i].element[k] == element) sum->met += config.weight * config.max_nll_long;
    }
  }
}

}  // namespace

PairwiseLikelihoodRatio compare_hypotheses(const LocalizationScan& scan, const PredictedScan& a, const PredictedScan& b,
                                           const HypothesisComparisonConfig& config) {
  PairwiseLikelihoodRatio result;
  {
    EvidenceAccumulator against_a(result.against_a), against_b(result.against_b);
    EvidenceAccumulator ends_a(result.against_a), ends_b(result.against_b);
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
        if (expected > range &&
            (ends_in_opening(worse, ray, range, config) || ends_at_planned_furniture(worse, ray, range, config)))
          continue;
        const ExplainedOutlier outlier =
            explain_outlier(*worse.storey->structure, ray, range, worse.blocks[i], k, config);
        const Eigen::Vector2d end_I = ray.origin + range * ray.direction;
        const double each = (outlier.object ? 0.5 : 1.0) * std::abs(gain);
        const double before_m = (expected - range) * static_cast<double>(worse.blocks[i].incidence[k]);
        (gain > 0.0 ? against_b : against_a).add(outlier.cause, each, end_I, outlier.passes_wall, before_m);
        if (outlier.object) (gain > 0.0 ? ends_b : ends_a).add(*outlier.object, each, end_I);
        result.ratio += gain;
      }
    }
  }
  add_unexplained(scan, b, a, config, result.against_a);
  add_unexplained(scan, a, b, config, result.against_b);
  add_met(scan, a, config, result.against_a);
  add_met(scan, b, config, result.against_b);
  return result;
}

}  // namespace plumbline::slam
