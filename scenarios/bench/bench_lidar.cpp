// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "scenarios/bench/bench.h"
#include "scenarios/bench/furnished.h"
#include "scenarios/bench/plain_rays.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

struct LidarLimits {
  double rays_vs_intersect1 = 2.5;
  double mrays_per_cpu_s = 6.0;
};

constexpr double range_max_m = 100.0;
constexpr int turns = 10;  ///< timed together, each in another room

struct StoreySize {
  std::string name;
  FurnishedConfig config;
};

/// Million rays per CPU second of one pass over the rays.
template <class Scene>
double rate(const Scene& scene, const std::vector<bim::Ray>& rays, std::vector<bim::Hit>& hits) {
  const slam::Stopwatch watch;
  scene.cast(rays, range_max_m, hits);
  return 1e-3 * static_cast<double>(rays.size()) / watch.cpu_ms();
}

std::vector<bim::Ray> rays_in(const FurnishedConfig& config) {
  std::vector<bim::Ray> rays;
  for (int turn = 0; turn < turns; ++turn) {
    const std::vector<bim::Ray> more = turn_in_room(config, turn * config.rooms() / turns, 2);
    rays.insert(rays.end(), more.begin(), more.end());
  }
  return rays;
}

/// Rates of the kernel, and what they are to the plain loop's in the same moments.
void measure_kernel(const BenchSetting& setting, const StoreySize& size, bool gates, std::vector<BenchRow>& rows) {
  const bim::BuildingMesh mesh = furnished_storey(size.config, 1);
  const slam::Stopwatch building;
  const bim::RayScene scene(mesh);
  const double build_s = 1e-3 * building.cpu_ms();
  const PlainRays plain(mesh);
  const std::vector<bim::Ray> rays = rays_in(size.config);
  std::vector<bim::Hit> hits(rays.size());
  std::vector<double> rates, ratios;
  (void)rate(scene, rays, hits);
  (void)rate(plain, rays, hits);
  for (int k = 0; k < setting.repetitions; ++k) {
    const double before = rate(plain, rays, hits);
    rates.push_back(rate(scene, rays, hits));
    const double after = rate(plain, rays, hits);
    ratios.push_back(2.0 * rates.back() / (before + after));
  }
  const LidarLimits limits;
  const std::string suffix = gates ? "" : "_" + size.name;
  rows.push_back(make_row("lidar.rays_vs_intersect1" + suffix, "x", ratios,
                          gates ? std::optional(BenchLimit{limits.rays_vs_intersect1, false, true}) : std::nullopt));
  rows.push_back(make_row("lidar.mrays_per_cpu_s" + suffix, "M/s", rates,
                          gates ? std::optional(BenchLimit{limits.mrays_per_cpu_s, false}) : std::nullopt));
  rows.push_back(make_row("lidar.ray_scene_" + size.name + "_s", "s", {build_s}));
}

}  // namespace

std::vector<BenchRow> bench_lidar(const BenchSetting& setting) {
  std::vector<BenchRow> rows;
  measure_kernel(setting, {"1k", {1, 1, 400}}, false, rows);
  measure_kernel(setting, {"50k", {}}, true, rows);
  measure_kernel(setting, {"1M", {40, 5, 2512}}, false, rows);
  return rows;
}

}  // namespace plumbline::scenarios
