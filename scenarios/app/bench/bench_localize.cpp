// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/load/load.h"
#include "bim/plan/plan.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/lattice.h"
#include "scenarios/run/runner.h"
#include "scenarios/spec/resolve.h"
#include "slam/io/stopwatch.h"
#include "slam/localization/global_localizer.h"
#include "slam/particles/pose_clusters.h"

namespace plumbline::scenarios {

namespace {

struct LocalizeLimits {
  double update_ms = 8.0;  ///< 5,000 particles, 8 planes
  double realtime_factor = 6.0;
  double growth_particles = 1.2;  ///< exponents
  double growth_walls = 0.5;      ///< a particle meets what is near it, however large the building
};

const std::string method = "s_graph_localization";
constexpr std::size_t planes_seen = 8;

/// What a robot would see at a pose of the plan: the walls around it and beams to them, without noise.
slam::LocalizationScan planned_scan(const slam::StoreyIndex& storey, const slam::Pose2& X_IH) {
  slam::LocalizationScan scan;
  scan.sensor_height = 0.66;
  const int cell = storey.grid.cell_at(X_IH.t);
  if (cell < 0) throw InternalError("bench: a view from outside of the plan");
  for (const int i : storey.visible[static_cast<std::size_t>(cell)]) {
    const slam::WallLine& line = storey.lines[static_cast<std::size_t>(i)];
    const double foot = line.e.dot(X_IH.t - line.a), distance = line.n.dot(X_IH.t) + line.d;
    if (distance <= 0.0 || scan.walls.size() >= planes_seen) continue;
    scan.walls.push_back(
        {wrap_angle(line.azimuth - X_IH.yaw), distance, -foot, line.length - foot, 0.002, 0.004, static_cast<int>(i)});
  }
  constexpr int beams = slam::LocalizationScanConfig{}.beams;
  for (int k = 0; k < beams; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / beams;
    slam::Beam beam{{std::cos(angle), std::sin(angle)}, 0.0, 0.05 * (k % 4)};
    const slam::PlanRay ray{X_IH.t, X_IH.rotation() * beam.direction_H, storey.floor_z + scan.sensor_height,
                            beam.slope};
    beam.range = storey.grid.cast(storey.segments, ray, 25.0).distance;
    scan.beams.push_back(beam);
  }
  return scan;
}

slam::PlanIndex index_of(const bim::Building& building) {
  return slam::make_plan_index(bim::make_plan(building), std::nullopt, {});
}

/// CPU time of one update of so many particles: motion, likelihood, clusters, resampling.
double update_ms(const slam::PlanIndex& index, int count, std::uint64_t seed) {
  const slam::GlobalLocalizerConfig config;
  const slam::StoreyIndex& storey = index.storeys.front();
  const slam::LocalizationScan scan = planned_scan(storey, {centroid(storey.rooms.front().polygon), 0.3});
  slam::FilterConfig filter = config.filter;
  filter.max_particles = count;
  filter.density_per_m2 = 1e6;
  slam::ParticleSet drawn = slam::sample_initial_particles(index, {}, scan, filter, seed, 1);
  slam::ParticleSet particles;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) particles.push_back(drawn[i % drawn.size()]);
  slam::normalise(particles);
  const slam::Stopwatch watch;
  slam::propagate(particles, {{0.2, 0.0}, 0.02}, index, filter, seed, 2);
  static_cast<void>(slam::reweight(particles, scan, index, config.likelihood, filter));
  const slam::Clustering clustering = slam::find_clusters(particles, config.clusters);
  particles = slam::resample(particles, clustering, count, 0, filter, seed, 2);
  return watch.cpu_ms();
}

std::vector<double> updates(const slam::PlanIndex& index, int count, int repetitions) {
  std::vector<double> ms;
  for (int k = 0; k < repetitions; ++k) ms.push_back(update_ms(index, count, static_cast<std::uint64_t>(k + 1)));
  return ms;
}

double median_of(const std::vector<double>& samples) { return make_row("", "", samples).value; }

struct PlanCost {
  double tables_ms = 0.0;  ///< of making the plan's look-up tables
  double update_ms = 0.0;  ///< of 5,000 particles
};

PlanCost cost_of(int walls, const LatticeConfig& config, const BenchSetting& setting) {
  const bim::Building lattice = bim::read_plan_text(lattice_plan(walls, config), "lattice");
  const slam::Stopwatch watch;
  const slam::PlanIndex index = index_of(lattice);
  const double tables_ms = watch.cpu_ms();
  return {tables_ms, median_of(updates(index, 5000, setting.repetitions))};
}

/// CPU time of the method for each second walked, as a factor of real time.
double realtime_factor(const BenchSetting& setting, const std::string& scenario, std::uint64_t seed) {
  Overrides overrides;
  overrides.methods = std::vector<std::string>{method};
  overrides.seed = seed;
  const RunRecord record = execute(resolve(setting.library + "/" + scenario, overrides), {});
  if (!record.failure.empty()) throw ScenarioFailure(record.failure);
  double ms = 0.0;
  for (const StageTimes& times : record.methods.front().times)
    for (const float one : times.cpu_ms) ms += one;
  return 1e3 * slam::seconds(record.truth_W.back().stamp) / ms;
}

}  // namespace

std::vector<BenchRow> bench_localize(const BenchSetting& setting) {
  const LocalizeLimits limits;
  std::vector<BenchRow> rows;
  const slam::PlanIndex house = index_of(bim::load_building(setting.library + "/quickstart.plan.yaml"));
  const std::vector<double> few = updates(house, 5000, setting.repetitions);
  const std::vector<double> many = updates(house, 20000, setting.repetitions);
  rows.push_back(make_row("localize.particles_5000x8_ms", "ms", few, BenchLimit{limits.update_ms}));
  rows.push_back(make_row("localize.growth_particles", "power",
                          {growth_exponent(5000, median_of(few), 20000, median_of(many))},
                          BenchLimit{limits.growth_particles, true, true}));
  const LatticeConfig cell;
  LatticeConfig wide = cell;
  wide.cell_x_m *= 3.0;
  wide.cell_y_m *= 3.0;
  const PlanCost base = cost_of(100, cell, setting), walls = cost_of(1000, cell, setting),
                 area = cost_of(100, wide, setting);
  rows.push_back(make_row("localize.growth_walls", "power",
                          {growth_exponent(100, base.update_ms, 1000, walls.update_ms)},
                          BenchLimit{limits.growth_walls, true, true}));
  rows.push_back(make_row("localize.growth_area", "power", {growth_exponent(1, base.update_ms, 9, area.update_ms)}));
  rows.push_back(make_row("localize.tables_1000_walls_ms", "ms", {walls.tables_ms}));
  rows.push_back(
      make_row("localize.tables_growth_walls", "power", {growth_exponent(100, base.tables_ms, 1000, walls.tables_ms)}));
  rows.push_back(
      make_row("localize.tables_growth_area", "power", {growth_exponent(1, base.tables_ms, 9, area.tables_ms)}));
  std::vector<double> factors;
  for (int k = 0; k < setting.repetitions; ++k) {
    setting.step();
    factors.push_back(realtime_factor(setting, "localization/d6.yaml", static_cast<std::uint64_t>(k + 1)));
  }
  rows.push_back(make_row("localize.realtime_factor", "x", factors, BenchLimit{limits.realtime_factor, false}));
  return rows;
}

}  // namespace plumbline::scenarios
