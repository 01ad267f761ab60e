// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/compared_value.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/errors.h"
#include "bim/median.h"
#include "scenarios/compare/paired_tests.h"
#include "scenarios/metrics/metrics.h"

namespace plumbline::scenarios {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// A metric as it is compared.
struct ComparedMetric {
  std::size_t index = 0;
  bool of_success = false;  ///< counts where the verdict is success
  bool lower_is_better = true;
  Change change = Change::difference;
};

ComparedMetric metric_called(const std::string& name) {
  const auto rows = score::metrics();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const score::MetricRow& one) { return one.name == name; });
  if (row == rows.end() || row->better == score::Better::neither)
    throw InternalError(name + " cannot be compared: it has no better side");
  const bool lower = row->better == score::Better::lower;
  return {static_cast<std::size_t>(row - rows.begin()), name.starts_with("localization.converged_at_"), lower,
          lower && !row->unit.empty() ? Change::ratio : Change::difference};
}

std::optional<double> value_of(const SweepRow& row, const ComparedMetric& metric) {
  if (metric.of_success && row.verdict != "success") return std::nullopt;
  return row.values[metric.index];
}

/// B against A, above 0 where B is larger. A value that is missing is infinitely bad. Logarithms are subtracted, so
/// that the other way round gives exactly the opposite.
double difference_of(std::optional<double> a, std::optional<double> b, const ComparedMetric& metric) {
  const double bad = metric.lower_is_better ? endless : -endless;
  if (!b) return bad;
  if (!a) return -bad;
  if (*a == *b) return 0.0;
  return metric.change == Change::ratio ? std::log(*b) - std::log(*a) : *b - *a;
}

std::optional<double> finite_or_nothing(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

double shown(double shift, Change change) { return change == Change::ratio ? std::exp(shift) : shift; }

}  // namespace

std::optional<double> ComparedValue::detectable() const {
  if (!interval) return std::nullopt;
  if (change == Change::ratio) {
    if (interval->first <= 0.0) return std::nullopt;
    return finite_or_nothing(std::exp(0.5 * (std::log(interval->second) - std::log(interval->first))) - 1.0);
  }
  return finite_or_nothing(0.5 * (interval->second - interval->first));
}

ComparedValue compare_outcome(const std::vector<const RowPair*>& pairs, Outcome outcome) {
  const bool right = outcome == Outcome::right;
  ComparedValue value;
  value.name = right ? "right" : "wrong";
  value.outcome = true;
  value.pairs = pairs.size();
  std::size_t in_a = 0, in_b = 0;
  for (const RowPair* pair : pairs) {
    const bool a = right ? is_right(pair->a) : is_wrong(pair->a);
    const bool b = right ? is_right(pair->b) : is_wrong(pair->b);
    in_a += a ? 1 : 0;
    in_b += b ? 1 : 0;
    ++(a == b ? value.equal : b == right ? value.better : value.worse);
  }
  value.a = static_cast<double>(in_a);
  value.b = static_cast<double>(in_b);
  if (pairs.size() > 1 && value.differing() > 0) value.p = mcnemar_p(value.better, value.worse);
  value.for_worse = value.worse > value.better;
  return value;
}

ComparedValue compare_metric(const std::vector<const RowPair*>& pairs, const std::string& metric_name) {
  const ComparedMetric metric = metric_called(metric_name);
  const double bad = metric.lower_is_better ? endless : -endless;
  ComparedValue value;
  value.name = metric_name;
  value.change = metric.change;
  std::vector<double> in_a, in_b, differences, logarithms;
  for (const RowPair* pair : pairs) {
    const std::optional<double> a = value_of(pair->a, metric), b = value_of(pair->b, metric);
    const auto declined = [](const SweepRow& row, const std::optional<double>& its) {
      return !its && row.verdict == "honest_ambiguity";
    };
    if ((!a && !b) || declined(pair->a, a) || declined(pair->b, b)) continue;
    ++value.pairs;
    value.missing_a += a ? 0 : 1;
    value.missing_b += b ? 0 : 1;
    in_a.push_back(a.value_or(bad));
    in_b.push_back(b.value_or(bad));
    const double difference = difference_of(a, b, metric);
    ++(difference == 0.0 ? value.equal : (difference > 0.0) == metric.lower_is_better ? value.worse : value.better);
    if (difference != 0.0) differences.push_back(difference);
    if (a && b && *a > 0.0 && *b > 0.0) logarithms.push_back(std::log(*b) - std::log(*a));
  }
  if (value.pairs == 0) return value;
  value.a = finite_or_nothing(median(in_a));
  value.b = finite_or_nothing(median(in_b));
  value.shift = shown(0.0, metric.change);
  if (metric.change == Change::ratio && !logarithms.empty()) {
    double sum = 0.0;
    for (const double one : logarithms) sum += one;
    value.geometric_mean = std::exp(sum / static_cast<double>(logarithms.size()));
  }
  if (differences.empty()) return value;
  const PseudoMedian shift = pseudo_median(differences);
  value.shift = shown(shift.value, metric.change);
  if (shift.interval)
    value.interval = {shown(shift.interval->first, metric.change), shown(shift.interval->second, metric.change)};
  if (value.pairs > 1) value.p = signed_rank_p(differences);
  value.for_worse = (signed_rank_side(differences) > 0.0) == metric.lower_is_better;
  return value;
}

}  // namespace plumbline::scenarios
