// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/process.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

TEST(Process, TunablesAreAppendedOnce) {
  const std::string ours(hwcaps_tunable);
  EXPECT_EQ(with_hwcaps(""), ours);
  EXPECT_EQ(with_hwcaps(ours), ours);
  EXPECT_EQ(with_hwcaps("glibc.malloc.check=1"), "glibc.malloc.check=1:" + ours);
  EXPECT_EQ(with_hwcaps(with_hwcaps("a=1")), with_hwcaps("a=1"));
  EXPECT_GE(allowed_cpus(), 1);
}

}  // namespace
}  // namespace plumbline::scenarios
