// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/global_id.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

TEST(GlobalId, ComesBackAtRandomBits) {
  const Stream random(1, "bim.generate");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const IdBits bits{random.bits(i, 0), random.bits(i, 1)};
    const std::string text = global_id(bits);
    ASSERT_EQ(text.size(), 22u);
    ASSERT_TRUE(text.front() >= '0' && text.front() <= '3') << text;
    ASSERT_EQ(global_id_bits(text), bits) << text;
  }
}

TEST(GlobalId, ExtremesAndOneKnown) {
  EXPECT_EQ(global_id({0, 0}), "0000000000000000000000");
  EXPECT_EQ(global_id({~0ULL, ~0ULL}), "3$$$$$$$$$$$$$$$$$$$$$");
  EXPECT_EQ(global_id({0, 64}), "0000000000000000000010");
  const std::string of_duplex = "2O2Fr$t4X7Zf8NOew3FNbT";
  ASSERT_TRUE(global_id_bits(of_duplex));
  EXPECT_EQ(global_id(*global_id_bits(of_duplex)), of_duplex);
}

TEST(GlobalId, OtherTextIsNone) {
  for (const char* text : {"", "wall", "4000000000000000000000", "000000000000000000000", "00000000000000000000000",
                           "00000000000000000000-0", "0000000000000000000 00"})
    EXPECT_FALSE(global_id_bits(text)) << text;
}

}  // namespace
}  // namespace plumbline::bim
