// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/scenario_template.h"

#include <algorithm>
#include <filesystem>

#include "bim/load/load.h"
#include "scenarios/spec/dotted_key.h"
#include "scenarios/spec/process_tree.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

constexpr int deepest_key = 16;

/// Methods that are named get their labels here, so that the rows of a run that fails have them, too.
void name_labels(const Scenario& scenario, slam::MethodTable table, Tree& tree) {
  if (scenario.methods.empty() || scenario.sensors.empty()) return;
  Tree labels = Tree::list();
  for (const std::string& method : scenario.methods)
    for (const std::string& label : labels_of(method, scenario.sensors, table)) labels.push(label);
  tree.set("methods", labels).set("sensors", Tree::list());
}

void set_value(Tree& tree, const std::string& text, const Mark& mark) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw InputError(mark, "'" + text + "' must be key.key=value");
  const Tree value = read_yaml("value: " + text.substr(equals + 1), mark.file);
  const std::string key = text.substr(0, equals);
  if (key == "seed") throw InputError(mark, "a sweep gives every run its seed; set seeds and first_seed");
  if (key == "building") throw InputError(mark, "a sweep's runs are in their scenario's building; add a scenario");
  if (std::count(key.begin(), key.end(), '.') >= deepest_key)
    throw InputError(mark, "a key of more than " + std::to_string(deepest_key) + " parts; no scenario has one");
  set_at(tree, key, *value.find("value"));
}

}  // namespace

ScenarioTemplate::ScenarioTemplate(const std::string& path, const Mark& mark) : path_(path) {
  if (!fs::exists(path)) throw InputError(mark, "the scenario '" + path + "' does not exist");
  const std::string text = read_text_file(path);
  const fs::path folder = fs::absolute(path).parent_path();  // a bare name has no parent path
  tree_ = with_process_folders(read_yaml(text, path), folder.lexically_normal().string());
  if (!tree_.is_map() || tree_.find("scenario") == nullptr)
    throw InputError(mark, "'" + path + "' is no scenario; its first key must be 'scenario: 1'");
  (void)read_scenario(text, path);
  const Tree* building = tree_.find("building");
  if (building == nullptr) throw InputError(tree_.mark, "a scenario needs a building");
  building_ = (folder / building->as_string()).lexically_normal().string();
  building_bytes_ = fs::exists(building_) ? bim::read_building_file(building_) : "";
}

std::string ScenarioTemplate::name() const { return fs::path(path_).stem().string(); }

Tree ScenarioTemplate::with(const SweepVariant& variant, const Start* start, const SweepFile& sweep, const Mark& mark,
                            slam::MethodTable table) const {
  const std::vector<std::string>& methods = sweep.methods;
  Tree tree = tree_;
  for (const std::string& text : variant.set) {
    set_value(tree, text, mark);
    const std::string key = text.substr(0, text.find_first_of(".="));
    if ((key == "start" && start != nullptr) || (key == "methods" && !methods.empty()) ||
        (key == "sensors" && !sweep.sensors.empty()))
      throw InputError(
          mark, "the sweep sets '" + key + (key == "start" ? "' by its starts" : "' itself") + "; set it in one place");
  }
  if (start != nullptr) tree.set("start", to_tree(*start));
  if (!methods.empty()) {
    Tree list = Tree::list();
    for (const std::string& method : methods) list.push(method);
    tree.set("methods", list).set("gates", Tree::list());
  }
  if (!sweep.sensors.empty()) tree.set("sensors", to_tree(sweep.sensors));
  name_labels(check(tree, variant, mark), table, tree);
  return tree;
}

void ScenarioTemplate::add(const Tree& processes) {
  if (processes.as_list().empty()) return;
  const Tree* own = tree_.find("processes");
  Tree all = own != nullptr && own->is_list() ? *own : Tree::list();
  for (const Tree& process : processes.as_list()) all.push(process);
  tree_.set("processes", std::move(all));
}

ProcessTable ScenarioTemplate::methods(slam::MethodTable table, const Mark& mark) const {
  const std::vector<ProcessSpec> processes = check(tree_, {}, mark).processes;
  return {table, processes, std::vector<Mark>(processes.size(), mark)};
}

std::string ScenarioTemplate::text(Tree tree) const { return write_yaml(tree.set("building", building_)); }

Scenario ScenarioTemplate::check(const Tree& tree, const SweepVariant& variant, const Mark& mark) const {
  try {
    return read_scenario(write_yaml(tree), "made").scenario;
  } catch (const InputError& error) {
    const std::string what = error.what();
    const std::size_t start = what.find(": ");
    throw InputError(mark, "'" + path_ + "'" + (variant.name.empty() ? "" : " as '" + variant.name + "'") +
                               (start == std::string::npos ? ": " + what : what.substr(start)));
  }
}

}  // namespace plumbline::scenarios
