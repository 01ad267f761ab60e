// SPDX-License-Identifier: Apache-2.0
#include "slam/process/shortened.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

TEST(Shortened, CutsBetweenCharactersAndSaysHowManyThereAre) {
  EXPECT_EQ(shortened("", 3), "");
  EXPECT_EQ(shortened("ab\u00f6", 3), "ab\u00f6");
  EXPECT_EQ(shortened("a\u00f6\u20ac\u20acb", 3), "a\u00f6\u20ac... (5 characters in all)");
  EXPECT_EQ(shortened(std::string(5'000'000, 'x'), 2000).size(), 2000 + sizeof("... (5000000 characters in all)") - 1);
}

}  // namespace
}  // namespace plumbline::slam
