// SPDX-License-Identifier: Apache-2.0
#include "bim/config/words.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Words = std::vector<std::string_view>;

TEST(Words, StandBetweenBlanks) {
  EXPECT_EQ(split_words(" a\tbc  d\r"), (Words{"a", "bc", "d"}));
  EXPECT_EQ(split_words("a,b"), Words{"a,b"});
  for (const std::string_view none : {"", " ", "\t\r"}) EXPECT_TRUE(split_words(none).empty());
}

TEST(Words, BlanksAtTheEndsAreLeftOut) {
  EXPECT_EQ(without_blanks("\t a b \r"), "a b");
  EXPECT_EQ(without_blanks("ab"), "ab");
  for (const std::string_view none : {"", " ", "\t\r"}) EXPECT_EQ(without_blanks(none), "");
}

}  // namespace
}  // namespace plumbline
