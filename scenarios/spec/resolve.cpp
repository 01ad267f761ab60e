// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/resolve.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "bim/config/file_ending.h"
#include "bim/digest/digest.h"
#include "bim/formats/mesh/mesh_file.h"
#include "bim/load/foreign_file.h"
#include "bim/random/stream.h"
#include "scenarios/metrics/metric_kind.h"
#include "scenarios/spec/library.h"
#include "scenarios/spec/method_names.h"
#include "scenarios/spec/moving.h"
#include "scenarios/spec/process_tree.h"
#include "scenarios/spec/random_start.h"
#include "scenarios/spec/route_plan.h"
#include "scenarios/spec/run_site.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

bool is_ifc(const std::string& text) { return text.substr(0, 256).find("ISO-10303-21") != std::string::npos; }

/// The first key of a YAML file, which names its kind.
std::string kind_of(const std::string& text, const std::string& path) {
  const Tree tree = read_yaml(text, path);
  if (!tree.is_map() || tree.as_map().empty())
    throw InputError({path, 1, 1}, "a scenario or plan is expected: the first key must be 'scenario: 1' or 'plan: 1'");
  return tree.find("levels") != nullptr ? "plan" : tree.as_map().front().first;
}

/// The default scenario of a building that is given without one.
ScenarioText default_scenario(const std::string& path) {
  ScenarioText text;
  text.tree = Tree::map();
  text.tree.mark = {path, 0, 0};
  text.scenario.building = fs::path(path).filename().string();
  std::string name = text.scenario.building.substr(0, text.scenario.building.find('.'));
  text.scenario.name = name.empty() || name.size() > longest_name ? "unnamed" : name;
  return text;
}

ScenarioText read_input(const std::string& path) {
  if (bim::is_mesh_path(path)) return default_scenario(path);
  const std::string text = read_text_file(path);
  bim::refuse_foreign_file(text, path);
  if (is_ifc(text) || has_ending(path, ".ifc")) return default_scenario(path);
  const std::string kind = kind_of(text, path);
  if (kind == "plan") return default_scenario(path);
  if (kind == "scenario") return read_scenario(text, path);
  throw InputError({path, 1, 1}, "the first key is '" + kind + "'; it must be 'scenario: 1' or 'plan: 1'");
}

std::vector<Mark> marks_of(const Tree& tree, std::initializer_list<std::string_view> path, std::size_t count) {
  const Tree* node = &tree;
  for (const std::string_view key : path) node = node != nullptr && node->is_map() ? node->find(key) : nullptr;
  std::vector<Mark> marks(count, mark_at(tree, path));
  if (node != nullptr && node->is_list())
    for (std::size_t i = 0; i < std::min(count, node->as_list().size()); ++i) marks[i] = node->as_list()[i].mark;
  return marks;
}

bool needs_plan(const std::string& method, slam::MethodTable table) {
  const slam::MethodRow* row = row_of(method, table);
  return row != nullptr && row->needs_plan;
}

/// Runs each method with each of the scenario's sensors. `marks` say where each of them is asked for.
void give_sensors(Scenario& scenario, std::vector<Mark>& marks, slam::MethodTable table) {
  std::vector<std::string> labels;
  std::vector<Mark> places;
  for (std::size_t i = 0; i < scenario.methods.size(); ++i)
    for (std::string& label : labels_of(scenario.methods[i], scenario.sensors, table)) {
      labels.push_back(std::move(label));
      places.push_back(marks[i]);
    }
  scenario.methods = std::move(labels);
  scenario.sensors.clear();
  marks = std::move(places);
}

/// Every standard method that can run with this plan and these sensors.
std::vector<std::string> default_methods(const Scenario& scenario, bool has_plan, slam::MethodTable table) {
  const auto& sensors = scenario.sensors;
  const bool alone = !sensors.empty() && std::find(sensors.begin(), sensors.end(), Sensors::all) == sensors.end();
  std::vector<std::string> names;
  for (const slam::MethodRow& row : table)
    if (row.standard && (has_plan || !row.needs_plan) && (!alone || runs_on_lidar_alone(row)))
      names.emplace_back(row.name);
  return names;
}

/// Without a plan the default is every method that needs none, and asking for another is wrong. Returns where each
/// method is asked for.
std::vector<Mark> choose_methods(ScenarioText& text, const Overrides& overrides, bool has_plan,
                                 slam::MethodTable table) {
  std::vector<std::string>& methods = text.scenario.methods;
  if (overrides.methods) {
    check_methods(methods, marks_of(text.tree, {"methods"}, methods.size()), table);  // those it stands in for
    methods = *overrides.methods;
  }
  if (methods.empty()) methods = default_methods(text.scenario, has_plan, table);
  std::vector<Mark> marks = overrides.methods ? std::vector<Mark>(methods.size(), Mark{"--method", 0, 0})
                                              : marks_of(text.tree, {"methods"}, methods.size());
  give_sensors(text.scenario, marks, table);
  check_methods(methods, marks, table);
  for (std::size_t i = 0; i < methods.size(); ++i)
    if (!has_plan && needs_plan(methods[i], table))
      throw InputError(marks[i], "method '" + methods[i] + "' localizes in a plan, which the mesh '" +
                                     text.scenario.building + "' does not have; ask for SLAM methods only");
  return marks;
}

/// Localization in a plan starts from rooms. Where there are none (on the storey of the prior), the default is what
/// needs none, and asking for it is wrong. `marks`: where each method is asked for; none where the choice is ours.
void check_rooms(ScenarioText& text, const std::vector<Mark>& marks, const bim::Building& plan, int storey,
                 slam::MethodTable table) {
  const bool storey_known = text.scenario.prior.storey == Knowledge::known;
  const bool has_rooms = std::any_of(plan.rooms.begin(), plan.rooms.end(),
                                     [&](const bim::Room& room) { return !storey_known || room.storey == storey; });
  if (has_rooms) return;
  std::vector<std::string>& methods = text.scenario.methods;
  if (marks.empty()) {
    std::erase_if(methods, [&](const std::string& name) { return needs_plan(name, table); });
    return;
  }
  for (std::size_t i = 0; i < methods.size(); ++i)
    if (needs_plan(methods[i], table))
      throw InputError(marks[i], "method '" + methods[i] + "' starts from the rooms of its plan, and '" +
                                     text.scenario.building + "' has none" + (storey_known ? " on this storey" : "") +
                                     "; add rooms, or ask for SLAM methods only");
}

/// The table with the processes of the scenario, which start in its folder, and of the command line.
std::shared_ptr<const ProcessTable> process_table(ScenarioText& text, const Overrides& overrides,
                                                  const std::string& input_path, slam::MethodTable table) {
  std::vector<ProcessSpec>& processes = text.scenario.processes;
  std::vector<Mark> marks = marks_of(text.tree, {"processes"}, processes.size());
  const std::string folder = fs::absolute(input_path).parent_path().lexically_normal().string();
  for (ProcessSpec& process : processes) process.folder = process_folder(process.folder, folder);
  processes.insert(processes.end(), overrides.processes.begin(), overrides.processes.end());
  marks.resize(processes.size(), Mark{"--method", 0, 0});
  return std::make_shared<const ProcessTable>(table, processes, marks);
}

/// Why a method of this kind never has a metric, whatever the walk; empty where it may.
std::string why_never(const std::string& metric, bool localizes) {
  if (is_metric_of(metric, localizes)) return {};
  if (!localizes) return "it does not localize in the plan, as this metric asks";
  return "it localizes in the plan, and this metric is of SLAM; `localization.*` would be right";
}

/// A gate that could only fail is refused before anything is walked.
void check_gates_can_be_met(const ScenarioText& text, slam::MethodTable table) {
  const Scenario& scenario = text.scenario;
  const Tree* written = text.tree.is_map() ? text.tree.find("gates") : nullptr;
  for (std::size_t i = 0; written != nullptr && i < scenario.gates.size(); ++i) {
    const GateSpec& gate = scenario.gates[i];
    const std::string why = why_never(gate.metric, needs_plan(gate.method, table));
    if (why.empty() || i >= written->as_list().size()) continue;
    const Tree& one = written->as_list()[i];
    const Tree* metric = one.find("metric");
    throw InputError(metric != nullptr ? metric->mark : one.mark,
                     "'" + gate.method + "' never has '" + gate.metric + "': " + why);
  }
}

/// Returns where each method is asked for.
std::vector<Mark> resolve_methods(ScenarioText& text, const Overrides& overrides, bool has_plan,
                                  ResolvedScenario& resolved) {
  Scenario& scenario = text.scenario;
  std::vector<Mark> methods = choose_methods(text, overrides, has_plan, resolved.table);
  const auto asked = [&](const GateSpec& gate) {
    return std::find(scenario.methods.begin(), scenario.methods.end(), gate.method) != scenario.methods.end();
  };
  const std::vector<Mark> marks = marks_of(text.tree, {"gates"}, scenario.gates.size());
  for (std::size_t i = 0; i < scenario.gates.size(); ++i) {
    if (asked(scenario.gates[i])) continue;
    check_methods({scenario.gates[i].method}, {marks[i]}, resolved.table);
    if (overrides.methods) continue;
    throw InputError(marks[i],
                     "the gate's method '" + scenario.gates[i].method + "' is not one of the scenario's methods");
  }
  check_gates_can_be_met(text, resolved.table);
  const auto kept = std::stable_partition(scenario.gates.begin(), scenario.gates.end(), asked);
  resolved.dropped_gates = static_cast<int>(scenario.gates.end() - kept);
  scenario.gates.erase(kept, scenario.gates.end());
  return methods;
}

/// A compass with slam::Prior's error, drawn once a run.
slam::Prior make_prior(const Scenario& scenario, const bim::Plan& as_planned, const RoutePlan& plan) {
  slam::Prior prior;
  const double yaw = plan.yaw_deg * std::numbers::pi / 180.0;
  if (scenario.prior.yaw == Knowledge::known)
    prior.yaw_W = wrap_angle(yaw + prior.yaw_sigma * Stream(scenario.seed, "scenario.prior").gauss(0));
  if (scenario.prior.storey == Knowledge::known)
    prior.storey = as_planned.storeys[static_cast<std::size_t>(plan.storey)].name;
  return prior;
}

sim::WorldConfig make_world(const Scenario& scenario, const RoutePlan& plan) {
  sim::WorldConfig world;
  world.seed = scenario.seed;
  world.lidar = lidar_config(scenario.lidar);
  world.rpm = scenario.lidar.rpm;
  world.vertical_offsets = scenario.lidar.vertical_offsets;
  world.odometry = scenario.odometry.preset;
  world.faults = faults(scenario.faults);
  world.conditions = conditions(scenario.ground, scenario.pushes);
  world.storey = plan.storey;
  world.start_W = plan.start_W;
  world.start_yaw = plan.yaw_deg * std::numbers::pi / 180.0;
  world.waypoints = plan.waypoints;
  world.speed_mps = scenario.speed_mps;
  world.duration_s = scenario.duration_s;
  return world;
}

/// The walk from where the robot is set down, whose place it resolves. The random draw differs from that of the start.
RoutePlan plan_after_kidnap(const bim::Building& walked, const Tree& tree, Scenario& scenario) {
  Scenario after = scenario;
  after.start = scenario.kidnap->to;
  after.seed = Digest().add(scenario.seed).add("kidnap").value();
  const RouteMarks marks{mark_at(tree, {"kidnap", "to"}), mark_at(tree, {"route"}),
                         marks_of(tree, {"route", "rooms"}, after.route.rooms.size())};
  sample_start(walked, after, marks);
  RoutePlan plan = plan_route(walked, after.start, after.route, marks);
  const std::string& storey = walked.storeys[static_cast<std::size_t>(plan.storey)].id;
  scenario.kidnap->to = Start{std::nullopt, std::nullopt, storey, plan.start_W, plan.yaw_deg};
  return plan;
}

/// What a run directory calls its copy of the building. A mesh is recognised by its ending, which stays.
std::string name_of_copy(const fs::path& building, const std::string& bytes) {
  if (bim::is_mesh_path(building.string())) return "building" + building.extension().string();
  return is_ifc(bytes) ? "building.ifc" : "building.plan.yaml";
}

/// A mesh has neither rooms to furnish nor planned furniture.
void check_furniture(const ScenarioText& text) {
  if (!bim::is_mesh_path(text.scenario.building)) return;
  const auto refuse = [&](const char* key) {
    throw InputError(mark_at(text.tree, {key}),
                     std::string(key) + " is of a building with a plan; '" + text.scenario.building + "' is a mesh");
  };
  if (text.scenario.furnish) refuse("furnish");
  if (text.scenario.world.furniture != bim::FurnitureWorld::as_planned) refuse("world");
}

/// LiDAR alone must be enough for the method.
void check_sensors(const MethodChoice& choice, const Mark& mark, slam::MethodTable table) {
  if (choice.sensors == Sensors::all) return;
  if (choice.method == truth_method) throw InputError(mark, "method 'truth' reads no sensors; ask for it as 'truth'");
  if (!runs_on_lidar_alone(*row_of(choice.method, table)))
    throw InputError(mark, "method '" + choice.method + "' needs odometry and does not run with LiDAR alone");
}

}  // namespace

void check_methods(const std::vector<std::string>& names, const std::vector<Mark>& marks, slam::MethodTable table) {
  const std::vector<std::string> known = method_names(table);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      throw InputError(marks[i], "method '" + names[i] + "' is asked for twice");
    const MethodChoice choice = choice_of(names[i]);
    if (std::find(known.begin(), known.end(), choice.method) != known.end()) {
      check_sensors(choice, marks[i], table);
      continue;
    }
    if (names[i].find('=') != std::string::npos)
      throw InputError(marks[i],
                       "'" + names[i] + "' is no name; a process is {name: NAME, command: [PROGRAM, ARGUMENT]}");
    for (const slam::MethodRow& row : table)
      if (!row.former.empty() && row.former == choice.method)
        throw InputError(marks[i], "method '" + names[i] + "' is now called '" +
                                       MethodChoice{std::string(row.name), choice.sensors}.label() + "'");
    const std::string close = did_you_mean(choice.method, known);
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    throw InputError(
        marks[i],
        "unknown method '" + names[i] + "'; " +
            (close.empty() ? "known: " + list : "did you mean '" + MethodChoice{close, choice.sensors}.label() + "'?"));
  }
}

ResolvedScenario resolve(const std::string& input, const Overrides& overrides, slam::MethodTable table) {
  ResolvedScenario resolved;
  const std::string input_path = find_input(input);
  ScenarioText text = read_input(input_path);
  resolved.processes = process_table(text, overrides, input_path, table);
  resolved.table = table = resolved.processes->table();
  std::vector<Mark> method_marks =
      resolve_methods(text, overrides, !bim::is_mesh_path(text.scenario.building), resolved);
  if (overrides.seed) text.scenario.seed = *overrides.seed;
  const bool is_implicit = text.tree.as_map().empty();
  if (is_implicit && !overrides.methods) method_marks.clear();

  const fs::path building = fs::path(input_path).parent_path() / text.scenario.building;
  if (!is_implicit && !fs::exists(building))
    throw InputError(mark_at(text.tree, {"building"}), "the building '" + building.string() + "' does not exist");
  resolved.building_bytes = bim::read_building_file(building.string());
  check_furniture(text);
  bim::PlannedAndBuilt site = load_site(building.string(), text.scenario);

  const RouteMarks marks{mark_at(text.tree, {"start"}), mark_at(text.tree, {"route"}),
                         marks_of(text.tree, {"route", "rooms"}, text.scenario.route.rooms.size())};
  const bim::Building walked = walked_building(site);
  sample_start(walked, text.scenario, marks);
  const sim::MultiStoreyPlanner space(walked);
  std::optional<double> longest_m;
  if (is_implicit) longest_m = walk_length(default_longest_s, text.scenario.speed_mps);
  const RoutePlan plan = plan_route(space, text.scenario.start, text.scenario.route, marks, longest_m);
  resolved.walk = walk_coverage(space, plan);
  const std::vector<std::string> asked = text.scenario.route.rooms;
  resolved.own_route = text.scenario.route.shuttle || asked != Route().rooms;
  check_rooms(text, method_marks, site.as_planned, plan.storey, table);
  if (is_implicit)
    text.scenario.duration_s =
        std::min(default_longest_s, walk_duration(plan.length_m, plan.stairs_m, text.scenario.speed_mps));

  Scenario& scenario = text.scenario;
  const std::string& storey = site.as_planned.storeys[static_cast<std::size_t>(plan.storey)].id;
  scenario.start = Start{std::nullopt, std::nullopt, storey, plan.start_W, plan.yaw_deg};
  scenario.route.rooms = scenario.route.shuttle ? std::vector<std::string>{} : plan.rooms;
  scenario.route.storeys = RouteStoreys::start;
  scenario.route.random.reset();
  scenario.building = name_of_copy(building, resolved.building_bytes);
  resolved.world = make_world(scenario, plan);
  resolved.calibration = sim::told_calibration(sim::World::calibration(), resolved.world.faults.mount, scenario.seed);
  resolved.world.people = place_people(walked, scenario, text.tree, plan.storey);
  resolved.world.doors = place_doors(site.as_built, scenario, text.tree);
  if (scenario.kidnap) {
    resolved.world_after = make_world(scenario, plan_after_kidnap(walked, text.tree, scenario));
    resolved.world_after->people = resolved.world.people;
    resolved.world_after->doors = resolved.world.doors;
    resolved.world.duration_s = scenario.kidnap->after_s;
  }
  resolved.building = std::make_shared<const RunBuilding>(std::move(site), scenario.plan.furniture);
  resolved.prior = make_prior(scenario, *resolved.building->plan_as_planned(), plan);
  resolved.scenario = std::move(scenario);
  return resolved;
}

std::vector<std::string> walk_notes(const ResolvedScenario& resolved) {
  constexpr std::size_t most_reasons = 6;
  const WalkCoverage& walk = resolved.walk;
  std::vector<std::string> notes;
  for (const bim::Warning& warning : resolved.building->as_planned().warnings)
    if (warning.kind == "few_chairs" || warning.kind == "recentred") notes.push_back("warning: " + warning.text);
  if (resolved.own_route) {  // what else it says of its walk stands in results.json and on the page
    for (const std::string& storey : walk.storeys_out_of_reach)
      notes.push_back("warning: `storeys: all` leaves out " + storey);
    return notes;
  }
  for (const std::string& warning : walk_warnings(walk)) notes.push_back("warning: " + warning);
  for (const std::string& line : out_of_reach_lines(walk, most_reasons)) notes.push_back("out of reach: " + line);
  for (std::string& line : left_out_lines(walk)) notes.push_back(std::move(line));
  return notes;
}

}  // namespace plumbline::scenarios
