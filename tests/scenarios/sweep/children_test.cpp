// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/children.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace plumbline::scenarios {
namespace {

TEST(Children, TheProgramBrokeOrTheSystemFailedIt) {
  const ChildEnd internal{3, "plumbline: internal error: a result is not a finite number"};
  const ChildEnd memory{3, "plumbline: internal error: std::bad_alloc"};
  const ChildEnd disk{3, "out/run: cannot be written: No space left on device"};
  EXPECT_TRUE(broke(internal));
  EXPECT_FALSE(is_of_environment(internal));
  EXPECT_FALSE(broke(memory));
  EXPECT_FALSE(broke(disk));
  EXPECT_TRUE(is_of_environment(disk));
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) EXPECT_TRUE(broke({128 + signal, ""})) << signal;
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) EXPECT_FALSE(broke({128 + signal, ""})) << signal;
  for (const int code : {0, 1, 2, 4}) EXPECT_FALSE(broke({code, "plumbline: internal error: none"})) << code;
}

}  // namespace
}  // namespace plumbline::scenarios
