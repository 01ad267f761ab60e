// SPDX-License-Identifier: Apache-2.0
#include "bim/config/installed_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace plumbline {
namespace {

TEST(InstalledFolder, IsTheFirstThatHoldsTheFile) {
  namespace fs = std::filesystem;
  const fs::path program = fs::read_symlink("/proc/self/exe"), here = program.parent_path();
  const std::string name = program.filename();
  EXPECT_EQ(fs::path(installed_folder({"no/such", "."}, name.c_str())) / name, here / name);
  const std::string around = "../" + here.filename().string();
  EXPECT_EQ(fs::path(installed_folder({around.c_str(), "."}, name.c_str())) / name, here / name);
  EXPECT_EQ(installed_folder({"."}, "no_such_file"), "");
  EXPECT_EQ(installed_folder({}, name.c_str()), "");
}

}  // namespace
}  // namespace plumbline
