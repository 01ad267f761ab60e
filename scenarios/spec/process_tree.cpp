// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/process_tree.h"

#include <utility>

#include "bim/errors.h"

namespace plumbline::scenarios {

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
    if (name == nullptr) throw InputError(method.mark, "a method that is a process needs a name and a command");
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
    if (process.is_map() && process.find("folder") == nullptr) process.set("folder", folder);
    processes.push(std::move(process));
  }
  return std::move(scenario.set("processes", std::move(processes)));
}

}  // namespace plumbline::scenarios
