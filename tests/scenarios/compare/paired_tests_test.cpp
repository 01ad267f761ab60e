// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/paired_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/random/stream.h"

namespace plumbline::scenarios {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// 1 to n, those negative that make the sum of the negative ranks `sum`.
std::vector<double> with_negative_sum(std::size_t n, std::size_t sum) {
  std::vector<double> differences;
  for (std::size_t rank = n; rank >= 1; --rank) {
    const bool negative = rank <= sum;
    if (negative) sum -= rank;
    differences.push_back(negative ? -static_cast<double>(rank) : static_cast<double>(rank));
  }
  return differences;
}

TEST(McNemar, IsTheBinomialTest) {
  EXPECT_EQ(mcnemar_p(0, 0), 1.0);
  EXPECT_NEAR(mcnemar_p(5, 5), 1.0, 1e-12);
  EXPECT_NEAR(mcnemar_p(0, 5), 2.0 / 32.0, 1e-12);
  EXPECT_NEAR(mcnemar_p(6, 0), 2.0 / 64.0, 1e-12);
  EXPECT_NEAR(mcnemar_p(1, 9), 2.0 * (1.0 + 10.0) / 1024.0, 1e-12);
  EXPECT_NEAR(mcnemar_p(8, 2), 2.0 * (1.0 + 10.0 + 45.0) / 1024.0, 1e-12);
  // Of many the normal approximation with its correction for continuity: (|60 - 40| - 1) / sqrt(100) = 1.9.
  EXPECT_NEAR(mcnemar_p(40, 60), std::erfc(1.9 / std::sqrt(2.0)), 0.001);
  EXPECT_GT(mcnemar_p(2000, 2001), 0.9);
  EXPECT_LT(mcnemar_p(1000, 3000), 1e-200);
}

// The largest sum of the rarer sign that is refused at 5 %, two-sided, in tables of the test.
TEST(SignedRank, CriticalValuesOfTheTable) {
  const std::vector<std::size_t> critical = {0,  2,  3,  5,  8,  10, 13, 17, 21, 25,
                                             29, 34, 40, 46, 52, 58, 65, 73, 81, 89};  // n = 6 to 25
  for (std::size_t i = 0; i < critical.size(); ++i) {
    EXPECT_LE(signed_rank_p(with_negative_sum(i + 6, critical[i])), 0.05) << i + 6;
    EXPECT_GT(signed_rank_p(with_negative_sum(i + 6, critical[i] + 1)), 0.05) << i + 6;
  }
  for (std::size_t n = 1; n < fewest_differences; ++n) EXPECT_GT(signed_rank_p(with_negative_sum(n, 0)), 0.05) << n;
}

// Darwin's fifteen pairs of maize, crossed less self-fertilised, in eighths of an inch.
TEST(SignedRank, DarwinsMaize) {
  const std::vector<double> maize = {49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};
  EXPECT_NEAR(signed_rank_p(maize), 0.04126, 0.00001);
  std::vector<double> means;
  for (std::size_t i = 0; i < maize.size(); ++i)
    for (std::size_t j = i; j < maize.size(); ++j) means.push_back(0.5 * (maize[i] + maize[j]));
  std::sort(means.begin(), means.end());
  const PseudoMedian shift = pseudo_median(maize);
  ASSERT_EQ(means.size(), 120U);
  EXPECT_EQ(shift.value, 0.5 * (means[59] + means[60]));
  EXPECT_EQ(shift.interval->first, means[25]);  // 25 is refused, so the 26th is the first that is not
  EXPECT_EQ(shift.interval->second, means[94]);
}

/// p by going through all signs.
double enumerated_p(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences)
    if (d != 0.0) sizes.push_back(std::abs(d));
  const auto rank = [&](double size) {
    double below = 0.0, equal = 0.0;
    for (const double other : sizes) {
      below += other < size ? 1.0 : 0.0;
      equal += other == size ? 1.0 : 0.0;
    }
    return below + 0.5 * (equal + 1.0);
  };
  double all = 0.0, plus = 0.0;
  for (const double size : sizes) all += rank(size);
  for (const double d : differences)
    if (d > 0.0) plus += rank(d);
  const double off = std::abs(plus - 0.5 * all);
  std::size_t as_far = 0;
  for (std::size_t signs = 0; signs < (std::size_t{1} << sizes.size()); ++signs) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      if ((signs >> i & 1U) != 0) sum += rank(sizes[i]);
    if (std::abs(sum - 0.5 * all) >= off - 1e-9) ++as_far;
  }
  return static_cast<double>(as_far) / static_cast<double>(std::size_t{1} << sizes.size());
}

TEST(SignedRank, IsExactWithTiesZerosAndInfinities) {
  const Stream stream(5, "bim.generate");
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    std::vector<double> differences;
    const auto n = static_cast<std::uint32_t>(1.0 + 10.0 * stream.uniform(trial));
    for (std::uint32_t i = 1; i <= n; ++i) {
      const double size = std::floor(5.0 * stream.uniform(trial, i));
      const double sign = stream.uniform(trial, i, 1) < 0.3 ? -1.0 : 1.0;
      differences.push_back(sign * (size == 4.0 ? inf : size));
    }
    EXPECT_NEAR(signed_rank_p(differences), enumerated_p(differences), 1e-12) << trial;
    std::vector<double> opposite = differences;
    for (double& d : opposite) d = -d;
    EXPECT_EQ(signed_rank_p(opposite), signed_rank_p(differences)) << trial;
  }
  EXPECT_EQ(signed_rank_p({0.0, 0.0}), 1.0);
}

/// Symmetric about `centre`: normal, or with long tails.
std::vector<double> drawn(const Stream& stream, std::uint64_t trial, std::size_t n, double centre) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < n; ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    const double size = -std::log(1.0 - stream.uniform(trial, lane, 1));
    const double laplace = stream.uniform(trial, lane, 2) < 0.5 ? -size : size;
    differences.push_back(centre + (trial % 2 == 0 ? stream.gauss(trial, lane) : laplace));
  }
  return differences;
}

// Of 4000 trials a share of 95 % has a standard deviation of 0.34 %. The interval is of whole ranks, so it may hold a
// little more than 95 %: with 6 pairs 96.9 %, with 10 pairs or more less than 96 %.
TEST(PseudoMedian, IntervalHoldsTheCentre) {
  const Stream stream(7, "bim.generate");
  for (const std::size_t n : {std::size_t{6}, std::size_t{10}, std::size_t{25}, std::size_t{60}}) {
    int held = 0;
    constexpr int trials = 4000;
    for (int trial = 0; trial < trials; ++trial) {
      const auto at = static_cast<std::uint64_t>(trial) + 10000 * n;
      const double centre = 3.0 * stream.uniform(at, 1000) - 1.0;
      const PseudoMedian shift = pseudo_median(drawn(stream, at, n, centre));
      if (shift.interval->first <= centre && centre <= shift.interval->second) ++held;
    }
    const double share = static_cast<double>(held) / trials;
    EXPECT_GT(share, 0.95 - 3.0 * 0.0034) << n;
    EXPECT_LT(share, (n == 6 ? 0.969 : 0.96) + 3.0 * 0.0034) << n;
  }
}

TEST(PseudoMedian, IntervalHoldsZeroExactlyWhereTheTestDoesNotRefuseIt) {
  const Stream stream(8, "bim.generate");
  int refused = 0;
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    const std::size_t n = 6 + trial % 40;
    const std::vector<double> differences = drawn(stream, trial, n, 0.5);
    const PseudoMedian shift = pseudo_median(differences);
    const bool holds = shift.interval->first <= 0.0 && 0.0 <= shift.interval->second;
    EXPECT_EQ(holds, signed_rank_p(differences) > 0.05) << trial;
    if (!holds) ++refused;
    std::vector<double> opposite = differences;
    for (double& d : opposite) d = -d;
    const PseudoMedian back = pseudo_median(opposite);
    EXPECT_EQ(back.value, -shift.value);
    EXPECT_EQ(back.interval->first, -shift.interval->second);
    EXPECT_EQ(back.interval->second, -shift.interval->first);
  }
  EXPECT_GT(refused, 200);
  EXPECT_LT(refused, 900);
}

TEST(PseudoMedian, OfFewAndOfInfinities) {
  EXPECT_EQ(pseudo_median({3.0}).value, 3.0);
  EXPECT_EQ(pseudo_median({1.0, 3.0}).value, 2.0);
  EXPECT_FALSE(pseudo_median({1, 2, 3, 4, 5}).interval);
  const PseudoMedian six = pseudo_median({6, 1, 2, 3, 5, 4});
  EXPECT_EQ(six.interval->first, 1.0);
  EXPECT_EQ(six.interval->second, 6.0);
  EXPECT_EQ(pseudo_median({-inf, inf}).value, 0.0);
  const PseudoMedian some_lost = pseudo_median({1, 1, 1, 1, 1, 1, inf, inf});
  EXPECT_EQ(some_lost.value, 1.0);
  EXPECT_EQ(some_lost.interval->first, 1.0);
  EXPECT_EQ(some_lost.interval->second, inf);
}

// Beyond the exact test both p and the interval are approximations that must go on where it ends.
TEST(PseudoMedian, GoesOnBeyondTheExactTest) {
  const Stream stream(9, "bim.generate");
  const std::vector<double> more = drawn(stream, 0, most_exact_pairs + 1, 0.1);
  const std::vector<double> fewer(more.begin(), more.end() - 1);
  EXPECT_NEAR(signed_rank_p(more) / signed_rank_p(fewer), 1.0, 0.15);
  EXPECT_NEAR(pseudo_median(more).value, pseudo_median(fewer).value, 0.01);
  EXPECT_NEAR(pseudo_median(more).interval->first, pseudo_median(fewer).interval->first, 0.01);
  EXPECT_NEAR(pseudo_median(more).interval->second, pseudo_median(fewer).interval->second, 0.01);
  int refused = 0;
  for (std::uint64_t trial = 1; trial <= 400; ++trial)
    if (signed_rank_p(drawn(stream, trial, 400, 0.0)) <= 0.05) ++refused;
  EXPECT_NEAR(refused, 20, 14);  // three standard deviations
}

TEST(Holm, MultipliesTheSmallestMost) {
  const std::vector<double> corrected = holm({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> by_hand = {0.03, 0.06, 0.06, 0.02};
  ASSERT_EQ(corrected.size(), by_hand.size());
  for (std::size_t i = 0; i < by_hand.size(); ++i) EXPECT_NEAR(corrected[i], by_hand[i], 1e-12) << i;
  EXPECT_EQ(holm({0.7, 0.6}), (std::vector<double>{1.0, 1.0}));
  EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
