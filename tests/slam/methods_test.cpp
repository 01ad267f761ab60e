// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

#include <gtest/gtest.h>

#include <ostream>

#include "bim/errors.h"
#include "tests/input_error.h"

namespace plumbline::slam {

static void PrintTo(const MethodRow& row, std::ostream* out) { *out << row.name; }

namespace {

class MethodConfigTest : public testing::TestWithParam<MethodRow> {
 protected:
  [[nodiscard]] static Tree configure(const std::string& text) {
    return GetParam().configure(read_yaml(text, "c.yaml"));
  }
};

TEST_P(MethodConfigTest, WhatIsPrintedWithDefaultsReadsBackAsTheDefaults) {
  const std::string page = schema_yaml(GetParam().config_schema().front().fields);
  EXPECT_EQ(GetParam().config_schema().size(), 1U);  // no lists of entries
  EXPECT_EQ(write_yaml(configure(page)), write_yaml(GetParam().configure({})));
  EXPECT_EQ(write_yaml(configure(write_yaml(GetParam().configure({})))), write_yaml(GetParam().configure({})));
}

TEST_P(MethodConfigTest, OneValueIsSetAndTheOthersStay) {
  const Tree tree = configure("map: {voxel_m: 0.1}");
  EXPECT_EQ(tree.find("map")->find("voxel_m")->as_double(), 0.1);
  EXPECT_EQ(tree.find("map")->find("max_range_m")->as_double(), 25.0);
}

TEST_P(MethodConfigTest, WrongKeysAndValuesAreNamed) {
  const auto complaint = [](const std::string& text) {
    return input_error([&] { static_cast<void>(configure(text)); });
  };
  EXPECT_NE(complaint("map: {voxel: 0.1}").find("'voxel_m'"), std::string::npos);
  EXPECT_EQ(complaint("map: {voxel_m: 0}").rfind("c.yaml:1:", 0), 0U);
  EXPECT_EQ(complaint("map: {voxel_m: wide}").rfind("c.yaml:1:", 0), 0U);
  EXPECT_NE(complaint("[1, 2]"), "no error");
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodConfigTest, testing::ValuesIn(methods().begin(), methods().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(Methods, AFormerNameIsNoName) {
  for (const MethodRow& row : methods())
    if (!row.former.empty()) {
      EXPECT_EQ(find_method(row.former), nullptr) << row.former;
    }
  EXPECT_EQ(find_method("keyframe_graph")->former, "hdl_slam");
  EXPECT_EQ(find_method("s_graphs_plus_all_walls")->former, "s_graphs_plus_paper");
}

TEST(Methods, ARenamedMethodKeepsItsSeed) {
  EXPECT_EQ(seed_name(*find_method("vgicp")), "vgicp");
  EXPECT_EQ(seed_name(*find_method("s_graphs_plus_all_walls")), "s_graphs_plus_paper");
}

}  // namespace
}  // namespace plumbline::slam
