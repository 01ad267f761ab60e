// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/subprocess.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "bim/errors.h"
#include "bim/formats/mesh/mesh_file.h"
#include "tests/sanitized.h"

namespace plumbline::bim {
namespace {

std::optional<std::string> answer_of(const std::function<std::string()>& task) {
  return run_in_subprocess(task).answer;
}

SubprocessEnd end_of(const std::function<std::string()>& task, const SubprocessLimits& config = {}) {
  return run_in_subprocess(task, config).end;
}

TEST(Isolated, GivesBackWhatTheTaskGives) {
  EXPECT_EQ(answer_of([] { return std::string("answer"); }), "answer");
  EXPECT_EQ(answer_of([] { return std::string(); }), "");
  const std::string large(3'000'000, 'x');
  EXPECT_EQ(answer_of([&] { return large; }), large);
}

TEST(Isolated, SurvivesWhatTheTaskDoesNot) {
  EXPECT_EQ(end_of([]() -> std::string { throw std::runtime_error("thrown"); }), SubprocessEnd::failed);
  EXPECT_EQ(end_of([]() -> std::string { std::abort(); }), SubprocessEnd::failed);
  EXPECT_EQ(end_of([]() -> std::string {
              (void)std::raise(SIGSEGV);
              return "";
            }),
            SubprocessEnd::failed);
  EXPECT_EQ(end_of([]() -> std::string { std::_Exit(0); }), SubprocessEnd::failed);
}

TEST(Isolated, BoundsTimeMemoryAndAnswer) {
  SubprocessLimits config;
  config.cpu_s = 1;
  EXPECT_EQ(end_of(
                []() -> std::string {
                  volatile int forever = 1;
                  while (forever == 1) {
                  }
                  return "";
                },
                config),
            SubprocessEnd::out_of_cpu_time);
  if (!is_sanitized)
    EXPECT_EQ(end_of([] {
                const volatile std::size_t size = std::size_t{4} << 30U;  // clang 14 would try to hold what is constant
                return std::to_string(std::vector<char>(size, 'x').size());
              }),
              SubprocessEnd::failed);
  config.answer = 100;
  EXPECT_EQ(end_of([] { return std::string(1000, 'x'); }, config), SubprocessEnd::failed);
}

/// One that waits spends no CPU time.
TEST(Isolated, BoundsTheTimeThatPasses) {
  SubprocessLimits config;
  config.wall_s = 1;
  EXPECT_EQ(end_of(
                [] {
                  for (int left = 60; left > 0;) left = static_cast<int>(::sleep(static_cast<unsigned>(left)));
                  return std::string("slept");
                },
                config),
            SubprocessEnd::out_of_wall_time);
}

TEST(Isolated, BoundsGrowWithTheFile) {
  const SubprocessLimits least;
  EXPECT_EQ(subprocess_limits(0).cpu_s, least.cpu_s);
  EXPECT_EQ(subprocess_limits(0).memory, least.memory);
  const std::size_t largest = std::size_t{256} << 20U;
  EXPECT_EQ(subprocess_limits(largest).cpu_s, least.cpu_s + 128);
  EXPECT_EQ(subprocess_limits(largest).wall_s, least.wall_s + 20 * 128);
  EXPECT_EQ(subprocess_limits(largest).memory, least.memory + 32 * largest);
}

/// Its file is good: the message must not say otherwise, and the exit code be that of the machine.
TEST(Isolated, AMeshThatABusyMachineDoesNotReadInTimeIsNotRefused) {
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(read_mesh_parts(mesh, "a.obj").size(), 1U);
  MeshFileConfig config;
  config.subprocess.wall_s = 1e-6;
  try {
    (void)read_mesh_parts(mesh, "a.obj", config);
    FAIL() << "read in no time";
  } catch (const EnvironmentError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("a.obj: reading it took more than 1e-06 s", 0), 0U) << error.what();
  }
}

}  // namespace
}  // namespace plumbline::bim
