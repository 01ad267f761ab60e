// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumbline::scenarios {

/// Where a run directory holds the recording of --record: one of its files has the name of a method's.
inline constexpr std::string_view recording_folder = "recording";

/// Writes a whole file so that it appears complete or not at all: a temporary file beside it, fsync, rename.
/// Throws EnvironmentError.
void write_file(const std::string& path, std::string_view bytes);

/// The run directory while it is being made. Files are written into a hidden folder inside it and moved into place
/// together, results.json last, so that an interrupted run leaves nothing that looks complete.
class RunDirectory {
 public:
  /// Creates `path` where needed. Throws InputError when it holds anything (unless `force` and it is a run directory)
  /// or another run is writing it; EnvironmentError when it cannot be written.
  RunDirectory(const std::string& path, bool force);
  /// Removes everything it made, unless committed.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Folder the files are written into before commit().
  [[nodiscard]] const std::string& staging() const { return staging_; }
  /// Moves all files into place; with `force`, files of the run that stood there before go first.
  void commit();

 private:
  void create();
  void discard() noexcept;

  std::string path_;
  std::string staging_;
  std::vector<std::string> created_;  ///< folders made for this run, outermost first
  int lock_ = -1;
  bool committed_ = false;
};

/// True for the names a run writes into its directory.
[[nodiscard]] bool is_run_file(std::string_view name);

}  // namespace plumbline::scenarios
