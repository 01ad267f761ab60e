// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace plumbline::scenarios {

/// A file that stands while one process works in its folder. It goes away with this; that of a killed process stays,
/// and can be taken.
class FolderLock {
 public:
  /// Takes the lock, which makes the file where there is none. Nothing where another process has it. Throws
  /// EnvironmentError where the file cannot be made, in words about `folder`.
  [[nodiscard]] static std::optional<FolderLock> take(const std::string& file, const std::string& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  FolderLock(std::string file, int descriptor) : file_(std::move(file)), descriptor_(descriptor) {}

  std::string file_;
  int descriptor_;
};

}  // namespace plumbline::scenarios
