// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/program_digest.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "bim/config/input_file.h"
#include "bim/digest/digest.h"
#include "scenarios/host/files.h"
#include "scenarios/host/manifest.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 30U;
constexpr std::uint64_t most_folder_bytes = std::uint64_t{64} << 20U;
constexpr std::size_t most_folder_files = 1000;

bool is_among(const auto& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// What the system has installed, and places that all programs write to.
bool is_of_system(const fs::path& folder) {
  constexpr std::array<std::string_view, 12> tops = {"usr", "bin",  "sbin", "lib", "lib32", "lib64",
                                                     "opt", "snap", "nix",  "gnu", "etc",   "dev"};
  const std::string path = folder.string();
  if (path == "/" || path == "/tmp" || path == "/var/tmp") return true;
  auto part = folder.begin();
  if (part != folder.end()) ++part;
  return part != folder.end() && is_among(tops, part->string());
}

bool is_script(const fs::path& file) {
  constexpr std::array<std::string_view, 9> endings = {".py", ".sh", ".bash", ".js", ".mjs",
                                                       ".jl", ".rb", ".lua",  ".pl"};
  return is_among(endings, file.extension().string()) || ::access(file.c_str(), X_OK) == 0;
}

bool is_sweep(const fs::path& folder) {
  bool has_results = false;
  const auto rows = files_of(DirectoryKind::sweep);
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool known = std::any_of(rows.begin(), rows.end(), [&](const FileRow& row) { return row.name == name; });
    if (!known && !name.starts_with('.') && !name.ends_with(".tmp")) return false;
    has_results = has_results || name == "results";
  }
  return has_results && !error;
}

/// A sweep, hunt, scenario or plan has its own place in a run's input; more seeds shall not make all runs again.
bool is_ours(const fs::path& file) {
  if (file.extension() != ".yaml" && file.extension() != ".yml") return false;
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line) && (line.empty() || line.front() == '#')) continue;
  return line.starts_with("sweep: 1") || line.starts_with("scenario: 1") || line.starts_with("plan: 1") ||
         line.starts_with("hunt: 1");
}

/// What programs write, and nobody imports.
bool is_left_out(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  std::error_code error;
  if (!entry.is_directory(error))
    return name.ends_with(".pyc") || name.ends_with(".log") || name.ends_with(".tmp") || name.ends_with('~') ||
           is_ours(entry.path());
  return name.starts_with('.') || name == "__pycache__" || name.ends_with(".shards") ||
         fs::exists(entry.path() / manifest_name, error) || is_sweep(entry.path());
}

/// Regular files of a folder and of those in it, by name; links to folders are not followed. One more than the most
/// ends it.
void add_files(const fs::path& folder, std::vector<fs::path>& files) {
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) entries.push_back(*at);
  std::sort(entries.begin(), entries.end());
  for (const fs::directory_entry& entry : entries) {
    if (files.size() > most_folder_files) return;
    if (is_left_out(entry)) continue;
    if (entry.is_regular_file(error)) files.push_back(entry.path());
    if (!entry.is_symlink(error) && entry.is_directory(error)) add_files(entry.path(), files);
  }
}

/// Nothing of an empty file and of one that may not be read.
std::string bytes_of(const fs::path& file) {
  std::error_code error;
  const bool readable = fs::file_size(file, error) > 0 && !error && ::access(file.c_str(), R_OK) == 0;
  return readable ? read_text_file(file.string(), most_file_bytes) : std::string();
}

std::vector<std::string> words_of(const Tree& process) {
  const Tree* command = process.is_map() ? process.find("command") : nullptr;
  std::vector<std::string> words;
  if (command == nullptr || !command->is_list()) return words;
  for (const Tree& word : command->as_list()) words.push_back(word.as_string());
  return words;
}

}  // namespace

std::uint64_t own_program_digest() {
  static const std::uint64_t digest = Digest().add(bytes_of("/proc/self/exe")).value();
  return digest;
}

std::uint64_t ProgramDigests::of(const Tree& scenario) {
  Digest digest;
  const Tree* processes = scenario.find("processes");
  if (processes == nullptr || !processes->is_list()) return digest.value();
  for (const Tree& process : processes->as_list()) {
    const Tree* own = process.is_map() ? process.find("folder") : nullptr;
    const fs::path folder = own != nullptr ? fs::path(own->as_string()) : fs::path();
    for (const std::string& word : words_of(process)) {
      const fs::path file = fs::absolute(folder / word).lexically_normal();
      std::error_code none;
      if (!fs::is_regular_file(file, none)) continue;
      digest.add(bytes_of(file));
      if (is_script(file) && !is_of_system(file.parent_path())) digest.add(of_folder(file.parent_path().string()));
    }
  }
  return digest.value();
}

std::uint64_t ProgramDigests::of_folder(const std::string& folder) {
  if (const auto known = folders_.find(folder); known != folders_.end()) return known->second;
  std::vector<fs::path> files;
  add_files(folder, files);
  bool all = files.size() <= most_folder_files;
  files.resize(std::min(files.size(), most_folder_files));
  Digest digest;
  std::uint64_t left = most_folder_bytes;
  for (const fs::path& file : files) {
    std::error_code error;
    const std::uint64_t size = fs::file_size(file, error);
    digest.add(file.lexically_relative(folder).string());
    if (error) continue;
    digest.add(size);
    all = all && size <= left;
    if (size > left) continue;
    left -= size;
    digest.add(bytes_of(file));
  }
  if (!all)
    notes_.push_back(folder + ": only its first " + std::to_string(most_folder_files) + " files and " +
                     std::to_string(most_folder_bytes >> 20U) +
                     " MB are watched for changes; keep a method in a folder of its own");
  return folders_[folder] = digest.value();
}

}  // namespace plumbline::scenarios
