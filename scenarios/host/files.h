// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/host/folder_lock.h"

namespace plumbline::scenarios {

/// Where a run directory holds the recording of --record: one of its files has the name of a method's.
inline constexpr std::string_view recording_folder = "recording";

/// Writes a whole file so that it appears complete or not at all: a temporary file beside it, fsync, rename.
/// Throws EnvironmentError.
void write_file(const std::string& path, std::string_view bytes);

/// Throws InputError where something other than a file or a link stands.
void require_replaceable(const std::string& path);

struct FileBytes {
  std::string path;
  std::string_view bytes;
};
/// Writes files of one directory together: none is put into place before all are written beside their places. Throws
/// EnvironmentError, and InputError where one is no file.
void write_files(const std::vector<FileBytes>& files);

/// Makes a folder and those that it stands in; returns those that were not there, outermost first. Throws InputError
/// where one of them is a link to nothing, else EnvironmentError in words about `named`, which it is in.
std::vector<std::string> make_folders(const std::string& path, const std::string& named);

/// Removes what a killed run left in a directory of ours, unless a run is writing there or nothing may be removed.
/// Returns whether something was removed.
bool remove_abandoned(const std::string& directory) noexcept;
/// Directories with what runs that are still going or were killed left unfinished, in `folder` and those below it, by
/// name. Links are not followed.
[[nodiscard]] std::vector<std::string> unfinished_in(const std::string& folder);

/// What a directory holds: one kind never replaces another.
enum class DirectoryKind { run, recording, estimate, sweep, shrink, hunt };

/// A file of a directory.
struct FileRow {
  std::string_view name;  ///< "<method>" stands for a method's name, "building.*" for the copy of a building
  std::string_view doc;   ///< one sentence without its full stop
  bool mark = true;       ///< a directory that holds it is of this kind; false where others may hold it, too
  bool derived = false;   ///< `score` and `report` make it of the others
};
/// Every file of such a directory.
[[nodiscard]] std::span<const FileRow> files_of(DirectoryKind kind);
/// Names of what `score` and `report` make of the other files of a run or an estimate.
[[nodiscard]] std::vector<std::string> derived_files();
/// Whether a directory of this kind has a file of this name, by its table.
[[nodiscard]] bool is_file_of(DirectoryKind kind, std::string_view name);

/// The directory of a run, recording or estimate while it is being made. Files are written into a hidden folder inside
/// it and moved into place together, results.json last, so that an interrupted run leaves nothing that looks complete.
class RunDirectory {
 public:
  /// Creates `path` where needed. Throws InputError when it holds anything (unless `force` and nothing but files of
  /// this kind) or another run is writing it; EnvironmentError when it cannot be written.
  RunDirectory(const std::string& path, DirectoryKind kind, bool force);
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
  std::optional<FolderLock> lock_;
  bool committed_ = false;
};

}  // namespace plumbline::scenarios
