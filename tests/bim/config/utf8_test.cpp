// SPDX-License-Identifier: Apache-2.0
#include "bim/config/utf8.h"

#include <gtest/gtest.h>

#include <array>

#include "bim/random/stream.h"

namespace plumbline {
namespace {

TEST(Utf8, EveryCharacterIsWrittenAndMeasured) {
  for (char32_t c = 0; c <= 0x110000; ++c) {
    std::string text;
    append_utf8(text, c);
    ASSERT_EQ(utf8_length(text), text.size()) << static_cast<unsigned>(c);
    ASSERT_EQ(text.size(), c < 0x80 ? 1U : c < 0x800 ? 2U : c < 0x10000 || c > 0x10FFFF ? 3U : 4U);
    const bool none = c > 0x10FFFF || (c >= 0xD800 && c <= 0xDFFF);
    ASSERT_EQ(text == "\xEF\xBF\xBD", none || c == 0xFFFD);
  }
}

TEST(Utf8, BytesOfUnknownEncoding) {
  EXPECT_EQ(utf8_of_bytes("K\xFC"
                          "che"),
            "Küche");
  EXPECT_EQ(utf8_of_bytes("Küche"), "Küche");
  EXPECT_EQ(utf8_of_bytes("Erdgescho\xDF"), "Erdgeschoß");
  EXPECT_EQ(utf8_of_bytes("\xC3"), "Ã");
  EXPECT_EQ(utf8_of_bytes(""), "");
}

TEST(Utf8, TheByteOrderMarkIsLeftOutOnce) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF"
                                    "a"),
            "a");
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF\xEF\xBB\xBF"), "\xEF\xBB\xBF");
  for (const std::string_view plain : {"", "a", "\xEF\xBB"}) EXPECT_EQ(without_byte_order_mark(plain), plain);
}

TEST(Utf8, AnyBytesBecomeUtf8OnceAndForAll) {
  const Stream random(4, "bim.generate");
  for (std::uint64_t i = 0; i < 5000; ++i) {
    std::string bytes;
    for (std::uint32_t k = 0; k < random.bits(i, 0) % 12; ++k) bytes += static_cast<char>(random.bits(i, 1, k) & 0xFFU);
    const std::string text = utf8_of_bytes(bytes);
    for (std::string_view rest = text; !rest.empty(); rest.remove_prefix(utf8_length(rest)))
      ASSERT_NE(utf8_length(rest), 0U);
    ASSERT_EQ(utf8_of_bytes(text), text);
  }
}

}  // namespace
}  // namespace plumbline
