// SPDX-License-Identifier: Apache-2.0
#include "bim/config/printable.h"

#include <gtest/gtest.h>

#include "bim/config/tree.h"
#include "bim/config/utf8.h"
#include "bim/random/stream.h"

namespace plumbline {
namespace {

TEST(Printable, OrdinaryTextStays) {
  for (const char* text : {"", "hall 2", "Küche", "部屋", "\xF0\x9F\x9A\xAA door", "a\\b \"c\""}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(printable_lines(text), text);
  }
}

TEST(Printable, WhatATerminalObeysIsEscaped) {
  EXPECT_EQ(printable("be\nd\x1b[31mRED\x07\x7f"), "be\\u000ad\\u001b[31mRED\\u0007\\u007f");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\u0000");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\u009b31m");  // C1: the eight-bit form of ESC [
  for (const char32_t c :
       {U'\u061C', U'\u200E', U'\u200F', U'\u2028', U'\u2029', U'\u202A', U'\u202E', U'\u2066', U'\u2069'}) {
    std::string text = "a";
    append_utf8(text, c);
    EXPECT_EQ(printable(text + "b").rfind("a\\u", 0), 0U) << static_cast<unsigned>(c);
  }
  EXPECT_EQ(printable("\xE2\x80\xAE"), "\\u202e");
  EXPECT_EQ(printable("caf\xe9 \x9b"), "caf\\u00e9 \\u009b");
}

TEST(Printable, LinesKeepTheirBreaksOnly) {
  EXPECT_EQ(printable_lines("a\nb\r\n\tc\x1b"), "a\nb\\u000d\n\\u0009c\\u001b");
}

TEST(Printable, NoByteThatATerminalObeysIsLeftOfAnyText) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    std::string text;
    for (std::uint32_t k = 0; k < 12; ++k) {
      const double kind = stream.uniform(i, k, 0), value = stream.uniform(i, k, 1);
      if (kind < 0.4)
        text += static_cast<char>(static_cast<unsigned char>(256.0 * value));
      else
        append_utf8(text, static_cast<char32_t>((kind < 0.7 ? 0x100 : 0x2100) * value));
    }
    const std::string shown = printable(text);
    EXPECT_EQ(printable(shown), shown);
    for (std::size_t at = 0; at < shown.size(); ++at) {
      const auto byte = static_cast<unsigned char>(shown[at]);
      EXPECT_TRUE(byte >= 0x20 && byte != 0x7F) << i;
    }
  }
}

/// A JSON text stays the same value.
TEST(Printable, JsonMeansTheSame) {
  const std::string name = "a\xC2\x9B\xE2\x80\xAE\x1b\nz";
  const std::string shown = printable_lines(write_json(Tree::map().set("name", name)));
  EXPECT_EQ(read_json(shown, "x").find("name")->as_string(), name);
  EXPECT_EQ(shown.find('\x1b'), std::string::npos);
  EXPECT_EQ(shown.find("\xC2\x9B"), std::string::npos);
}

}  // namespace
}  // namespace plumbline
