// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/compare/paired_rows.h"

namespace plumbline::scenarios {

/// What the pairs say of B against A. `better_alone`, `worse_alone`: shown by one test, but not when it is corrected
/// for the number of all. `mixed`: better in one respect and worse in another. `differs`: one single pair, which shows
/// no more.
enum class Finding { same, better, worse, better_alone, worse_alone, mixed, not_shown, differs };
[[nodiscard]] std::string to_string(Finding finding);

/// How two values of a metric are set against each other: B/A of errors in a unit, B - A of shares and counts.
enum class Change { ratio, difference };

/// A metric, or an outcome counted, of one method in both.
struct ComparedValue {
  std::string name;      ///< of the metric; "right" and "wrong" are outcomes
  std::string scenario;  ///< empty: all of the method's
  bool outcome = false;
  Change change = Change::difference;
  std::size_t pairs = 0;  ///< with a value in A or B, at least
  std::size_t better = 0, equal = 0, worse = 0;
  std::size_t missing_a = 0, missing_b = 0;  ///< of them, without a value in A or B; it counts as infinitely bad
  std::optional<double> a, b;                ///< of an outcome its number, of a metric the median where it is finite
  /// Of the pairs that differ: see pseudo_median(), as a factor where `change` is a ratio. May be infinite.
  std::optional<double> shift;
  std::optional<std::pair<double, double>> interval;
  bool for_worse = false;                ///< the side on which the pairs that differ are, taken together
  std::optional<double> geometric_mean;  ///< of the ratios of all pairs with two values above 0
  std::optional<double> p;               ///< two-sided, exact; absent where no pair or one pair differs at all
  std::optional<double> p_holm;          ///< corrected for all tests; absent where it was no test
  std::optional<Finding> finding;        ///< absent for one of several scenarios, unless it is `same`

  [[nodiscard]] std::size_t differing() const { return better + worse; }
  /// The smallest change that these pairs could have shown: half the interval, as a share of 1 where it is a ratio.
  [[nodiscard]] std::optional<double> detectable() const;
};

struct ComparedMethod {
  std::string name;
  std::size_t pairs = 0;
  std::size_t failed = 0;  ///< of them: the walk failed in A or B, and they are left out
  bool same = false;       ///< in all pairs, byte for byte
  bool different = false;  ///< in a pair at least; neither where no digest tells
  std::vector<ComparedValue> values;
};

/// A run that ends with a wrong answer, a crash or a failed walk on one side alone.
struct OneSidedFailure {
  std::string run, method;
  std::string a, b;  ///< verdicts
};

struct Comparison {
  std::vector<ComparedMethod> methods;  ///< in the order of A
  std::size_t pairs = 0;
  std::vector<std::string> only_a, only_b;  ///< "house, seed 3, vgicp"
  std::size_t same_sensors = 0, other_sensors = 0, unknown_sensors = 0;
  std::size_t rescored = 0;   ///< pairs with equal digests and other scores: the scoring changed
  bool shared_walks = false;  ///< several pairs of a method are of one walk, so they are not independent
  std::vector<OneSidedFailure> failures_a, failures_b;
  std::size_t tests = 0;  ///< that p_holm corrects for: those that could have shown something at 5 %
  Finding finding = Finding::same;
};

/// Metrics that are compared where none is named.
[[nodiscard]] std::span<const std::string_view> compared_metrics();

/// Compares pairs, of which there is one at least; `metrics` are names of score::metrics() with a direction.
[[nodiscard]] Comparison compare_rows(const PairedRows& rows, const std::vector<std::string>& metrics);

}  // namespace plumbline::scenarios
