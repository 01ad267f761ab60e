// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/comparison.h"

#include <algorithm>
#include <array>
#include <set>

#include "scenarios/compare/compared_value.h"
#include "scenarios/compare/paired_tests.h"

namespace plumbline::scenarios {

namespace {

constexpr double significance = 0.05;

using Pairs = std::vector<const RowPair*>;

template <class Key>
std::vector<std::pair<std::string, Pairs>> grouped(const Pairs& pairs, const Key& key) {
  std::vector<std::pair<std::string, Pairs>> groups;
  for (const RowPair* pair : pairs) {
    const std::string& name = key(*pair);
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& one) { return one.first == name; });
    if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
    group->second.push_back(pair);
  }
  return groups;
}

bool all_same(const Pairs& pairs) {
  return std::all_of(pairs.begin(), pairs.end(), [](const RowPair* pair) { return is_same(*pair); });
}

/// A localization claims a pose.
bool can_be_wrong(const RowPair& pair) {
  return pair.a.identifiable || pair.b.identifiable || is_wrong(pair.a) || is_wrong(pair.b);
}

/// Before anything is known of the tests.
Finding untested_finding(const Pairs& pairs) {
  if (all_same(pairs)) return Finding::same;
  return pairs.size() == 1 && is_different(*pairs.front()) ? Finding::differs : Finding::not_shown;
}

ComparedMethod compare_method(const std::string& name, const Pairs& all, const std::vector<std::string>& metrics) {
  ComparedMethod method;
  method.name = name;
  method.pairs = all.size();
  method.same = all_same(all);
  method.different = std::any_of(all.begin(), all.end(), [](const RowPair* pair) { return is_different(*pair); });
  Pairs pairs;
  for (const RowPair* pair : all)
    if (!is_failed(pair->a) && !is_failed(pair->b)) pairs.push_back(pair);
  method.failed = all.size() - pairs.size();
  if (method.same || pairs.empty()) return method;
  const auto scenarios = grouped(pairs, [](const RowPair& pair) -> const std::string& { return pair.a.scenario; });
  const auto add = [&](const auto& compare) {
    ComparedValue whole = compare(pairs);
    if (whole.pairs == 0) return;
    whole.finding = untested_finding(pairs);
    method.values.push_back(std::move(whole));
    if (scenarios.size() < 2) return;
    for (const auto& [scenario, its_pairs] : scenarios) {
      ComparedValue part = compare(its_pairs);
      if (part.pairs == 0 || (part.outcome && part.differing() == 0)) continue;
      part.scenario = scenario;
      if (all_same(its_pairs)) part.finding = Finding::same;
      method.values.push_back(std::move(part));
    }
  };
  add([](const Pairs& some) { return compare_outcome(some, Outcome::right); });
  if (std::any_of(pairs.begin(), pairs.end(), [](const RowPair* pair) { return can_be_wrong(*pair); }))
    add([](const Pairs& some) { return compare_outcome(some, Outcome::wrong); });
  for (const std::string& metric : metrics) add([&](const Pairs& some) { return compare_metric(some, metric); });
  return method;
}

/// Tests of the whole, those that could show something at all. One that cannot is never an error, so it does not count
/// among them.
std::size_t correct_for_number(std::vector<ComparedMethod>& methods) {
  std::vector<ComparedValue*> tests;
  for (ComparedMethod& method : methods)
    for (ComparedValue& value : method.values)
      if (value.scenario.empty() && value.p && value.differing() >= fewest_differences) tests.push_back(&value);
  std::vector<double> p;
  for (const ComparedValue* test : tests) p.push_back(*test->p);
  const std::vector<double> corrected = holm(p);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i]->p_holm = corrected[i];
    const bool worse = tests[i]->for_worse;
    if (corrected[i] <= significance)
      tests[i]->finding = worse ? Finding::worse : Finding::better;
    else if (p[i] <= significance)
      tests[i]->finding = worse ? Finding::worse_alone : Finding::better_alone;
  }
  return tests.size();
}

Finding overall(const Comparison& comparison) {
  bool same = true, single = true, different = false, better = false, worse = false;
  for (const ComparedMethod& method : comparison.methods) {
    same = same && method.same;
    single = single && method.pairs == 1;
    different = different || method.different;
    for (const ComparedValue& value : method.values) {
      better = better || value.finding == Finding::better;
      worse = worse || value.finding == Finding::worse;
    }
  }
  if (same) return Finding::same;
  if (single && different) return Finding::differs;
  if (better && worse) return Finding::mixed;
  return better ? Finding::better : worse ? Finding::worse : Finding::not_shown;
}

bool is_broken(const SweepRow& row) { return is_failed(row) || row.verdict == "crashed"; }
bool ends_worse(const SweepRow& row, const SweepRow& other) {
  return (is_wrong(row) && !is_wrong(other)) || (is_broken(row) && !is_broken(other));
}

void count_pair(const RowPair& pair, Comparison& comparison) {
  const auto& [a, b] = pair;
  const std::optional<bool> sensors = same_sensor_data(pair);
  if (!is_failed(a) && !is_failed(b))
    ++(!sensors ? comparison.unknown_sensors : *sensors ? comparison.same_sensors : comparison.other_sensors);
  if (!a.digest.empty() && a.digest == b.digest && (a.verdict != b.verdict || a.values != b.values))
    ++comparison.rescored;
  const OneSidedFailure failure{run_title(a), a.method, a.verdict, b.verdict};
  if (ends_worse(b, a)) comparison.failures_b.push_back(failure);
  if (ends_worse(a, b)) comparison.failures_a.push_back(failure);
}

bool share_walks(const Pairs& pairs) {
  std::set<std::string> seen;
  return std::any_of(pairs.begin(), pairs.end(), [&](const RowPair* pair) {
    return !pair->a.sensor_digest.empty() && !seen.insert(pair->a.sensor_digest).second;
  });
}

std::vector<std::string> titles_of(const std::vector<SweepRow>& rows) {
  std::vector<std::string> titles;
  for (const SweepRow& row : rows) titles.push_back(run_title(row) + ", " + row.method);
  return titles;
}

}  // namespace

std::string to_string(Finding finding) {
  static constexpr std::array<const char*, 8> names = {
      "same",   "better", "worse", "better by itself", "worse by itself", "better and worse", "no difference shown",
      "differs"};
  return names[static_cast<std::size_t>(finding)];
}

std::span<const std::string_view> compared_metrics() {
  static constexpr std::array<std::string_view, 6> names = {"ate_aligned_rmse_m",      "map_rmse_m",
                                                            "rooms.precision",         "rooms.recall",
                                                            "localization.ape_rmse_m", "localization.converged_at_m"};
  return names;
}

Comparison compare_rows(const PairedRows& rows, const std::vector<std::string>& metrics) {
  Comparison comparison;
  comparison.only_a = titles_of(rows.only_a);
  comparison.only_b = titles_of(rows.only_b);
  comparison.pairs = rows.pairs.size();
  Pairs pairs;
  for (const RowPair& pair : rows.pairs) {
    pairs.push_back(&pair);
    count_pair(pair, comparison);
  }
  for (const auto& [name, its_pairs] :
       grouped(pairs, [](const RowPair& pair) -> const std::string& { return pair.a.method; })) {
    comparison.methods.push_back(compare_method(name, its_pairs, metrics));
    comparison.shared_walks = comparison.shared_walks || share_walks(its_pairs);
  }
  comparison.tests = correct_for_number(comparison.methods);
  comparison.finding = overall(comparison);
  return comparison;
}

}  // namespace plumbline::scenarios
