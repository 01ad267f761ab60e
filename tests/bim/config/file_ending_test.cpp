// SPDX-License-Identifier: Apache-2.0
#include "bim/config/file_ending.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(FileEnding, IsFoundInAnyCase) {
  for (const char* name : {"a.pcd", "a.PCD", "/B/a.Pcd", ".pcd"}) EXPECT_TRUE(has_ending(name, ".pcd")) << name;
  for (const char* name : {"a.pcd.gz", "pcd", "", "a.pc", "a.ply"}) EXPECT_FALSE(has_ending(name, ".pcd")) << name;
}

}  // namespace
}  // namespace plumbline
