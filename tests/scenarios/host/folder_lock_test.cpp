// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/folder_lock.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bim/errors.h"
#include "tests/folder.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

TEST(FolderLock, OneHasItAtATimeAndNothingStays) {
  const Folder folder;
  const std::string file = folder / "lock";
  {
    std::optional<FolderLock> first = FolderLock::take(file, folder.path());
    ASSERT_TRUE(first);
    EXPECT_TRUE(fs::exists(file));
    EXPECT_FALSE(FolderLock::take(file, folder.path()));
    EXPECT_TRUE(fs::exists(file));  // who did not get it leaves it
    const FolderLock moved = std::move(*first);
    first.reset();
    EXPECT_FALSE(FolderLock::take(file, folder.path()));
  }
  EXPECT_FALSE(fs::exists(file));
  EXPECT_TRUE(FolderLock::take(file, folder.path()));
}

TEST(FolderLock, ThatOfAKilledProcessIsTaken) {
  const Folder folder;
  std::ofstream(folder / "lock") << "";
  { EXPECT_TRUE(FolderLock::take(folder / "lock", folder.path())); }
  EXPECT_FALSE(fs::exists(folder / "lock"));
}

/// Who has the lock of a removed file removes none that another made since.
TEST(FolderLock, ARemovedFileIsAnothersToMake) {
  const Folder folder;
  const std::string file = folder / "lock";
  std::optional<FolderLock> old = FolderLock::take(file, folder.path());
  fs::remove(file);
  const std::optional<FolderLock> fresh = FolderLock::take(file, folder.path());
  ASSERT_TRUE(fresh);
  old.reset();
  EXPECT_TRUE(fs::exists(file));
}

TEST(FolderLock, SaysWhyItCannotBeMade) {
  const Folder folder;
  EXPECT_THROW((void)FolderLock::take(folder / "none/lock", "here"), EnvironmentError);
}

}  // namespace
}  // namespace plumbline::scenarios
