// SPDX-License-Identifier: Apache-2.0
#include "bim/digest/digest.h"

#include <gtest/gtest.h>

#include <limits>

#include "bim/errors.h"

namespace plumbline {
namespace {

TEST(Digest, CountsNegativeZeroAsZero) { EXPECT_EQ(Digest().add(0.0).value(), Digest().add(-0.0).value()); }

TEST(Digest, DependsOnOrder) { EXPECT_NE(Digest().add(1.0).add(2.0).value(), Digest().add(2.0).add(1.0).value()); }

TEST(Digest, RefusesNotANumber) {
  Digest digest;
  EXPECT_THROW(digest.add(std::numeric_limits<double>::quiet_NaN()), InternalError);
}

TEST(Digest, HexHasSixteenDigits) { EXPECT_EQ(hex64(0x1fULL), "000000000000001f"); }

}  // namespace
}  // namespace plumbline
