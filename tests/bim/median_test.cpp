// SPDX-License-Identifier: Apache-2.0
#include "bim/median.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Median, OfOddAndEvenNumbers) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(upper_median(std::vector<int>{3, 1, 2}), 2);
  EXPECT_EQ(upper_median(std::vector<int>{4, 1, 2, 3}), 3);
}

}  // namespace
}  // namespace plumbline
