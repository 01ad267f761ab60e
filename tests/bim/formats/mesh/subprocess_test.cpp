// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/subprocess.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "tests/sanitized.h"

namespace plumbline::bim {
namespace {

TEST(Isolated, GivesBackWhatTheTaskGives) {
  EXPECT_EQ(run_in_subprocess([] { return std::string("answer"); }), "answer");
  EXPECT_EQ(run_in_subprocess([] { return std::string(); }), "");
  const std::string large(3'000'000, 'x');
  EXPECT_EQ(run_in_subprocess([&] { return large; }), large);
}

TEST(Isolated, SurvivesWhatTheTaskDoesNot) {
  EXPECT_FALSE(run_in_subprocess([]() -> std::string { throw std::runtime_error("thrown"); }));
  EXPECT_FALSE(run_in_subprocess([]() -> std::string { std::abort(); }));
  EXPECT_FALSE(run_in_subprocess([]() -> std::string {
    (void)std::raise(SIGSEGV);
    return "";
  }));
  EXPECT_FALSE(run_in_subprocess([]() -> std::string { std::_Exit(0); }));
}

TEST(Isolated, BoundsTimeMemoryAndAnswer) {
  SubprocessLimits config;
  config.cpu_s = 1;
  EXPECT_FALSE(run_in_subprocess(
      []() -> std::string {
        volatile int forever = 1;
        while (forever == 1) {
        }
        return "";
      },
      config));
  if (!is_sanitized)
    EXPECT_FALSE(run_in_subprocess([] {
      const volatile std::size_t size = std::size_t{4} << 30U;  // clang 14 would try to hold what is constant
      return std::to_string(std::vector<char>(size, 'x').size());
    }));
  config.answer = 100;
  EXPECT_FALSE(run_in_subprocess([] { return std::string(1000, 'x'); }, config));
}

/// One that waits spends no CPU time.
TEST(Isolated, BoundsTheTimeThatPasses) {
  SubprocessLimits config;
  config.wall_s = 1;
  EXPECT_FALSE(run_in_subprocess(
      [] {
        for (int left = 60; left > 0;) left = static_cast<int>(::sleep(static_cast<unsigned>(left)));
        return std::string("slept");
      },
      config));
}

TEST(Isolated, BoundsGrowWithTheFile) {
  const SubprocessLimits least;
  EXPECT_EQ(subprocess_limits(0).cpu_s, least.cpu_s);
  EXPECT_EQ(subprocess_limits(0).memory, least.memory);
  const std::size_t largest = std::size_t{256} << 20U;
  EXPECT_EQ(subprocess_limits(largest).cpu_s, least.cpu_s + 128);
  EXPECT_EQ(subprocess_limits(largest).wall_s, least.wall_s + 3 * 128);
  EXPECT_EQ(subprocess_limits(largest).memory, least.memory + 32 * largest);
}

}  // namespace
}  // namespace plumbline::bim
