// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/compare_hypotheses.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

namespace {

/// Farther than this beyond a return the plan is not looked at: the beam has long gone through.
constexpr float look_beyond_m = 2.0F;

PlanRay ray_of(const Sight& sight, const View& view, const SweepBlock& block, std::size_t k) {
  return {sight.sensor_I, sight.R_IH * Eigen::Vector2d(block.x[k], block.y[k]),
          sight.storey->floor_z + view.sensor_height, block.slope[k]};
}

/// How far along beams to look: a little beyond the return, no farther than floor and ceiling.
Float4 reach_of(const SweepBlock& block, const StoreyIndex& storey, const View& view) {
  const auto height = static_cast<float>(view.sensor_height),
             above = static_cast<float>(storey.ceiling_z - storey.floor_z - view.sensor_height);
  const Float4 beyond = block.range + look_beyond_m;
  const Float4 end =
      choose(block.slope < 0.0F, -height / block.slope, choose(block.slope > 0.0F, above / block.slope, beyond));
  const Float4 reach = choose(end < beyond, end, beyond);
  return choose(reach > 0.0F, reach, all(0.0F));
}

/// Looks along beam k by itself.
void look(const View& view, const SweepBlock& block, std::size_t k, double reach, const Sight& sight,
          SightBlock& seen) {
  const StoreyIndex& storey = *sight.storey;
  const PlanRay ray = ray_of(sight, view, block, k);
  const PlanHit hit = storey.grid.cast(storey.segments, ray, reach, sight.cell);
  seen.expected[k] = static_cast<float>(hit.distance);
  seen.segment[k] = hit.segment;
  seen.incidence[k] =
      hit.segment < 0
          ? 1.0F
          : static_cast<float>(std::abs(storey.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction)));
}

/// Of four beams in I.
struct Directions {
  Float4 x, y;
};

Directions directions_of(const SweepBlock& block, const Sight& sight) {
  const auto c = static_cast<float>(sight.R_IH(0, 0)), s = static_cast<float>(sight.R_IH(1, 0));
  return {c * block.x - s * block.y, s * block.x + c * block.y};
}

/// Range of directions of FirstFaces of each beam.
Mask4 fans_of(const Directions& directions) {
  const auto& [x, y] = directions;
  const Float4 p = y / (choose(x < 0.0F, -x, x) + choose(y < 0.0F, -y, y));
  const Float4 turn = choose(x < 0.0F, 2.0F - p, choose(y < 0.0F, 4.0F + p, p));
  const Float4 fan = turn * static_cast<float>(FirstFaces::fans_per_quadrant);
  const Float4 last = all(static_cast<float>(FirstFaces::fans_per_turn - 1));
  return __builtin_convertvector(choose(fan < last, fan, last), Mask4);
}

/// Looks along the beams of a block that lie in one range of directions, and takes in those of `wanted`.
void look(const View& view, const SweepBlock& block, const Directions& directions, int fan, int wanted, Float4 reach,
          const Sight& sight, SightBlock& seen) {
  const StoreyIndex& storey = *sight.storey;
  const Float4 px = all(static_cast<float>(sight.sensor_I.x())), py = all(static_cast<float>(sight.sensor_I.y()));
  const auto z = static_cast<float>(storey.floor_z + view.sensor_height);
  SightBlock found{reach, all(1.0F), {-1, -1, -1, -1}};
  const FirstFaces::Entry* entry = storey.grid.first_faces().list(sight.cell, fan);
  const auto open = [&] { return lanes(found.expected >= entry->from) & wanted; };
  for (; open() != 0 && entry->segment >= 0; ++entry) {
    const FaceSectors::Meeting met = storey.sectors.meet(storey.sectors.face(entry->segment), px, py, z, directions.x,
                                                         directions.y, block.slope, found.expected);
    found.expected = choose(met.hit, met.t, found.expected);
    found.incidence = choose(met.hit, met.across, found.incidence);
    found.segment = met.hit ? Mask4{entry->segment, entry->segment, entry->segment, entry->segment} : found.segment;
  }
  const Mask4 taken = (Mask4{wanted, wanted, wanted, wanted} & Mask4{1, 2, 4, 8}) != 0;
  seen.expected = choose(taken, found.expected, seen.expected);
  seen.incidence = choose(taken, choose(found.incidence < 0.0F, -found.incidence, found.incidence), seen.incidence);
  seen.segment = taken ? found.segment : seen.segment;
  const int beyond = entry->segment < 0 ? open() : 0;
  for (std::size_t k = 0; beyond != 0 && k < 4; ++k)
    if ((beyond & (1 << k)) != 0) look(view, block, k, static_cast<double>(reach[k]), sight, seen);
}

/// Negative log-likelihood of ranges where the plan has `seen`.
Float4 cost(Float4 range, const SightBlock& seen, const ContestConfig& config) {
  const Float4 e = (range - seen.expected) * seen.incidence * static_cast<float>(1.0 / config.sigma_m);
  const Float4 squares = 0.5F * e * e;
  const Float4 cap =
      choose(e > 0.0F, all(static_cast<float>(config.long_cap)), all(static_cast<float>(config.short_cap)));
  return choose(squares < cap, squares, cap);
}

/// How many beams to either side may stand for one, as an edge of the plan may stand a little aside.
Float4 aside(Float4 range, int columns, const ContestConfig& config) {
  const auto per_rad = static_cast<float>(columns / (2.0 * std::numbers::pi));
  const Float4 beams =
      whole_of((static_cast<float>(config.edge_m) / range + static_cast<float>(config.edge_rad)) * per_rad);
  const int half_turn = columns / 2;
  const auto most = static_cast<float>(half_turn);
  return choose(beams > 1.0F, choose(beams < most, beams, all(most)), all(1.0F));
}

/// Cost of the beams of block i, each by the best of what it and its neighbours on the ring should meet.
Float4 beam_cost(const View& view, const Sight& sight, std::size_t i, const ContestConfig& config) {
  if (sight.cost[i][0] >= 0.0F) return sight.cost[i];
  const int columns = view.sweep.columns, column = static_cast<int>(i) % columns, first = static_cast<int>(i) - column;
  const Float4 range = view.sweep.blocks[i].range;
  const Float4 most = choose(range > 0.0F, aside(range, columns, config), all(0.0F));
  Float4 best = cost(range, sight.blocks[i], config);
  for (int shift = 1;; ++shift) {
    const Mask4 near = most >= static_cast<float>(shift);
    if (lanes(near) == 0) break;
    const int before = column - shift, after = column + shift;
    for (const int neighbour : {before < 0 ? before + columns : before, after >= columns ? after - columns : after}) {
      const auto k = static_cast<std::size_t>(first + neighbour);
      const Float4 other = cost(range, sight.blocks[k], config);
      best = choose(near & (view.sweep.blocks[k].range > 0.0F) & (other < best), other, best);
    }
  }
  return sight.cost[i] = best;
}

/// The beam ends at a leaf or pane in an opening of the plan, which says nothing of the place.
bool ends_in_opening(const Sight& sight, const PlanRay& ray, double range, const ContestConfig& config) {
  return sight.storey->grid.crosses_opening(sight.storey->segments, ray, range - config.opening_depth_m,
                                            range + config.sigma_m, sight.cell);
}

Cause cause_of(const Sight& sight, const PlanRay& ray, double range, int segment, double expected,
               const ContestConfig& config) {
  if (segment < 0) {
    const Eigen::Vector2d cell = ((ray.origin + range * ray.direction) / config.thing_m).array().floor();
    return {Cause::Kind::unplanned, static_cast<int>(cell.x()), static_cast<int>(cell.y())};
  }
  if (expected >= range) return {Cause::Kind::before_face, segment};
  return {Cause::Kind::not_built, sight.storey->segments[static_cast<std::size_t>(segment)].element};
}

/// Adds up what neighbouring beams say of one cause before it is looked up.
class Tally {
 public:
  explicit Tally(Objections& objections) : objections_(objections) {}
  ~Tally() { flush(); }
  Tally(const Tally&) = delete;
  Tally(Tally&&) = delete;
  Tally& operator=(const Tally&) = delete;
  Tally& operator=(Tally&&) = delete;

  void add(const Cause& cause, double log_likelihood) {
    if (cause != cause_) flush();
    cause_ = cause;
    sum_ += log_likelihood;
  }

 private:
  void flush() {
    if (sum_ > 0.0) objections_.add(cause_, sum_);
    sum_ = 0.0;
  }
  Objections& objections_;
  Cause cause_;
  double sum_ = 0.0;
};

}  // namespace

Sight sight(const StoreyIndex& storey, const Pose2& X_IH, const View& view, const ContestConfig& config) {
  const std::vector<SweepBlock>& sweep = view.sweep.blocks;
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * view.sensor_H + X_IH.t;
  Sight sight{&storey,
              R_IH,
              sensor_I,
              storey.grid.cell_at(sensor_I),
              std::vector<SightBlock>(sweep.size()),
              std::vector<Float4>(sweep.size(), all(-1.0F))};
  const bool listed = sight.cell >= 0 && !storey.sectors.empty();
  const Float4 least = all(static_cast<float>(config.min_incidence));
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    SightBlock& seen = sight.blocks[i];
    int wanted = lanes(sweep[i].range > 0.0F);
    if (wanted == 0) continue;
    const Float4 reach = reach_of(sweep[i], storey, view);
    const Directions directions = directions_of(sweep[i], sight);
    const Mask4 fans = fans_of(directions);
    while (wanted != 0) {
      const auto k = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(wanted)));
      const int together = listed ? wanted & lanes(fans == fans[k]) : 1 << k;
      if (listed)
        look(view, sweep[i], directions, fans[k], together, reach, sight, seen);
      else
        look(view, sweep[i], k, static_cast<double>(reach[k]), sight, seen);
      wanted &= ~together;
    }
    seen.incidence = choose(seen.incidence > least, seen.incidence, least);
  }
  return sight;
}

void Objections::add(const Objections& more, double scale) {
  for (const auto& [cause, sum] : more.sums_) sums_[cause] += scale * sum;
}

double Objections::total(double cap) const {
  double sum = 0.0;
  for (const auto& [cause, one] : sums_) sum += std::min(one, cap);
  return sum;
}

Contest contest(const View& view, const Sight& a, const Sight& b, const ContestConfig& config) {
  Contest result;
  {
    Tally against_a(result.against_a), against_b(result.against_b);
    for (std::size_t i = 0; i < view.sweep.blocks.size(); ++i) {
      const SweepBlock& block = view.sweep.blocks[i];
      const SightBlock &at_a = a.blocks[i], &at_b = b.blocks[i];
      const Float4 difference = at_a.expected - at_b.expected;
      const Float4 apart = choose(difference < 0.0F, -difference, difference) *
                           choose(at_a.incidence > at_b.incidence, at_a.incidence, at_b.incidence);
      const int told = lanes((block.range > 0.0F) & (apart > static_cast<float>(config.gate_m)));
      if (told == 0) continue;
      const Float4 gains = beam_cost(view, b, i, config) - beam_cost(view, a, i, config);
      for (std::size_t k = 0; k < 4; ++k) {
        const double gain = config.weight * static_cast<double>(gains[k]);
        if ((told & (1 << k)) == 0 || gain == 0.0) continue;
        const Sight& worse = gain > 0.0 ? b : a;
        const double range = block.range[k], expected = worse.blocks[i].expected[k];
        const PlanRay ray = ray_of(worse, view, block, k);
        if (expected > range && ends_in_opening(worse, ray, range, config)) continue;
        const Cause cause = cause_of(worse, ray, range, worse.blocks[i].segment[k], expected, config);
        (gain > 0.0 ? against_b : against_a).add(cause, std::abs(gain));
        result.ratio += gain;
      }
    }
  }
  return result;
}

}  // namespace plumbline::slam
