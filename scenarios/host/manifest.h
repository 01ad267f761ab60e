// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/host/files.h"

namespace plumbline::scenarios {

/// manifest.csv: file,digest of every file of a directory of ours when it was written, so that what was altered later
/// can be named; last its own, of the lines before. timings.json, which differs between repetitions, is left out.
inline constexpr std::string_view manifest_name = "manifest.csv";

/// Writes it for what `directory` holds now. Throws EnvironmentError, and InputError where that cannot be listed.
void write_manifest(const std::string& directory);

/// What a check leaves out.
struct ManifestCheck {
  std::vector<std::string> written_anew;  ///< files that the command writes itself
  bool recording = true;                  ///< whether the recording is compared, too, which may be large
  std::optional<DirectoryKind> kind =
      {};  ///< files that such a directory is read with count where the manifest has none
};
/// Files that are not as they were written, are missing, or are of a method or of that kind and were not there, in the
/// order of their names; the manifest itself where there is none or a line of it was changed or removed. Throws
/// InputError on a manifest that is damaged, and where the directory cannot be listed.
[[nodiscard]] std::vector<std::string> altered_files(const std::string& directory, const ManifestCheck& check);

/// Throws InputError that names the altered files, unless `unchecked`: then says on stderr which they are.
void refuse_altered(const std::string& directory, const std::vector<std::string>& altered, bool unchecked);

/// Takes files as they are now into the manifest, and those that are gone out of it. Of others nothing changes. Does
/// nothing where there is no manifest.
void renew_manifest(const std::string& directory, const std::vector<std::string>& names);

/// A file of a directory as it is to be.
struct NewFile {
  std::string name;
  std::optional<std::string> bytes;  ///< absent: the file goes
};
/// Puts files into place together with the manifest that has them, where there is one: none is there before all are on
/// the disk, and those that go do so last. Throws EnvironmentError, and InputError where one is no file.
void replace_files(const std::string& directory, const std::vector<NewFile>& files);

}  // namespace plumbline::scenarios
