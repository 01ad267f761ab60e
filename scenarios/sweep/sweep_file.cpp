// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

#include "bim/digest/digest.h"
#include "scenarios/spec/process_tree.h"
#include "scenarios/spec/resolve.h"
#include "scenarios/sweep/program_digest.h"
#include "scenarios/sweep/scenario_template.h"
#include "scenarios/sweep/shared_simulation.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_runs = 1000000;
constexpr std::size_t most_text_bytes = std::size_t{256} << 20U;

Mark mark_of(const Tree& tree, std::string_view key, std::size_t i) {
  const Tree* list = tree.find(key);
  if (list == nullptr) return tree.mark;
  return list->is_list() && i < list->as_list().size() ? list->as_list()[i].mark : list->mark;
}

/// The part of a scenario that decides about its simulation.
Tree simulation_part(const Tree& scenario) {
  Tree part = Tree::map();
  for (const auto& [key, value] : scenario.as_map())
    if (std::find(method_keys.begin(), method_keys.end(), key) == method_keys.end()) part.set(key, value);
  return part;
}

std::string file_name(const std::string& text) {
  std::string name = text;
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_')) c = '_';
  return name;
}

void check(const SweepFile& file, const Tree& tree) {
  check_name(file.name, tree.find("name") != nullptr ? tree.find("name")->mark : tree.mark);
  if (file.scenarios.empty()) throw InputError(tree.find("scenarios")->mark, "names no scenario; it must name one");
  const std::size_t each =
      std::max<std::size_t>(file.variants.size(), 1) * std::max<std::size_t>(file.starts.size(), 1);
  if (file.scenarios.size() * each * static_cast<std::size_t>(file.seeds) > most_runs)
    throw InputError(tree.mark, "this would be more than " + std::to_string(most_runs) + " runs");
  std::set<std::string> names;
  for (std::size_t i = 0; i < file.variants.size(); ++i) {
    check_name(file.variants[i].name, mark_of(tree, "variants", i));
    if (!names.insert(file_name(file.variants[i].name)).second)
      throw InputError(mark_of(tree, "variants", i), "a variant of this name is in the list already");
  }
  std::set<std::string> scenarios;
  for (std::size_t i = 0; i < file.scenarios.size(); ++i)
    if (!scenarios.insert(file_name(fs::path(file.scenarios[i]).stem().string())).second)
      throw InputError(mark_of(tree, "scenarios", i), "a scenario of this name is in the list already");
}

/// A method that a sweep names is known in each of its scenarios.
void check_names(const SweepFile& file, const Tree& tree, slam::MethodTable table) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < file.methods.size(); ++i) marks.push_back(mark_of(tree, "methods", i));
  check_methods(file.methods, marks, table);
}

/// The processes of a sweep, each with its folder.
Tree processes_of(const Tree& sweep) {
  const Tree* processes = sweep.find("processes");
  return processes != nullptr && processes->is_list() ? *processes : Tree::list();
}

}  // namespace

Sweep read_sweep(const std::string& path, int seeds, slam::MethodTable table) {
  const std::string home = fs::absolute(path).parent_path().lexically_normal().string();
  const Tree tree = with_process_folders(read_yaml(read_text_file(path), path), home);
  if (!tree.is_map() || tree.as_map().empty() || tree.as_map().front().first != "sweep")
    throw InputError({path, 1, 1}, "the first key of a sweep must be 'sweep: 1'");
  Sweep sweep;
  sweep.file = from_tree<SweepFile>(tree);
  sweep.file_name = fs::path(path).filename().string();
  if (seeds > 0) sweep.file.seeds = sweep.seeds = seeds;
  const SweepFile& file = sweep.file;
  check(file, tree);
  std::size_t text_bytes = 0;
  std::set<std::string> parts;
  ProgramDigests programs;
  const std::vector<SweepVariant> variants = file.variants.empty() ? std::vector<SweepVariant>(1) : file.variants;
  for (std::size_t i = 0; i < file.scenarios.size(); ++i) {
    const Mark at = mark_of(tree, "scenarios", i);
    ScenarioTemplate scenario((fs::path(path).parent_path() / file.scenarios[i]).string(), at);
    scenario.add(processes_of(tree));
    const ProcessTable methods = scenario.methods(table, at);
    check_names(file, tree, methods.table());
    for (std::size_t v = 0; v < variants.size(); ++v)
      for (std::size_t s = 0; s < std::max<std::size_t>(file.starts.size(), 1); ++s) {
        const Start* start = file.starts.empty() ? nullptr : &file.starts[s];
        const Tree made = scenario.with(variants[v], start, file, mark_of(tree, "variants", v), methods.table());
        const std::string part = file_name(scenario.name()) +
                                 (file.variants.empty() ? "" : "-" + file_name(variants[v].name)) +
                                 (start == nullptr ? "" : "-start" + std::to_string(s + 1));
        if (!parts.insert(part).second)
          throw InputError(mark_of(tree, file.variants.empty() ? "scenarios" : "variants", v),
                           "two kinds of run are both called '" + part + "'; name one of them otherwise");
        Digest input = Digest().add(write_yaml(made)).add(scenario.building_bytes());
        if (made.find("processes") != nullptr) input.add(programs.of(made));
        const Digest simulation = Digest().add(scenario.text(simulation_part(made))).add(scenario.building_bytes());
        sweep.scenario_texts.push_back(scenario.text(made));
        text_bytes += sweep.scenario_texts.back().size();
        if (text_bytes > most_text_bytes)
          throw InputError(tree.mark, "its scenarios are more than " + std::to_string(most_text_bytes) + " bytes");
        for (int k = 0; k < file.seeds; ++k) {
          const std::uint64_t seed = file.first_seed + static_cast<std::uint64_t>(k);
          sweep.runs.push_back({part + "-" + std::to_string(seed), scenario.name(), variants[v].name,
                                start == nullptr ? "" : flow_text(to_tree(*start)), seed,
                                sweep.scenario_texts.size() - 1,
                                hex64(Digest(input).add(seed).add(own_program_digest()).value()),
                                hex64(Digest(simulation).add(seed).value())});
        }
      }
  }
  sweep.notes = programs.notes();
  return sweep;
}

}  // namespace plumbline::scenarios
