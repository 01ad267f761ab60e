// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/paired_tests.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>

namespace plumbline::scenarios {

namespace {

constexpr double tail_share = 0.025;  // of each side of an interval of 95 %

/// Probability of each sum of the ranks that get a plus, where each does with 1/2. Sums are below the largest + 1.
std::vector<double> sum_distribution(const std::vector<std::size_t>& ranks) {
  std::vector<double> probability = {1.0};
  for (const std::size_t rank : ranks) {
    std::vector<double> next(probability.size() + rank, 0.0);
    for (std::size_t sum = 0; sum < probability.size(); ++sum) {
      next[sum] += 0.5 * probability[sum];
      next[sum + rank] += 0.5 * probability[sum];
    }
    probability = std::move(next);
  }
  return probability;
}

double normal_tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

/// Twice the mean rank of each, so that it is a whole number, by ascending size.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& sizes) {
  std::vector<std::size_t> ranks(sizes.size());
  for (std::size_t first = 0; first < sizes.size();) {
    std::size_t last = first;
    while (last + 1 < sizes.size() && sizes[last + 1] == sizes[first]) ++last;
    for (std::size_t i = first; i <= last; ++i) ranks[i] = first + last + 2;
    first = last + 1;
  }
  return ranks;
}

double mean_of_two(double a, double b) { return std::isinf(a) && a == -b ? 0.0 : 0.5 * a + 0.5 * b; }

/// How many means of two of these, each with itself, too, are at most `limit`. `sorted` ascends.
std::size_t means_up_to(const std::vector<double>& sorted, double limit) {
  std::size_t count = 0, end = sorted.size();  // means of i with those from `end` on are above
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    while (end > i && mean_of_two(sorted[i], sorted[end - 1]) > limit) --end;
    if (end <= i) break;
    count += end - i;
  }
  return count;
}

/// Doubles in their order as whole numbers in theirs.
std::uint64_t order_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits >> 63U) != 0 ? ~bits : bits | (1ULL << 63U);
}
double value_at(std::uint64_t order) {
  return std::bit_cast<double>((order >> 63U) != 0 ? order & ~(1ULL << 63U) : ~order);
}

/// The mean of two with `rank` others below it, from 0.
double mean_at(const std::vector<double>& sorted, std::size_t rank) {
  std::uint64_t low = order_of(-std::numeric_limits<double>::infinity());
  std::uint64_t high = order_of(std::numeric_limits<double>::infinity());
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (means_up_to(sorted, value_at(middle)) > rank)
      high = middle;
    else
      low = middle + 1;
  }
  return value_at(low) + 0.0;  // no -0
}

/// How many of the smallest means, and of the largest, lie outside the interval: the largest k for which a sum of ranks
/// below k has at most 2.5 %.
std::size_t means_outside(std::size_t n) {
  const double pairs = static_cast<double>(n);
  if (n > most_exact_pairs) {
    constexpr double z = 1.959963984540054;
    return static_cast<std::size_t>(pairs * (pairs + 1.0) / 4.0 -
                                    z * std::sqrt(pairs * (pairs + 1.0) * (2.0 * pairs + 1.0) / 24.0));
  }
  std::vector<std::size_t> ranks(n);
  std::iota(ranks.begin(), ranks.end(), std::size_t{1});
  const std::vector<double> probability = sum_distribution(ranks);
  double below = 0.0;
  for (std::size_t k = 0; k < probability.size(); ++k)
    if ((below += probability[k]) > tail_share) return k;
  return 0;
}

/// Of differences that are not 0.
struct SignedRanks {
  std::vector<std::size_t> doubled;  ///< by size
  std::size_t plus = 0, all = 0;     ///< their sums, of positive differences and of all
};

SignedRanks signed_ranks(const std::vector<double>& differences) {
  std::vector<double> nonzero;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(nonzero), [](double d) { return d != 0.0; });
  std::sort(nonzero.begin(), nonzero.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> sizes(nonzero.size());
  std::transform(nonzero.begin(), nonzero.end(), sizes.begin(), [](double d) { return std::abs(d); });
  SignedRanks ranks;
  ranks.doubled = doubled_ranks(sizes);
  ranks.all = std::accumulate(ranks.doubled.begin(), ranks.doubled.end(), std::size_t{0});
  for (std::size_t i = 0; i < nonzero.size(); ++i)
    if (nonzero[i] > 0.0) ranks.plus += ranks.doubled[i];
  return ranks;
}

}  // namespace

double mcnemar_p(std::size_t only_first, std::size_t only_second) {
  const std::size_t all = only_first + only_second;
  if (all == 0) return 1.0;
  const auto n = static_cast<double>(all);
  double log_choose = 0.0, tail = 0.0;  // of 0 to the smaller of both
  for (std::size_t k = 0; k <= std::min(only_first, only_second); ++k) {
    const auto at = static_cast<double>(k);
    if (k > 0) log_choose += std::log(n - at + 1.0) - std::log(at);
    tail += std::exp(log_choose - n * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

double signed_rank_p(const std::vector<double>& differences) {
  const auto [ranks, plus, all] = signed_ranks(differences);
  if (ranks.empty()) return 1.0;
  const std::size_t smaller = std::min(plus, all - plus);
  if (ranks.size() > most_exact_pairs) {
    double variance = 0.0;  // of the doubled sum: a quarter of the sum of squares
    for (const std::size_t rank : ranks) variance += 0.25 * static_cast<double>(rank) * static_cast<double>(rank);
    const double below = 0.5 * static_cast<double>(all) - static_cast<double>(smaller) - 1.0;  // half a rank, doubled
    return std::min(1.0, 2.0 * normal_tail(std::max(0.0, below) / std::sqrt(variance)));
  }
  const std::vector<double> probability = sum_distribution(ranks);
  return std::min(1.0, 2.0 * std::accumulate(probability.begin(),
                                             probability.begin() + static_cast<std::ptrdiff_t>(smaller + 1), 0.0));
}

double signed_rank_side(const std::vector<double>& differences) {
  const SignedRanks ranks = signed_ranks(differences);
  return 2.0 * static_cast<double>(ranks.plus) - static_cast<double>(ranks.all);
}

PseudoMedian pseudo_median(const std::vector<double>& differences) {
  const std::size_t n = differences.size(), means = n * (n + 1) / 2;
  std::vector<double> sorted = differences;
  std::sort(sorted.begin(), sorted.end());
  PseudoMedian found;
  found.value = mean_of_two(mean_at(sorted, (means - 1) / 2), mean_at(sorted, means / 2));
  if (n < fewest_differences) return found;
  const std::size_t outside = means_outside(n);
  found.interval = {mean_at(sorted, outside - 1), mean_at(sorted, means - outside)};
  return found;
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> corrected(p.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - i) * p[order[i]]));
    corrected[order[i]] = largest;
  }
  return corrected;
}

}  // namespace plumbline::scenarios
