// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/furnished.h"
#include "scenarios/app/bench/plain_rays.h"
#include "sim/lidar/lidar.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

struct LidarLimits {
  double rays_vs_intersect1 = 2.5;
  double mrays_per_cpu_s = 6.0;
  double scan_ms = 12.0;
  double scan_full_ms = 60.0;
  double growth = 1.35;  ///< exponent of building a scene: n log n is 1.07 there, caches cost the rest
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

/// One message of a walking robot's LiDAR, packets included.
BenchRow measure_scan(const BenchSetting& setting, const std::string& name, sim::LidarPreset preset, double limit_ms) {
  const FurnishedConfig config;
  const bim::RayScene scene(furnished_storey(config, 1));
  const sim::Lidar lidar(preset, 600.0, 1, scene);
  sim::Sweep sweep;
  constexpr std::size_t firings = 1824;
  std::vector<double> times;
  for (int k = -1; k < 10 * setting.repetitions; ++k) {
    setting.step();
    std::vector<Pose> X_WL;
    for (std::size_t i = 0; i < firings; ++i) {
      const double walked = 0.06 * (static_cast<double>(k) + static_cast<double>(i) / firings);
      X_WL.push_back(Pose::from_xyz_yaw({2.0, 4.5 + 0.5 * std::sin(walked), 0.65}, walked));
    }
    const slam::Stopwatch watch;
    lidar.sweep(static_cast<std::int64_t>(k + 1) * std::int64_t{firings}, X_WL, sweep);
    if (k >= 0) times.push_back(watch.cpu_ms());
  }
  return make_row(name, "ms", times, BenchLimit{limit_ms});
}

/// Rates of the kernel, and what they are to the plain loop's in the same moments. Gives the seconds it took to build
/// the scene.
double measure_kernel(const BenchSetting& setting, const StoreySize& size, bool gates, std::vector<BenchRow>& rows) {
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
    setting.step();
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
  return build_s;
}

}  // namespace

std::vector<BenchRow> bench_lidar(const BenchSetting& setting) {
  std::vector<BenchRow> rows;
  const FurnishedConfig large{40, 5, 2512};
  (void)measure_kernel(setting, {"1k", {1, 1, 400}}, false, rows);
  const double before = measure_kernel(setting, {"50k", {}}, true, rows);
  const double after = measure_kernel(setting, {"1M", large}, false, rows);
  rows.push_back(make_row("lidar.ray_scene_growth", "power",
                          {growth_exponent(FurnishedConfig{}.rooms(), before, large.rooms(), after)},
                          BenchLimit{LidarLimits{}.growth, true, true}));
  rows.push_back(measure_scan(setting, "lidar.scan_ms", sim::LidarPreset::real, LidarLimits{}.scan_ms));
  rows.push_back(measure_scan(setting, "lidar.scan_full_ms", sim::LidarPreset::full, LidarLimits{}.scan_full_ms));
  return rows;
}

}  // namespace plumbline::scenarios
