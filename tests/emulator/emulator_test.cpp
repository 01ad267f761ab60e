// SPDX-License-Identifier: Apache-2.0
// The promise of the same bytes on every x86-64 CPU, held against an emulated one without AVX and FMA.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

constexpr const char* emulator = "/usr/bin/qemu-x86_64";
// An exec under user-mode emulation goes on natively, so the value that the program would set for itself is set here.
constexpr const char* tunables = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX,-AVX2_Usable,-FMA_Usable";

TEST(Emulator, SameBytesOnACpuWithoutAvx) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  if (!std::filesystem::exists(emulator)) GTEST_SKIP() << "no " << emulator << "; package qemu-user";
  const Folder folder;
  const std::string input = project_file("tests/system/emulated.yaml");

  Setting emulated;
  emulated.wrapper = {emulator, "-cpu", "Nehalem"};
  emulated.env["GLIBC_TUNABLES"] = tunables;
  const Outcome there = plumbline({"run", input, "--out", folder / "there"}, emulated);
  ASSERT_EQ(there.code, 0) << there.err;
  const auto timings = nlohmann::json::parse(read_file(folder / "there/timings.json"));
  const std::string features = timings["cpu_features"];
  ASSERT_EQ(features.find("avx"), std::string::npos) << "the emulated CPU shows " << features;
  ASSERT_NE(features.find("sse"), std::string::npos) << "the emulated CPU shows " << features;

  const Outcome here = plumbline({"run", input, "--out", folder / "here"});
  ASSERT_EQ(here.code, 0) << here.err;
  for (const char* name : {"results.json", "digests.csv", "report.html"})
    EXPECT_TRUE(read_file(folder / (std::string("here/") + name)) == read_file(folder / (std::string("there/") + name)))
        << name;
  EXPECT_GT(read_file(folder / "here/digests.csv").size(), 1000U);
}

}  // namespace
}  // namespace plumbline::system_tests
