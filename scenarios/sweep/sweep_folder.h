// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/host/folder_lock.h"
#include "scenarios/sweep/sweep_file.h"

namespace plumbline::scenarios {

/// The folder of a sweep; one process at a time writes there. What it makes and leaves empty goes with this object.
class SweepFolder {
 public:
  /// Throws InputError where a file or something that no sweep wrote stands there, or another sweep writes there, and
  /// EnvironmentError where it cannot be written.
  explicit SweepFolder(const std::string& path);
  ~SweepFolder();
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  [[nodiscard]] std::string results() const { return path_ + "/results"; }
  [[nodiscard]] std::string work() const { return path_ + "/.work"; }
  [[nodiscard]] std::string page(const std::string& key) const { return path_ + "/pages/" + key; }
  [[nodiscard]] std::string result(const SweepRun& run) const { return results() + "/" + run.key + ".json"; }

 private:
  void take_lock();
  /// What is empty of it, as where the first run was refused.
  void remove_made() const;

  std::string path_;
  std::optional<FolderLock> lock_;
  std::vector<std::string> made_;  ///< folders that were not there, outermost first
};

}  // namespace plumbline::scenarios
