// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "bim/errors.h"
#include "scenarios/host/files.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

SweepFolder::SweepFolder(const std::string& path) : path_(path) {
  const auto known = [](const std::string& name) {
    const auto rows = files_of(DirectoryKind::sweep);
    return name == ".work" || name == ".lock" ||
           std::any_of(rows.begin(), rows.end(), [&](const FileRow& row) { return row.name == name; });
  };
  std::error_code error;
  if (fs::exists(path) && !fs::is_directory(path))
    throw InputError({path, 0, 0}, "is a file; --out must name a directory");
  if (fs::exists(path))
    for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
      const std::string name = it->path().filename().string();
      if (!known(name) && it->path().extension() != ".tmp")
        throw InputError({path, 0, 0}, "holds '" + name + "', which no sweep wrote; name another --out");
    }
  made_ = make_folders(results(), path);
  take_lock();
  fs::remove_all(work(), error);
  fs::create_directory(work(), error);
  if (error) throw EnvironmentError(path + ": cannot be written: " + error.message());
}

SweepFolder::~SweepFolder() {
  std::error_code error;
  fs::remove_all(work(), error);
  lock_.reset();
  remove_made();
}

void SweepFolder::take_lock() {
  try {
    lock_ = FolderLock::take(path_ + "/.lock", path_);
  } catch (const EnvironmentError&) {
    remove_made();
    throw;
  }
  if (!lock_) throw InputError({path_, 0, 0}, "another sweep is writing here; name another --out");
}

void SweepFolder::remove_made() const {
  std::error_code error;
  for (auto it = made_.rbegin(); it != made_.rend(); ++it) fs::remove(*it, error);
}

}  // namespace plumbline::scenarios
