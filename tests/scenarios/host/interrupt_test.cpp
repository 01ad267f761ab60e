// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/interrupt.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

namespace plumbline::scenarios {
namespace {

/// What never asks whether a signal came.
[[noreturn]] void work_for_ever(int signal) {
  exit_on_interrupts();
  (void)std::raise(signal);
  volatile int forever = 1;
  while (forever == 1) continue;
  std::abort();
}

TEST(Interrupt, WorkThatHasWrittenNothingEndsAtOnce) {
  const char* const message = "plumbline: interrupted; nothing was written";
  EXPECT_EXIT(work_for_ever(SIGINT), testing::ExitedWithCode(130), message);
  EXPECT_EXIT(work_for_ever(SIGTERM), testing::ExitedWithCode(143), message);
}

TEST(Interrupt, AfterItASignalIsFoundWhereItIsAskedFor) {
  const auto caught = [] {
    exit_on_interrupts();
    catch_interrupts();
    (void)std::raise(SIGINT);
    try {
      check_interrupt();
    } catch (const Interrupted& interrupted) {
      std::_Exit(interrupted.signal());
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(caught(), testing::ExitedWithCode(SIGINT), "");
}

}  // namespace
}  // namespace plumbline::scenarios
