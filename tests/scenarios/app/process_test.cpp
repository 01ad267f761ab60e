// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/process.h"

#include <gtest/gtest.h>
#include <sched.h>

namespace plumbline::scenarios {
namespace {

TEST(Process, TunablesAreAppendedOnce) {
  const std::string ours(hwcaps_tunable);
  EXPECT_EQ(with_hwcaps(""), ours);
  EXPECT_EQ(with_hwcaps(ours), ours);
  EXPECT_EQ(with_hwcaps("glibc.malloc.check=1"), "glibc.malloc.check=1:" + ours);
  EXPECT_EQ(with_hwcaps(with_hwcaps("a=1")), with_hwcaps("a=1"));
}

TEST(Process, AllowedCpusAreThoseOfTheAffinityMask) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  EXPECT_EQ(allowed_cpus(), CPU_COUNT(&before));
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(allowed_cpus(), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
}

}  // namespace
}  // namespace plumbline::scenarios
