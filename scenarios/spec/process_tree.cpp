// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/process_tree.h"

#include <filesystem>
#include <utility>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

/// What a process says, seen from the folder; a value that is no text stays, to be refused at its place.
Tree folder_of(const Tree& process, const std::string& folder) {
  const Tree* own = process.find("folder");
  if (own == nullptr || own->is_null()) return folder;
  if (!own->is_scalar()) return *own;
  Tree whole = process_folder(own->as_string(), folder);
  whole.mark = own->mark;
  return whole;
}

/// No process says which sensors it gets.
bool is_built_in(const Tree& method) {
  return method.find("command") == nullptr && (method.as_map().size() == 1 || method.find("sensors") != nullptr);
}

}  // namespace

std::string process_folder(const std::optional<std::string>& own, const std::string& folder) {
  namespace fs = std::filesystem;
  return own ? (fs::path(folder) / *own).lexically_normal().string() : folder;
}

Tree with_processes_apart(Tree scenario) {
  const Tree* methods = scenario.is_map() ? scenario.find("methods") : nullptr;
  if (methods == nullptr || !methods->is_list()) return scenario;
  const Tree* given = scenario.find("processes");
  if (given != nullptr && !given->is_list() && !given->is_null())
    throw InputError(given->mark, "'processes' must be a list");
  Tree names = Tree::list(), processes = given != nullptr ? *given : Tree::list();
  names.mark = methods->mark;
  if (given == nullptr) processes.mark = methods->mark;
  bool found = false;
  for (const Tree& method : methods->as_list()) {
    const Tree* name = method.is_map() ? method.find("name") : nullptr;
    if (!method.is_map()) {
      names.push(method);
      continue;
    }
    if (name == nullptr || is_built_in(method))
      throw InputError(method.mark,
                       "a method that is a process needs a name and a command; a built-in one is its name alone, with "
                       "'.lidar' after it for the LiDAR alone");
    names.push(*name);
    processes.push(method);
    found = true;
  }
  if (!found) return scenario;
  return std::move(scenario.set("methods", std::move(names)).set("processes", std::move(processes)));
}

Tree with_process_folders(Tree scenario, const std::string& folder) {
  scenario = with_processes_apart(std::move(scenario));
  const Tree* given = scenario.is_map() ? scenario.find("processes") : nullptr;
  if (given == nullptr || !given->is_list()) return scenario;
  Tree processes = Tree::list();
  processes.mark = given->mark;
  for (Tree process : given->as_list()) {
    if (process.is_map()) process.set("folder", folder_of(process, folder));
    processes.push(std::move(process));
  }
  return std::move(scenario.set("processes", std::move(processes)));
}

}  // namespace plumbline::scenarios
