// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_string.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

std::string back(const std::string& text) {
  const std::string quoted = step_string(text);
  EXPECT_EQ(quoted.front(), '\'');
  EXPECT_EQ(quoted.back(), '\'');
  for (const char c : quoted) EXPECT_TRUE(c >= 0x20 && c < 0x7F) << quoted;
  return text_of_step(std::string_view(quoted).substr(1, quoted.size() - 2));
}

TEST(StepString, ComesBack) {
  for (const char* text : {"", "wall", "Tür 'links'", "a\\b", "\\X2\\", "''", "'", "\\", "zwei\nZeilen\t\r", "🏠",
                           "日本🏠é", "\\X\\41", "\\S\\a", "#12=IFCWALL();/* */", "\x7F"})
    EXPECT_EQ(back(text), text);
}

TEST(StepString, RandomTextComesBack) {
  constexpr std::array<const char*, 12> pieces{"a", "'", "\\", "ü", "€", "🏠", "\n", "X2", "X0", "\\X2\\", "S", " "};
  const Stream random(2, "bim.generate");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    std::string text;
    for (std::uint32_t k = 0; k < random.bits(i, 0) % 12; ++k) text += pieces[random.bits(i, 1, k) % pieces.size()];
    ASSERT_EQ(back(text), text);
  }
}

TEST(StepString, WritesWhatOtherProgramsRead) {
  EXPECT_EQ(step_string("Küche's"), "'K\\X2\\00FC\\X0\\che''s'");
  EXPECT_EQ(step_string("é🏠"), "'\\X2\\00E9\\X0\\\\X4\\0001F3E0\\X0\\'");
}

TEST(StepString, ReadsWhatOtherProgramsWrite) {
  EXPECT_EQ(text_of_step("\\X\\FCber"), "über");
  EXPECT_EQ(text_of_step("\\S\\|ber"), "über");
  EXPECT_EQ(text_of_step("\\X2\\D83CDFE0\\X0\\"), "🏠");
}

TEST(StepString, BytesThatNobodyEscapedAreUtf8OrLatin1) {
  EXPECT_EQ(text_of_step("Küche"), "Küche");
  EXPECT_EQ(text_of_step("K\xFC"
                         "che"),
            "Küche");
}

TEST(StepString, BadBytesAndEscapesDoNoHarm) {
  EXPECT_EQ(back("a\xFFz"), "a\xEF\xBF\xBDz");
  EXPECT_EQ(back("\xC3"), "\xEF\xBF\xBD");
  EXPECT_EQ(back("\xED\xA0\x80").substr(0, 3), "\xEF\xBF\xBD");  // a surrogate
  for (const char* text : {"\\X2\\00", "\\X2\\0G00\\X0\\", "\\X\\", "\\X\\ZZ", "\\S\\", "\\P", "\\"})
    EXPECT_EQ(text_of_step(text), text);
}

TEST(StepReal, HasAPointAndComesBack) {
  EXPECT_EQ(step_real(0.0), "0.");
  EXPECT_EQ(step_real(-0.0), "0.");
  EXPECT_EQ(step_real(3.0), "3.");
  EXPECT_EQ(step_real(1e-7), "1.E-07");
  EXPECT_EQ(step_real(-1.5e300), "-1.5E+300");
  const Stream random(3, "bim.generate");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double v = random.gauss(i) * std::pow(10.0, 30.0 * random.uniform(i, 1) - 15.0);
    const std::string text = step_real(v);
    ASSERT_NE(text.find('.'), std::string::npos) << text;
    ASSERT_EQ(std::strtod(text.c_str(), nullptr), v) << text;
  }
  EXPECT_THROW((void)step_real(std::nan("")), InternalError);
}

}  // namespace
}  // namespace plumbline::bim
