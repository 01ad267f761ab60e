// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/place_index.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "bim/errors.h"
#include "scenarios/host/parallel.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_places = std::size_t{1} << 18U;
constexpr std::size_t level_ring = 4;  ///< the ring at +1 degree
constexpr double floor_seen_m = 5.0;   ///< a ray of the lowest ring hits the floor nearer than this

struct Seed {
  double cost = 0.0;
  std::size_t place = 0;
  int turn = 0;
};

/// Mean difference of sorted ranges, m.
double quantile_difference(const Signature& a, const Signature& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.quantiles_m.size(); ++i)
    sum += std::abs(static_cast<double>(a.quantiles_m[i]) - static_cast<double>(b.quantiles_m[i]));
  return sum / static_cast<double>(a.quantiles_m.size());
}

/// Mean difference of the level rings where `candidate` is turned by so many beams, m; more than `limit` when larger.
double level_difference(const Signature& seen, const Signature& candidate, std::size_t turn, double limit) {
  constexpr auto cap = static_cast<float>(localizability_constants.like_level_cap_m);
  const std::size_t n = seen.level_m.size();
  const double most = limit * static_cast<double>(n);
  double sum = 0.0;
  for (std::size_t a = 0; a < n && sum <= most; ++a) {
    const std::size_t b = a + turn < n ? a + turn : a + turn - n;
    sum += static_cast<double>(std::min(std::abs(seen.level_m[a] - candidate.level_m[b]), cap));
  }
  return sum / static_cast<double>(n);
}

/// Headings at which the candidate fits better than at their neighbours, best first.
void add_headings(const Signature& seen, const Signature& candidate, std::size_t place, bool yaw_known,
                  std::vector<Seed>& seeds) {
  const auto n = static_cast<int>(seen.level_m.size());
  const int span = yaw_known ? static_cast<int>(localizability_constants.known_yaw_deg) * n / 360 : n / 2;
  std::vector<Seed> found;
  for (int turn = -span; turn <= (yaw_known ? span : span - 1); ++turn) {
    const double cost = level_difference(seen, candidate, static_cast<std::size_t>(turn < 0 ? turn + n : turn),
                                         localizability_constants.like_level_m);
    if (cost <= localizability_constants.like_level_m) found.push_back({cost, place, turn});
  }
  std::stable_sort(found.begin(), found.end(), [](const Seed& a, const Seed& b) { return a.cost < b.cost; });
  int kept = 0;
  std::vector<int> turns;
  for (const Seed& seed : found) {
    const bool beside = std::any_of(turns.begin(), turns.end(), [&](int other) {
      const int apart = std::abs(seed.turn - other);
      return std::min(apart, n - apart) <= 2;
    });
    if (beside) continue;
    turns.push_back(seed.turn);
    seeds.push_back(seed);
    if (++kept == localizability_constants.headings_a_place) return;
  }
}

std::vector<std::pair<int, Eigen::Vector3d>> grid_of(const std::vector<SearchArea>& storeys, double spacing_m) {
  std::vector<std::pair<int, Eigen::Vector3d>> grid;
  for (std::size_t i = 0; i < storeys.size(); ++i) {
    const SearchArea& s = storeys[i];
    const Eigen::Vector2d size = (s.max - s.min).cwiseMax(0.0) / spacing_m;
    if (size.x() * size.y() + static_cast<double>(grid.size()) > static_cast<double>(most_places))
      throw InputError({"identify", 0, 0}, "a storey of " + std::to_string(std::lround(s.max.x() - s.min.x())) + " x " +
                                               std::to_string(std::lround(s.max.y() - s.min.y())) +
                                               " m has too many places; it must be smaller");
    const std::vector<double> ys = s.lines(1, spacing_m);
    for (const double x : s.lines(0, spacing_m))
      for (const double y : ys) grid.emplace_back(static_cast<int>(i), Eigen::Vector3d(x, y, s.sensor_z_W({x, y})));
  }
  return grid;
}

}  // namespace

Signature signature_of(const RangeImager& imager, const bim::RayScene& scene, const Eigen::Vector3d& p_W) {
  const std::vector<double> ranges = imager.cast(scene, {p_W, 0.0}).range_m;
  const auto n = static_cast<std::size_t>(imager.azimuths());
  Signature signature;
  signature.standable = std::any_of(ranges.begin(), ranges.begin() + static_cast<std::ptrdiff_t>(n),
                                    [](double r) { return r < floor_seen_m; });
  for (std::size_t a = 0; a < n; ++a) {
    const double r = ranges[level_ring * n + a];
    if (r < localizability_constants.min_clearance_m) signature.standable = false;
    signature.level_m.push_back(static_cast<float>(std::min(r, localizability_constants.signature_range_m)));
  }
  std::vector<double> sorted = ranges;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t count = signature.quantiles_m.size();
  for (std::size_t i = 0; i < count; ++i)
    signature.quantiles_m[i] = static_cast<float>(
        std::min(sorted[(2 * i + 1) * sorted.size() / (2 * count)], localizability_constants.signature_range_m));
  return signature;
}

PlaceIndex::PlaceIndex(const bim::RayScene& plan, std::vector<SearchArea> storeys, double spacing_m, int threads)
    : storeys_(std::move(storeys)), imager_(localizability_constants.signature_azimuths) {
  const auto grid = grid_of(storeys_, spacing_m);
  beams_ = grid.size() * imager_.directions().size();
  std::vector<Entry> all(grid.size());
  for_each_index(grid.size(), threads, [&](std::size_t i) {
    all[i] = {grid[i].first, grid[i].second, signature_of(imager_, plan, grid[i].second)};
  });
  for (Entry& entry : all)
    if (entry.signature.standable) places_.push_back(std::move(entry));
}

std::vector<LikePlace> PlaceIndex::like(const Signature& seen, double yaw, int storey, bool yaw_known) const {
  std::vector<Seed> seeds;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (storey >= 0 && places_[i].storey != storey) continue;
    if (quantile_difference(seen, places_[i].signature) > localizability_constants.like_quantiles_m) continue;
    add_headings(seen, places_[i].signature, i, yaw_known, seeds);
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return std::tie(a.cost, a.place, a.turn) < std::tie(b.cost, b.place, b.turn);
  });
  if (seeds.size() > static_cast<std::size_t>(localizability_constants.max_seeds))
    seeds.resize(static_cast<std::size_t>(localizability_constants.max_seeds));
  std::vector<LikePlace> candidates;
  const double beam = 2.0 * std::numbers::pi / imager_.azimuths();
  for (const Seed& seed : seeds) {
    const Entry& entry = places_[seed.place];
    candidates.push_back({{entry.p_W, wrap_angle(yaw + seed.turn * beam)}, entry.storey});
  }
  return candidates;
}

}  // namespace plumbline::scenarios
