// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/children.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "scenarios/host/interrupt.h"

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

/// What the parent does before its only child ends; another thread gets the signal, as it may.
[[noreturn]] void interrupt_from_another_thread() {
  catch_interrupts();
  std::thread other([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // until the parent waits
    ::pthread_kill(::pthread_self(), SIGTERM);
  });
  other.detach();
  try {
    run_children(
        1, 1,
        [](std::size_t) {
          return std::vector<std::string>{"-c", "exec sleep 20"};
        },
        [](std::size_t, const ChildEnd&) { std::_Exit(1); }, "/bin/sh");
  } catch (const Interrupted&) {
    std::_Exit(0);
  }
  std::_Exit(2);
}

TEST(Children, ASignalIsHeardWhileAChildRuns) {
  EXPECT_EXIT(interrupt_from_another_thread(), ::testing::ExitedWithCode(0), "");
}

TEST(Children, EachThatEndsIsTold) {
  std::vector<int> codes(5, -1);
  run_children(
      codes.size(), 2,
      [](std::size_t i) {
        return std::vector<std::string>{"-c", "echo line " + std::to_string(i) + " >&2; exit " + std::to_string(i)};
      },
      [&](std::size_t i, const ChildEnd& end) {
        codes[i] = end.code;
        EXPECT_EQ(end.last_line, "line " + std::to_string(i));
      },
      "/bin/sh");
  EXPECT_EQ(codes, (std::vector<int>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace plumbline::scenarios
