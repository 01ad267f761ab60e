// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/file_ending.h"
#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/plan_yaml/plan_furniture.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/furniture/furnish.h"
#include "bim/generators/faults.h"
#include "bim/generators/generators.h"
#include "bim/generators/mirror.h"
#include "bim/load/load.h"
#include "bim/random/stream.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"
#include "scenarios/spec/generated_walk.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

struct GenerateOptions {
  std::string out;
  std::string scenario;
  bool force = false;
  std::string unknown_family;
  std::vector<CommandLine> families;
  std::map<std::string, std::string> values;  ///< by "family key", as written
  bim::FurnishOptions furniture;
  std::vector<CommandLine> furnish;  ///< the command, once it is there
  std::vector<CommandLine> mirror;   ///< the command, once it is there
  std::string building;              ///< to furnish, mirror or damage
  std::vector<CommandLine> damage;   ///< the command, once it is there
  std::vector<std::string> faults;
  std::uint64_t fault_seed = 1;

  GenerateOptions() { furniture.density = 0.0; }
};

constexpr double density_max = 0.4;

/// epsilon_m is given as --epsilon.
std::string flag_of(const std::string& key) {
  std::string name = key.size() > 2 && key.substr(key.size() - 2) == "_m" ? key.substr(0, key.size() - 2) : key;
  for (char& c : name)
    if (c == '_') c = '-';
  return "--" + name;
}

/// What was asked for, as a map of the family's options, and as the command that asks for it.
struct Asked {
  Tree options = Tree::map();
  std::string command;
};

Asked asked_for(const GenerateOptions& options, const std::string& family) {
  Asked asked;
  asked.options.mark = {"plumbline generate " + family, 0, 0};
  asked.command = "plumbline generate " + family;
  for (const bim::OptionRow& row : bim::generator_options(family)) {
    const auto given = options.values.find(family + " " + row.key);
    if (given == options.values.end() || given->second.empty()) continue;
    Tree value = given->second == "yes" ? Tree("true") : given->second == "no" ? Tree("false") : Tree(given->second);
    value.mark = {flag_of(row.key), 0, 0};
    asked.options.set(row.key, std::move(value));
    asked.command += " " + flag_of(row.key) + " " + given->second;
  }
  return asked;
}

/// What the command line says of furniture, as it would be typed.
std::string furniture_asked(const bim::FurnishOptions& furniture) {
  if (!(furniture.density > 0.0)) return "";
  return " --furnish " + format_number(furniture.density) + " --furnish-seed " + std::to_string(furniture.seed);
}

void refuse_to_replace(const std::string& path, bool force) {
  if (fs::is_directory(path)) throw InputError({path, 0, 0}, "is a directory; name a file");
  if (!force && fs::exists(path)) throw InputError({path, 0, 0}, "exists already; --force replaces it");
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw InputError({path, 0, 0}, "its folder is not there; make it, or name another");
}

/// The scenario's text, whose building stands in a file beside it or elsewhere.
std::string scenario_for(const bim::GeneratedPlan& generated, const std::string& plan_text,
                         const GenerateOptions& options) {
  const std::string building =
      fs::path(options.out).lexically_proximate(fs::path(options.scenario).parent_path()).string();
  Scenario scenario = generated_walk(generated, plan_text, building);
  scenario.methods = {"truth", "odometry", "vgicp", "s_graphs_plus", "s_graph_localization"};
  return write_scenario(scenario);
}

bool is_ifc(const std::string& path) { return has_ending(path, ".ifc"); }

void warn_of_missing_chairs(const std::vector<bim::FurniturePiece>& pieces, const GenerateOptions& options) {
  if (const std::optional<bim::Warning> missing = bim::chairs_missing(pieces, options.furniture))
    print_note("plumbline: warning: " + options.building + ": " + missing->text);
}

/// The plan, or the building as IFC, with furniture.
std::string furnished(const GenerateOptions& options) {
  bim::Building building = bim::load_building(options.building);
  if (building.rooms.empty()) throw InputError({options.building, 0, 0}, "has no rooms to furnish");
  if (is_ifc(options.out)) {
    const std::vector<bim::FurniturePiece> pieces = bim::furnish_pieces(building, options.furniture);
    for (const bim::FurniturePiece& piece : pieces) building.obstacles.push_back(obstacle_of(piece));
    warn_of_missing_chairs(pieces, options);
    return bim::write_ifc(building);
  }
  if (building.schema != "plan")
    throw InputError({options.out, 0, 0}, "only a plan can be written as a plan; name a file that ends in .ifc");
  bim::PlanFile plan = bim::plan_entries(read_yaml(read_text_file(options.building), options.building));
  warn_of_missing_chairs(bim::furnish_plan(plan, options.furniture), options);
  return bim::write_plan(
      plan,
      "Made by: plumbline generate furnish " + fs::path(options.building).filename().string() + " --furnish " +
          format_number(options.furniture.density) + " --seed " + std::to_string(options.furniture.seed) +
          (options.furniture.people > 0 ? " --people " + std::to_string(options.furniture.people) : std::string()));
}

int furnish(const GenerateOptions& options) {
  if (options.out != "-") refuse_to_replace(options.out, options.force);
  const std::string text = furnished(options);
  if (options.out == "-") {
    print_data(text);
  } else {
    write_file(options.out, text);
  }
  return 0;
}

int mirror(const GenerateOptions& options) {
  if (!is_ifc(options.out))
    throw InputError({options.out, 0, 0}, "a mirror image is written as IFC; name a file that ends in .ifc");
  refuse_to_replace(options.out, options.force);
  write_file(options.out, bim::write_ifc(bim::mirrored(bim::load_building(options.building))));
  return 0;
}

/// The building with faults as a file of another program would have them.
int damage(const GenerateOptions& options) {
  if (!is_ifc(options.out))
    throw InputError({options.out, 0, 0}, "only IFC can hold such faults; name a file that ends in .ifc");
  refuse_to_replace(options.out, options.force);
  bim::Building building = bim::load_building(options.building);
  const Stream stream(options.fault_seed, "bim.generate");
  const auto& names = bim::building_fault_names;
  std::string lines;
  for (std::size_t i = 0; i < options.faults.size(); ++i) {
    const auto* name = std::find(names.begin(), names.end(), options.faults[i]);
    const std::uint64_t before = building.hash();
    bim::FaultyBuilding faulty =
        bim::with_fault(std::move(building), static_cast<bim::BuildingFault>(name - names.begin()), stream, i);
    building = std::move(faulty.building);
    if (building.hash() == before)
      throw InputError({options.building, 0, 0},
                       "has no place for " + options.faults[i] + "; another fault or building");
    lines += options.faults[i] + (faulty.element.empty() ? "" : " of " + faulty.element) +
             (faulty.rise_m > 0.0 ? ", " + format_number(std::round(faulty.rise_m * 1e3) / 1e3) + " m up" : "") + "\n";
  }
  bim::IfcWriteConfig config;
  config.signature = false;
  write_file(options.out, bim::write_ifc(building, config));
  print(lines);
  return 0;
}

int generate(const GenerateOptions& options) {
  if (options.furnish.front().asked()) return furnish(options);
  if (options.mirror.front().asked()) return mirror(options);
  if (options.damage.front().asked()) return damage(options);
  std::string family = options.unknown_family;
  for (const CommandLine& line : options.families)
    if (line.asked()) family = line.name();
  if (family.empty()) throw InputError({"plumbline generate", 0, 0}, "name a family; see plumbline generate --help");
  const Asked asked = asked_for(options, family);
  bim::GeneratedPlan generated = bim::generate(family, asked.options);
  if (options.furniture.density > 0.0) bim::furnish_plan(generated.plan, options.furniture);
  const std::string text =
      bim::write_plan(generated.plan, "Made by: " + asked.command + furniture_asked(options.furniture));
  if (options.out == "-") {
    if (!options.scenario.empty()) throw InputError({"--scenario", 0, 0}, "needs a plan in a file; give -o a path");
    print_data(text);
    return 0;
  }
  refuse_to_replace(options.out, options.force);
  if (!options.scenario.empty()) {
    refuse_to_replace(options.scenario, options.force);
    if (fs::weakly_canonical(fs::absolute(options.scenario)) == fs::weakly_canonical(fs::absolute(options.out)))
      throw InputError({"--scenario", 0, 0}, "is the plan's own file; name another");
  }
  const std::string scenario = options.scenario.empty() ? "" : scenario_for(generated, text, options);
  write_file(options.out, is_ifc(options.out) ? bim::write_ifc(bim::read_plan_text(text, options.out)) : text);
  if (!options.scenario.empty()) write_file(options.scenario, scenario);
  return 0;
}

/// {a,b} of "a | b".
std::string in_braces(const std::string& choices) {
  std::string words;
  for (std::size_t begin = 0; begin < choices.size();) {
    const std::size_t end = std::min(choices.find(" | ", begin), choices.size());
    words += (words.empty() ? "" : ",") + choices.substr(begin, end - begin);
    begin = end + 3;
  }
  return "{" + words + "}";
}

CommandLine add_family(CommandLine& program, const bim::GeneratorRow& row,
                       const std::shared_ptr<GenerateOptions>& options) {
  const std::string name(row.name);
  CommandLine line = program.add_command(name, std::string(row.summary));
  line.option("-o,--out", options->out, "plan or IFC file to write; - for a plan on stdout").required();
  line.option("--scenario", options->scenario, "also writes a scenario that walks through all rooms");
  line.flag("--force", options->force, "replace files that are there");
  for (const bim::OptionRow& option : bim::generator_options(name)) {
    const std::string value = option.value.empty() ? "" : " [" + option.value + "]";
    Argument argument = line.option(flag_of(option.key), options->values[name + " " + option.key], option.doc + value);
    if (!option.choices.empty()) argument.takes(in_braces(option.choices));
    if (!option.type.empty()) argument.takes(option.type == "integer" ? "UINT" : "FLOAT");
  }
  const auto density = line.option("--furnish", options->furniture.density,
                                   "share of each room's floor under furniture, as far as it stays walkable")
                           .range(0.0, density_max);
  line.seed("--furnish-seed", options->furniture.seed, "seed from which furniture is chosen and placed").needs(density);
  line.footer("Example: plumbline generate " + name + " --seed 7 --feature column --epsilon 0.3 -o " + name +
              ".plan.yaml");
  return line;
}

CommandLine add_furnish(CommandLine& program, const std::shared_ptr<GenerateOptions>& options) {
  CommandLine line =
      program.add_command("furnish", "adds furniture to any building: a plan, or IFC where OUT ends in .ifc");
  line.option("BUILDING", options->building, "building to furnish: a plan or an IFC file").required();
  line.option("-o,--out", options->out, "plan or IFC file to write; - for a plan on stdout").required();
  line.flag("--force", options->force, "replace files that are there");
  line.option("--furnish", options->furniture.density,
              "share of each room's floor under furniture, as far as it stays walkable")
      .range(0.0, density_max)
      .required();
  line.seed("--seed", options->furniture.seed, "seed from which furniture is chosen and placed");
  line.option("--people", options->furniture.people, "number of people that sit, each in place of a chair")
      .range(0, 50);
  line.footer("Example: plumbline generate furnish house.plan.yaml --furnish 0.2 -o furnished.plan.yaml");
  return line;
}

CommandLine add_mirror(CommandLine& program, const std::shared_ptr<GenerateOptions>& options) {
  CommandLine line = program.add_command("mirror", "the mirror image of any building, as IFC: a wrong plan for a test");
  line.option("BUILDING", options->building, "building: a plan or an IFC file").required();
  line.option("-o,--out", options->out, "IFC file to write").required();
  line.flag("--force", options->force, "replace files that are there");
  line.footer("Example: plumbline generate mirror house.plan.yaml -o mirrored.ifc");
  return line;
}

CommandLine add_damage(CommandLine& program, const std::shared_ptr<GenerateOptions>& options) {
  CommandLine line = program.add_command("damage", "gives any building the faults of real files, as IFC");
  line.option("BUILDING", options->building, "building: a plan or an IFC file").required();
  line.option("-o,--out", options->out, "IFC file to write").required();
  line.flag("--force", options->force, "replace files that are there");
  line.option("--fault", options->faults,
              "one or more: a split level, a mezzanine, a wall drawn twice over its door, "
              "a wall that ends in a doorway, no slabs, a front of glass panels")
      .one_of({bim::building_fault_names.begin(), bim::building_fault_names.end()})
      .required();
  line.seed("--seed", options->fault_seed, "seed from which places and sizes are drawn");
  line.footer(
      "Example: plumbline generate damage house.plan.yaml --fault split_level --fault missing_slabs -o odd.ifc");
  return line;
}

}  // namespace

Command add_generate(CommandLine& program) {
  const auto options = std::make_shared<GenerateOptions>();
  CommandLine line = program.add_command("generate", "Makes a building that is hard to localize in");
  for (const bim::GeneratorRow& row : bim::generators()) options->families.push_back(add_family(line, row, options));
  options->furnish.push_back(add_furnish(line, options));
  options->mirror.push_back(add_mirror(line, options));
  options->damage.push_back(add_damage(line, options));
  // A name that is no family is refused by the action, which lists the families.
  line.option("FAMILY", options->unknown_family).hidden();
  line.takes_command_or_any("FAMILY");
  line.footer(
      "Example: plumbline generate corridor --rooms 6 --feature door_shift --epsilon 0.1 -o corridor.plan.yaml\n"
      "plumbline generate FAMILY --help lists the sizes and features of a family.");
  return {line, [options] { return generate(*options); }};
}

}  // namespace plumbline::scenarios
