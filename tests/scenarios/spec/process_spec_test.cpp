// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/process_spec.h"

#include <gtest/gtest.h>

#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

using Words = std::vector<std::string>;

TEST(ProcessSpec, ACommandIsSplitAtSpacesOutsideOfQuotes) {
  const std::optional<ProcessSpec> process = process_of("mine='my slam/run'  --voxel \"0.3 m\"", "/here");
  ASSERT_TRUE(process);
  EXPECT_EQ(process->name, "mine");
  EXPECT_EQ(process->command, (Words{"my slam/run", "--voxel", "0.3 m"}));
  EXPECT_EQ(process->folder, "/here");
  EXPECT_EQ(process_of("vgicp", "/here"), std::nullopt);
}

TEST(ProcessSpec, ACommandWithoutAProgramIsRefused) {
  for (const char* text : {"mine=", "mine=  ", "mine=''", "mine='' --voxel"})
    EXPECT_EQ(input_error([&] { (void)process_of(text, "/here"); }),
              "--method: names no program; say what starts your method, as in python3 my_slam.py")
        << text;
}

TEST(ProcessSpec, AFolderIsNoProgram) {
  const Folder folder;
  EXPECT_EQ(input_error([&] {
              check_program({"./"}, folder.path(), {"--method", 0, 0});
            }),
            "--method: './' is no program: it is a folder");
}

}  // namespace
}  // namespace plumbline::scenarios
