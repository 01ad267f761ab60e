// SPDX-License-Identifier: Apache-2.0
#include "slam/process/search_path.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace plumbline::slam {
namespace {

TEST(SearchPath, IsThatOfTheEnvironmentInItsOrder) {
  const char* before = std::getenv("PATH");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("PATH", "/b:/a::c", 1);
  EXPECT_EQ(search_path("/here"), (std::vector<std::string>{"/b", "/a", "/here", "c"}));
  ::unsetenv("PATH");
  EXPECT_EQ(search_path("/here"), (std::vector<std::string>{"/bin", "/usr/bin"}));
  if (before != nullptr) ::setenv("PATH", kept.c_str(), 1);
}

}  // namespace
}  // namespace plumbline::slam
