// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/ddmin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bim/random/stream.h"

namespace plumbline::scenarios {
namespace {

using Fails = std::function<bool(const Kept&)>;

/// Answers from a predicate, and what was asked.
struct Asked {
  Fails fails;
  std::vector<Kept> tries = {};
  std::size_t most = 1'000'000;
  std::size_t questions = 0;

  [[nodiscard]] FirstFailing oracle() {
    return [this](const KeptCandidates& candidates) -> FirstFailure {
      ++questions;
      for (std::size_t i = 0; i < candidates.count; ++i) {
        if (tries.size() >= most) return {std::nullopt, true};
        tries.push_back(candidates.at(i));
        if (fails(tries.back())) return {i};
      }
      return {};
    };
  }
};

bool has_all(const Kept& kept, const Kept& wanted) {
  return std::includes(kept.begin(), kept.end(), wanted.begin(), wanted.end());
}

/// Some of `count` parts, by a share that is drawn, too.
Kept drawn_parts(const Stream& stream, std::uint64_t tick, std::size_t count) {
  const double share = stream.uniform(tick, 0);
  Kept parts;
  for (std::size_t i = 0; i < count; ++i)
    if (stream.uniform(tick, 1, static_cast<std::uint32_t>(i)) < share) parts.push_back(i);
  return parts;
}

/// With any one part left out of it nothing fails.
void expect_one_minimal(const Kept& kept, const Fails& fails) {
  for (std::size_t i = 0; i < kept.size(); ++i) {
    Kept less = kept;
    less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(fails(less)) << "part " << kept[i];
  }
}

TEST(Ddmin, FindsExactlyThePartsThatTogetherFail) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    const std::size_t count = 1 + static_cast<std::size_t>(40.0 * stream.uniform(tick, 2));
    const Kept needed = drawn_parts(stream, tick, count);
    Asked asked{[&](const Kept& kept) { return has_all(kept, needed); }};
    EXPECT_EQ(minimize(count, asked.oracle()), needed) << tick;
  }
}

// Of several causes one is found, whole and with nothing beside it.
TEST(Ddmin, OfEitherOrItKeepsOneThatFails) {
  const Stream stream(2, "bim.generate");
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    constexpr std::size_t count = 24;
    const Kept a = drawn_parts(stream, 2 * tick, count), b = drawn_parts(stream, 2 * tick + 1, count);
    const Fails fails = [&](const Kept& kept) { return has_all(kept, a) || has_all(kept, b); };
    Asked asked{fails};
    const Kept found = minimize(count, asked.oracle());
    EXPECT_TRUE(found == a || found == b) << tick;
    expect_one_minimal(found, fails);
  }
}

// Where more parts can hide a failure, it still ends with parts that fail and of which none can go.
TEST(Ddmin, WithoutMonotonyItIsStillOneMinimal) {
  const Stream stream(3, "bim.generate");
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    constexpr std::size_t count = 16;
    const Kept needed = drawn_parts(stream, tick, count);
    const Fails fails = [&](const Kept& kept) {
      return kept.size() == count || (has_all(kept, needed) && kept.size() % 3 != 1);
    };
    Asked asked{fails};
    const Kept found = minimize(count, asked.oracle());
    EXPECT_TRUE(fails(found)) << tick;
    expect_one_minimal(found, fails);
  }
}

TEST(Ddmin, AsksForSmallerOnesOnlyAndFewTimes) {
  for (const std::size_t count : {1U, 2U, 7U, 64U, 100U}) {
    for (std::size_t needed = 0; needed < count; needed += 1 + count / 5) {
      Asked asked{[&](const Kept& kept) { return has_all(kept, {needed}); }};
      EXPECT_EQ(minimize(count, asked.oracle()), Kept{needed});
      EXPECT_LE(asked.tries.size(), 50U) << count;
      for (const Kept& kept : asked.tries) EXPECT_LT(kept.size(), count);
    }
    Asked all{[&](const Kept& kept) { return kept.size() == count; }};
    EXPECT_EQ(minimize(count, all.oracle()).size(), count);
    EXPECT_LE(all.tries.size(), 4 * count);
  }
  Asked never{[](const Kept&) { return true; }};
  EXPECT_TRUE(minimize(50, never.oracle()).empty());
  EXPECT_EQ(never.tries.size(), 1U);
}

TEST(Ddmin, WithoutTriesLeftItEndsWithWhatFailsSoFar) {
  const Kept needed = {3, 17, 18, 40};
  for (std::size_t most = 0; most < 60; ++most) {
    Asked asked{[&](const Kept& kept) { return has_all(kept, needed); }, {}, most};
    EXPECT_TRUE(has_all(minimize(50, asked.oracle()), needed)) << most;
    EXPECT_LE(asked.tries.size(), most);
  }
}

TEST(Ddmin, WithoutTriesLeftItAsksNoMore) {
  Asked asked{[](const Kept&) { return false; }, {}, 1};
  EXPECT_EQ(minimize(1000, asked.oracle()).size(), 1000U);
  EXPECT_EQ(asked.questions, 2U);
}

TEST(Ddmin, NothingToLeaveOutAsksNothing) {
  Asked asked{[](const Kept&) { return true; }};
  EXPECT_TRUE(minimize(0, asked.oracle()).empty());
  EXPECT_TRUE(asked.tries.empty());
}

}  // namespace
}  // namespace plumbline::scenarios
