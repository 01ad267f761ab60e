// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline::scenarios {

/// Exact two-sided p of McNemar's test [mcnemar1947]: a success in one of two paired runs alone is as likely to be in
/// the first as in the second. 1 where there is none.
[[nodiscard]] double mcnemar_p(std::size_t only_first, std::size_t only_second);

/// Pairs up to which signed_rank_p() and pseudo_median() are exact; beyond, the normal approximation.
inline constexpr std::size_t most_exact_pairs = 300;
/// Fewer differences than these leave no room for a p of 0.05 or less, nor for an interval of 95 %.
inline constexpr std::size_t fewest_differences = 6;

/// Two-sided p of Wilcoxon's signed-rank test [wilcoxon1945]: differences of pairs are as likely to be d as -d.
/// Zeros are left out, equal sizes share their mean rank, and the distribution is that of these very ranks. Differences
/// may be infinite. 1 where none is left.
[[nodiscard]] double signed_rank_p(const std::vector<double>& differences);

/// Which side of 0 the ranks of signed_rank_p() are on: above 0 where those of positive differences sum up to more. The
/// shift may be 0 where this is not, as with many equal differences.
[[nodiscard]] double signed_rank_side(const std::vector<double>& differences);

/// A shift, and its interval of 95 % where there are fewest_differences. Each may be infinite.
struct PseudoMedian {
  double value = 0.0;
  std::optional<std::pair<double, double>> interval;
};
/// Median of the means of all pairs of differences, each with itself, too, and the interval of all shifts that,
/// where no two differences have one size, signed_rank_p() does not reject at 5 % [hodges1963]: it holds the centre of
/// a symmetric distribution with at least 95 %. Differences may be infinite; the mean of two opposite infinities is 0.
/// At least one difference.
[[nodiscard]] PseudoMedian pseudo_median(const std::vector<double>& differences);

/// p-values corrected for their number [holm1979]: rejecting those of at most 0.05 errs in any with at most 5 %.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p);

}  // namespace plumbline::scenarios
