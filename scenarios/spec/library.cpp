// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/library.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "bim/config/input_file.h"
#include "bim/config/installed_folder.h"
#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// What is wrong with a file is said where it is used.
bool may_be_scenario(const std::string& path) {
  try {
    const Tree tree = read_yaml(read_text_file(path), path);
    return tree.is_map() && tree.find("scenario") != nullptr;
  } catch (const InputError&) {
    return true;
  }
}

}  // namespace

std::string library_folder() {
  return installed_folder({"../share/plumbline/scenarios", "../../scenarios/library", "../../../scenarios/library"},
                          "quickstart.yaml");
}

std::vector<std::string> scenario_files(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error, unknown;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, error);
  for (const fs::recursive_directory_iterator end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (it->path().extension() != ".yaml" || path.ends_with(".plan.yaml") || !it->is_regular_file(unknown)) continue;
    if (may_be_scenario(path)) paths.push_back(path);
  }
  if (error && fs::exists(folder, unknown))
    throw InputError({folder, 0, 0}, "cannot be searched for scenarios: " + error.message());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string find_input(const std::string& input) {
  std::error_code error;
  // A run's folder may be called as its scenario.
  const bool is_folder = fs::is_directory(input, error);
  if (!is_folder && (fs::exists(input, error) || fs::path(input).has_extension())) return input;
  const std::string folder = library_folder();
  if (folder.empty()) return input;
  std::vector<std::string> found, names;
  for (const std::string& path : scenario_files(folder)) {
    const std::string name = fs::path(path).lexically_relative(folder).replace_extension().string();
    names.push_back(name);
    if (name == input) return path;
    if (name.ends_with("/" + input)) found.push_back(path);
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    throw InputError({input, 0, 0},
                     "is the name of several scenarios; say more of it, as in '" +
                         fs::path(found.front()).lexically_relative(folder).replace_extension().string() + "'");
  if (is_folder) return input;
  const std::string close = did_you_mean(input, names);
  throw InputError({input, 0, 0}, "is not a file and not a library scenario; " +
                                      (close.empty() ? std::string("`plumbline scenarios` lists the latter")
                                                     : "did you mean '" + close + "'?"));
}

}  // namespace plumbline::scenarios
