// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/deflate.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::scenarios {
namespace {

TEST(Deflate, GivesBackWhatItTook) {
  std::string bytes;
  for (int i = 0; i < 100'000; ++i) bytes += static_cast<char>(i * i >> 5);
  for (const std::size_t size : {0UL, 1UL, 1000UL, 100'000UL}) {
    const std::string some = bytes.substr(0, size);
    EXPECT_EQ(inflated(deflated(some), size), some);
  }
  EXPECT_THROW((void)inflated(deflated("abc"), 4), InternalError);
  EXPECT_THROW((void)inflated("\xff\xff", 4), InternalError);
}

TEST(Base64, IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace plumbline::scenarios
