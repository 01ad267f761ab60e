// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/timings.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

namespace {

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string cpu_features() {
  __builtin_cpu_init();
  std::string text;
  const auto add = [&](const char* name, bool has) {
    text += has ? (text.empty() ? "" : " ") + std::string(name) : "";
  };
  add("sse4.2", __builtin_cpu_supports("sse4.2") != 0);
  add("avx", __builtin_cpu_supports("avx") != 0);
  add("avx2", __builtin_cpu_supports("avx2") != 0);
  add("fma", __builtin_cpu_supports("fma") != 0);
  add("avx512f", __builtin_cpu_supports("avx512f") != 0);
  return text;
}

double round_ms(double value) { return std::round(value * 1e3) / 1e3; }

Tree stage(const StageTimes& times) {
  std::vector<float> sorted = times.cpu_ms;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0.0;
  for (const float ms : times.cpu_ms) sum += static_cast<double>(ms);
  const auto n = static_cast<double>(sorted.size());
  const auto rank = static_cast<std::size_t>(std::ceil(0.99 * n)) - 1;
  Tree tree = Tree::map();
  tree.set("count", static_cast<std::int64_t>(sorted.size())).set("mean_ms", round_ms(sum / n));
  return tree.set("p99_ms", round_ms(static_cast<double>(sorted[rank]))).set("total_s", round_ms(sum / 1e3));
}

}  // namespace

std::string write_timings(const std::vector<StageTimes>& simulation, const std::vector<MethodRecord>& methods,
                          const RunCost& cost) {
  Tree stages = Tree::map();
  for (const StageTimes& times : simulation)
    if (!times.cpu_ms.empty()) stages.set(times.stage, stage(times));
  for (const MethodRecord& method : methods)
    for (const StageTimes& times : method.times) stages.set(method.name + "/" + times.stage, stage(times));
  Tree tree = Tree::map();
  tree.set("total_s", round_ms(cost.total_s)).set("cpu_s", round_ms(cost.cpu_s));
  tree.set("simulated_s", round_ms(cost.simulated_s)).set("peak_rss_mb", round_ms(peak_rss_mb()));
  tree.set("threads", cost.threads).set("cpu_features", cpu_features());
  return write_json(tree.set("stages", stages)) + "\n";
}

}  // namespace plumbline::scenarios
