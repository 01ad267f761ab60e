// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/bag_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/folder.h"

namespace plumbline::slam {
namespace {

using Names = std::vector<std::string>;

BagFiles found_among(const Names& names) {
  const Folder folder;
  for (const std::string& name : names) std::ofstream(folder / name) << "x";
  return find_bag_files(folder.path());
}

TEST(BagFiles, AreOneOrNumbered) {
  EXPECT_EQ(found_among({"walk.mcap"}).names, Names{"walk.mcap"});
  EXPECT_EQ(found_among({"walk_3.mcap", "notes.txt"}).names, Names{"walk_3.mcap"});
  const BagFiles split = found_among({"w_10.db3", "w_0.db3", "w_2.db3", "w_1.db3"});
  EXPECT_EQ(split.names, (Names{"w_0.db3", "w_1.db3", "w_2.db3", "w_10.db3"}));
  EXPECT_EQ(split.missing, "w_3.db3");
  EXPECT_EQ(found_among({"w_0.db3", "w_1.db3"}).missing, "");
  EXPECT_EQ(found_among({"WALK.DB3"}).names, Names{"WALK.DB3"});
  EXPECT_EQ(found_among({"Walk.MCAP", "notes.TXT"}).names, Names{"Walk.MCAP"});
}

TEST(BagFiles, OfDifferentBagsAreNone) {
  for (const Names& names : {Names{"a_0.db3", "b_1.db3"}, Names{"a_0.db3", "a_1.mcap"}, Names{"a.db3", "a_0.db3"},
                             Names{"a.mcap", "b.mcap"}, Names{"_.db3", "a_99999999999.db3"}}) {
    EXPECT_TRUE(found_among(names).names.empty()) << names.front();
    EXPECT_NE(found_among(names).several.find(" and "), std::string::npos) << names.front();
  }
}

TEST(BagFiles, TwoOfDifferentBagsAreNamed) {
  EXPECT_EQ(found_among({"a_0.db3", "other.db3"}).several, "'other.db3' and 'a_0.db3'");
  EXPECT_EQ(found_among({"a_0.db3", "b_1.db3"}).several, "'a_0.db3' and 'b_1.db3'");
}

TEST(BagFiles, AreNoneWhereTheFolderSaysWhatItIs) {
  for (const char* says : {"metadata.yaml", "recording.yaml"}) {
    EXPECT_TRUE(found_among({"a.mcap", says}).names.empty());
    EXPECT_TRUE(found_among({"a.mcap", "b.mcap", says}).several.empty());
  }
  EXPECT_TRUE(find_bag_files("/no/such/folder").names.empty());
}

}  // namespace
}  // namespace plumbline::slam
