// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/manifest.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <system_error>

#include "bim/config/input_file.h"
#include "bim/config/printable.h"
#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// Of a method's answer, after its name.
constexpr std::string_view estimate_ending = ".estimate.json";

using Entries = std::map<std::string, std::string>;  ///< digest by name

std::string path_of(const std::string& directory) { return directory + "/" + std::string(manifest_name); }

constexpr std::size_t part_bytes = 65536;  // a digest is of parts of this length

std::string digest_of_file(const std::string& path) {
  const InputFile file = open_input_file(path);
  std::array<std::uint8_t, part_bytes> bytes;
  Digest digest;
  while (const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file.stream.get()))
    digest.add_bytes({bytes.data(), got});
  if (std::ferror(file.stream.get()) != 0) throw EnvironmentError(path + ": cannot be read");
  return digest.hex();
}

/// That of a file with these bytes.
std::string digest_of_bytes(std::string_view bytes) {
  Digest digest;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(part_bytes, bytes.size()))) {
    const std::string_view part = bytes.substr(0, part_bytes);
    digest.add_bytes({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()});
  }
  return digest.hex();
}

bool is_listed(const std::string& name) {
  return name != manifest_name && name != "timings.json" && !name.ends_with("/timings.json") && name != "lock" &&
         !name.starts_with(".partial") && !name.ends_with(".tmp");
}

/// Names of all files, those in folders with the folder's name before them.
std::vector<std::string> files_in(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error, unknown;
  fs::recursive_directory_iterator it(directory, error);
  for (const fs::recursive_directory_iterator end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().lexically_relative(directory).string();
    if (it->is_regular_file(unknown) && is_listed(name)) names.push_back(name);
  }
  if (error) throw InputError({directory, 0, 0}, "cannot be listed: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

struct Manifest {
  Entries entries;
  bool whole = false;  ///< whether its last line is its own digest
};

std::string last_line_of(const std::string& text) {
  return std::string(manifest_name) + "," + Digest().add(std::string_view(text)).hex() + "\n";
}

Manifest read_manifest(const std::string& directory) {
  const std::string path = path_of(directory);
  std::string text = read_text_file(path);
  constexpr std::string_view head = "file,digest\n";
  if (!text.starts_with(head)) throw InputError({path, 1, 1}, "a manifest begins with 'file,digest'");
  Manifest manifest;
  Entries& entries = manifest.entries;
  int line = 2;
  for (std::size_t at = head.size(); at < text.size(); ++line) {
    const std::size_t end = text.find('\n', at), comma = text.rfind(',', end);
    constexpr std::size_t digits = 16;
    if (end == std::string::npos || comma == std::string::npos || comma <= at || end - comma - 1 != digits)
      throw InputError({path, line, 1}, "a line must be the name of a file, a comma and 16 digits");
    const std::string name = text.substr(at, comma - at);
    if (name == manifest_name)
      manifest.whole = end + 1 == text.size() && text.substr(at) == last_line_of(text.substr(0, at));
    else
      entries[name] = text.substr(comma + 1, digits);
    at = end + 1;
  }
  return manifest;
}

/// One that was altered stays so: it gets no line of its own.
std::string text_of(const Manifest& manifest) {
  std::string text = "file,digest\n";
  for (const auto& [name, digest] : manifest.entries) text.append(name).append(",").append(digest).append("\n");
  return manifest.whole ? text + last_line_of(text) : text;
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A file that a directory of the kind is read with: one of the fixed names, or of one of its own methods. Others may
/// lie beside them, as a ground truth does.
bool is_read(DirectoryKind kind, const Entries& entries, const std::string& name) {
  const auto rows = files_of(kind);
  if (std::any_of(rows.begin(), rows.end(), [&](const FileRow& row) { return row.name == name; })) return true;
  return is_file_of(kind, name) && std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
           const std::string& estimate = entry.first;
           return estimate.ends_with(estimate_ending) &&
                  name.starts_with(estimate.substr(0, estimate.size() - estimate_ending.size() + 1));
         });
}

}  // namespace

void write_manifest(const std::string& directory) {
  Manifest manifest{{}, true};
  for (const std::string& name : files_in(directory)) manifest.entries[name] = digest_of_file(directory + "/" + name);
  write_file(path_of(directory), text_of(manifest));
}

std::vector<std::string> altered_files(const std::string& directory, const ManifestCheck& check) {
  if (!fs::exists(path_of(directory))) return {std::string(manifest_name)};
  const auto [entries, whole] = read_manifest(directory);
  const std::string of_recording = std::string(recording_folder) + "/";
  std::vector<std::string> altered;
  if (!whole) altered.emplace_back(manifest_name);
  for (const auto& [name, digest] : entries) {
    if (is_among(check.written_anew, name) || (!check.recording && name.starts_with(of_recording))) continue;
    const std::string path = directory + "/" + name;
    if (!fs::is_regular_file(path) || digest_of_file(path) != digest) altered.push_back(name);
  }
  for (const std::string& name : files_in(directory)) {
    const bool counts = name.ends_with(estimate_ending) || (check.kind && is_read(*check.kind, entries, name));
    if (counts && !entries.contains(name) && !is_among(check.written_anew, name)) altered.push_back(name);
  }
  std::sort(altered.begin(), altered.end());
  return altered;
}

void refuse_altered(const std::string& directory, const std::vector<std::string>& altered, bool unchecked) {
  if (altered.empty()) return;
  constexpr std::size_t most_named = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(altered.size(), most_named); ++i) names += (i == 0 ? "" : ", ") + altered[i];
  if (altered.size() > most_named) names += " and " + std::to_string(altered.size() - most_named) + " more";
  const bool none = !fs::exists(path_of(directory));
  const auto missing = [&](const std::string& name) { return !fs::is_regular_file(directory + "/" + name); };
  const bool all = std::all_of(altered.begin(), altered.end(), missing);
  const bool any = std::any_of(altered.begin(), altered.end(), missing);
  const bool added = !none && std::all_of(altered.begin(), altered.end(), [&](const std::string& name) {
    return !missing(name) && name != manifest_name && !read_manifest(directory).entries.contains(name);
  });
  const std::string what = added ? "not listed in manifest.csv: "
                           : all ? "missing: "
                           : any ? "altered or missing: "
                                 : "altered since they were written: ";
  const bool broken = !none && is_among(altered, std::string(manifest_name));
  const std::string why =
      broken ? " (a line of manifest.csv was changed or removed, or an earlier version wrote it)" : "";
  if (unchecked)
    print_note("plumbline: " + (none ? "there is no manifest.csv" : what + names) + "; taken as they are");
  else if (none)
    throw InputError({directory, 0, 0},
                     "has no manifest.csv, which says whether its files are as they were written; "
                     "--unchecked goes on without");
  else
    throw InputError({directory, 0, 0}, what + names + why + (added ? "; move it elsewhere" : "; run it again") +
                                            ", or add --unchecked to take them as they are");
}

void renew_manifest(const std::string& directory, const std::vector<std::string>& names) {
  if (!fs::exists(path_of(directory))) return;
  Manifest manifest = read_manifest(directory);
  for (const std::string& name : names) {
    manifest.entries.erase(name);
    const std::string path = directory + "/" + name;
    if (is_listed(name) && fs::is_regular_file(path)) manifest.entries[name] = digest_of_file(path);
  }
  write_file(path_of(directory), text_of(manifest));
}

void replace_files(const std::string& directory, const std::vector<NewFile>& files) {
  std::optional<Manifest> manifest;
  if (fs::exists(path_of(directory))) manifest = read_manifest(directory);
  std::vector<FileBytes> written;
  for (const NewFile& file : files) {
    if (file.bytes) written.push_back({directory + "/" + file.name, *file.bytes});
    if (!manifest) continue;
    manifest->entries.erase(file.name);
    if (!file.bytes) continue;
    manifest->entries[file.name] = digest_of_bytes(*file.bytes);
  }
  const std::string list = manifest ? text_of(*manifest) : std::string();
  if (manifest) written.push_back({path_of(directory), list});
  for (const NewFile& file : files)
    if (!file.bytes) require_replaceable(directory + "/" + file.name);
  write_files(written);
  for (const NewFile& file : files) {
    if (file.bytes) continue;
    std::error_code error;
    fs::remove(directory + "/" + file.name, error);
    if (error) throw EnvironmentError(directory + "/" + file.name + ": cannot be removed: " + error.message());
  }
}

}  // namespace plumbline::scenarios
