// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>

#include "bim/errors.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/run/runner.h"
#include "scenarios/spec/resolve.h"

namespace plumbline::scenarios {

namespace {

struct SlamLimits {
  double odometry_ms = 12.0;  ///< a scan, deskewing included
  double planes_ms = 3.0;     ///< a keyframe
  double rooms_ms = 3.0;      ///< rooms and free space, a keyframe
  double backend_ms = 10.0;   ///< a keyframe
  double realtime_factor = 6.0;
  double growth = 1.5;  ///< last quarter of a long run over its second
};

const std::string method = "s_graphs_plus";

/// A scenario of the library with this method alone.
RunRecord walk(const BenchSetting& setting, const std::string& scenario, std::uint64_t seed) {
  Overrides overrides;
  overrides.methods = std::vector<std::string>{method};
  overrides.seed = seed;
  RunRecord record = execute(resolve(setting.library + "/" + scenario, overrides), {});
  if (!record.failure.empty()) throw ScenarioFailure(record.failure);
  if (record.methods.front().crashed) throw InternalError(method + " crashed: " + record.methods.front().error);
  return record;
}

const std::vector<float>& times_of(const RunRecord& record, const std::string& stage) {
  for (const StageTimes& times : record.methods.front().times)
    if (times.stage == stage) return times.cpu_ms;
  throw InternalError("bench: no stage " + stage);
}

double sum(std::span<const float> ms) { return std::accumulate(ms.begin(), ms.end(), 0.0); }
double mean(std::span<const float> ms) { return sum(ms) / static_cast<double>(ms.size()); }

/// CPU time of the method for each second walked, as a factor of real time.
double realtime_factor(const RunRecord& record) {
  double ms = 0.0;
  for (const StageTimes& times : record.methods.front().times) ms += sum(times.cpu_ms);
  return 1e3 * slam::seconds(record.truth_W.back().stamp) / ms;
}

/// Mean of a stage in the last quarter of its calls over that in the second.
double growth(const RunRecord& record, const std::string& stage) {
  const std::span<const float> ms = times_of(record, stage);
  const std::size_t quarter = ms.size() / 4;
  return mean(ms.last(quarter)) / mean(ms.subspan(quarter, quarter));
}

}  // namespace

std::vector<BenchRow> bench_slam(const BenchSetting& setting) {
  std::vector<double> odometry, planes, rooms, back_end, factor;
  for (int k = 0; k < setting.repetitions; ++k) {
    setting.step();
    const RunRecord record = walk(setting, "quickstart.yaml", static_cast<std::uint64_t>(k + 1));
    odometry.push_back(mean(times_of(record, "odometry")) + mean(times_of(record, "deskew")));
    planes.push_back(mean(times_of(record, "plane_segmentation")));
    rooms.push_back(mean(times_of(record, "room_segmentation")));
    back_end.push_back(mean(times_of(record, "back_end")));
    factor.push_back(realtime_factor(record));
  }
  const SlamLimits limits;
  std::vector<BenchRow> rows = {
      make_row("slam.odometry_ms", "ms", odometry, BenchLimit{limits.odometry_ms}),
      make_row("slam.planes_ms", "ms", planes, BenchLimit{limits.planes_ms}),
      make_row("slam.rooms_ms", "ms", rooms, BenchLimit{limits.rooms_ms}),
      make_row("slam.backend_ms", "ms", back_end, BenchLimit{limits.backend_ms}),
      make_row("slam.realtime_factor", "x", factor, BenchLimit{limits.realtime_factor, false})};
  const RunRecord laps = walk(setting, "s_graphs/long.yaml", 1);
  rows.push_back(
      make_row("slam.backend_growth", "x", {growth(laps, "back_end")}, BenchLimit{limits.growth, true, true}));
  for (const std::string stage : {"odometry", "association", "room_segmentation", "loop_closure"})
    rows.push_back(make_row("slam." + stage + "_growth", "x", {growth(laps, stage)}));
  rows.push_back(make_row("slam.backend_long_ms", "ms", {mean(times_of(laps, "back_end"))}));
  const std::vector<BenchRow> clouds = bench_registration(setting);
  rows.insert(rows.end(), clouds.begin(), clouds.end());
  return rows;
}

}  // namespace plumbline::scenarios
