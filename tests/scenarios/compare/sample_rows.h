// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/metrics/metrics.h"
#include "scenarios/sweep/table.h"

namespace plumbline::scenarios {

[[nodiscard]] inline std::optional<double>& value_in(SweepRow& row, std::string_view metric) {
  const auto rows = score::metrics();
  std::size_t at = 0;
  while (rows[at].name != metric) ++at;
  return row.values[at];
}

/// A run of `vgicp` with an aligned error, on the walk of its seed.
[[nodiscard]] inline SweepRow slam_row(int seed, double ate_m, const std::string& scenario = "house") {
  SweepRow row;
  row.scenario = scenario;
  row.seed = std::to_string(seed);
  row.method = "vgicp";
  row.verdict = "complete";
  row.values.resize(score::metrics().size());
  value_in(row, "ate_aligned_rmse_m") = ate_m;
  row.sensor_digest = "walk of " + scenario + row.seed;
  row.method_digest = std::to_string(ate_m);
  row.digest = row.sensor_digest + row.method_digest;
  return row;
}

/// A run of `finder`, which localizes; `converged_at_m` below 0: never.
[[nodiscard]] inline SweepRow localization_row(int seed, const std::string& verdict, double converged_at_m) {
  SweepRow row = slam_row(seed, 0.0);
  row.method = "finder";
  row.verdict = verdict;
  row.identifiable = verdict != "honest_ambiguity";
  value_in(row, "ate_aligned_rmse_m").reset();
  if (converged_at_m >= 0.0) value_in(row, "localization.converged_at_m") = converged_at_m;
  row.method_digest = verdict + std::to_string(converged_at_m);
  row.digest = row.sensor_digest + row.method_digest;
  return row;
}

/// Seeds 1, 2, …: an error each.
[[nodiscard]] inline std::vector<SweepRow> slam_rows(const std::vector<double>& ate_m,
                                                     const std::string& scenario = "house") {
  std::vector<SweepRow> rows;
  for (const double error : ate_m) rows.push_back(slam_row(static_cast<int>(rows.size()) + 1, error, scenario));
  return rows;
}

}  // namespace plumbline::scenarios
