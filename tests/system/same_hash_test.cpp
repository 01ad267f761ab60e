// SPDX-License-Identifier: Apache-2.0
// What is read from a file is the same in every process, wherever its memory lies.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/data.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

class SameHash : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }

  static std::string hash_of(const std::string& building, const std::vector<std::string>& wrapper = {}) {
    Setting setting;
    setting.wrapper = wrapper;
    const Outcome outcome = plumbline({"inspect", building, "--json"}, setting);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::size_t at = outcome.out.find("\"hash\": \"");
    EXPECT_NE(at, std::string::npos);
    return at == std::string::npos ? std::string() : outcome.out.substr(at + 9, 16);
  }

  /// Half of the processes get the same addresses each time, where the machine allows it.
  static void expect_same(const std::string& building, int processes) {
    const std::string first = hash_of(building);
    EXPECT_EQ(first.size(), 16u);
    for (int i = 1; i < processes / 2; ++i) EXPECT_EQ(hash_of(building), first) << building;
    const std::vector<std::string> fixed = {"setarch", "-R"};
    Setting setting;
    setting.wrapper = fixed;
    if (plumbline({"--version"}, setting).code != 0) {
      std::cout << "setarch -R may not run here; addresses stay random for " << building << "\n";
      return;
    }
    for (int i = 0; i < processes / 2; ++i) EXPECT_EQ(hash_of(building, fixed), first) << building;
  }

  static void expect_same_of_data(const std::string& name) {
    if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
    expect_same(data_path(name), 6);
  }
};

/// Read as any IFC, since the name of the project in it is not the one its digest was made of.
TEST_F(SameHash, OfWrittenIfc) {
  const Folder folder;
  const std::string path = folder / "short.ifc";
  ASSERT_EQ(plumbline({"inspect", project_file("tests/system/short.plan.yaml"), "--ifc", path}).code, 0);
  expect_same(path, 4);
  std::string text = read_file(path);
  const std::size_t project = text.find("=IFCPROJECT(");
  ASSERT_NE(project, std::string::npos);
  const std::size_t name = text.find("'short'", project);
  ASSERT_NE(name, std::string::npos);
  write_file(path, text.replace(name, 7, "'edited'"));
  expect_same(path, 20);
}

TEST_F(SameHash, OfTwinFlats) { expect_same_of_data("ifc/twin_flats.ifc"); }
TEST_F(SameHash, OfGableHouse) { expect_same_of_data("ifc/gable_house.ifc"); }
TEST_F(SameHash, OfDuplex) { expect_same_of_data("ifc/duplex.ifc"); }
TEST_F(SameHash, OfFzkHaus) { expect_same_of_data("ifc/AC20-FZK-Haus.ifc"); }

}  // namespace
}  // namespace plumbline::system_tests
