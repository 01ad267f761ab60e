// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/paired_rows.h"

#include <map>
#include <tuple>

namespace plumbline::scenarios {

PairedRows pair_rows(const std::vector<SweepRow>& a, const std::vector<SweepRow>& b) {
  const auto key = [](const SweepRow& row) {
    return std::tie(row.scenario, row.variant, row.start, row.seed, row.method);
  };
  std::multimap<decltype(key(b.front())), std::size_t> waiting;
  for (std::size_t i = 0; i < b.size(); ++i) waiting.emplace(key(b[i]), i);
  std::vector<bool> taken(b.size(), false);
  PairedRows paired;
  for (const SweepRow& row : a) {
    const auto other = waiting.lower_bound(key(row));
    if (other == waiting.end() || other->first != key(row)) {
      paired.only_a.push_back(row);
      continue;
    }
    paired.pairs.push_back({row, b[other->second]});
    taken[other->second] = true;
    waiting.erase(other);
  }
  for (std::size_t i = 0; i < b.size(); ++i)
    if (!taken[i]) paired.only_b.push_back(b[i]);
  return paired;
}

std::string run_title(const SweepRow& row) { return walks_title(row) + ", seed " + row.seed; }

std::optional<bool> same_sensor_data(const RowPair& pair) {
  if (!pair.a.digest.empty() && pair.a.digest == pair.b.digest) return true;
  if (pair.a.sensor_digest.empty() || pair.b.sensor_digest.empty()) return std::nullopt;
  return pair.a.sensor_digest == pair.b.sensor_digest;
}

bool is_same(const RowPair& pair) {
  const auto& [a, b] = pair;
  if (is_failed(a) || is_failed(b)) return a.verdict == b.verdict && a.failure == b.failure;
  if (a.verdict != b.verdict || a.values != b.values || !same_sensor_data(pair).value_or(false)) return false;
  if (a.sensor_digest.empty() || b.sensor_digest.empty()) return a.digest == b.digest;  // all that is known
  return !a.method_digest.empty() && a.method_digest == b.method_digest;
}

bool is_different(const RowPair& pair) {
  const auto& [a, b] = pair;
  if (is_failed(a) || is_failed(b)) return !is_same(pair);
  const bool digests = !a.method_digest.empty() && !b.method_digest.empty() && a.method_digest != b.method_digest;
  return digests || a.verdict != b.verdict || a.values != b.values || !same_sensor_data(pair).value_or(true);
}

bool is_right(const SweepRow& row) {
  return row.verdict == "complete" || row.verdict == "success" || row.verdict == "honest_ambiguity";
}

bool is_wrong(const SweepRow& row) { return row.verdict == "false_convergence" || row.verdict == "overconfident"; }

bool is_failed(const SweepRow& row) { return row.verdict == "failed"; }

}  // namespace plumbline::scenarios
