// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/scenario.h"

#include <algorithm>

#include "bim/rays/ray_bodies.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/spec/process_tree.h"

namespace plumbline::scenarios {

namespace {

/// A scalar becomes the list of it.
void make_list(Tree& value) {
  if (!value.is_scalar() || value.is_null()) return;
  Tree list = Tree::list();
  list.mark = value.mark;
  list.push(value);
  value = std::move(list);
}

/// `rooms: all` and `sensors: lidar` are scalars in the file; lists are read everywhere else.
Tree with_lists(Tree tree) {
  for (auto& [key, child] : std::get<Tree::Map>(tree.value)) {
    if (key == "sensors") make_list(child);
    if (key != "route" || !child.is_map()) continue;
    for (auto& [route_key, rooms] : std::get<Tree::Map>(child.value))
      if (route_key == "rooms") make_list(rooms);
  }
  return tree;
}

void check_gates(const Scenario& scenario, const Tree& tree) {
  const Tree* gates = tree.find("gates");
  for (std::size_t i = 0; i < scenario.gates.size(); ++i) check_gate(scenario.gates[i], gates->as_list()[i]);
}

/// Values that this kind of route has no use for.
void check_route_counts(const Route& route, const Tree& tree) {
  const Route unset;
  if (!route.shuttle && route.times != unset.times)
    throw InputError(mark_at(tree, {"route", "times"}), "times is of a shuttle; rooms take loop");
  if (route.shuttle && route.loop != unset.loop)
    throw InputError(mark_at(tree, {"route", "loop"}), "loop is of rooms; a shuttle takes times");
  if (route.storeys != unset.storeys && (route.shuttle || route.random || route.rooms != unset.rooms))
    throw InputError(mark_at(tree, {"route", "storeys"}), "storeys is of `rooms: all`; this route names its rooms");
}

void check_route_and_start(const Scenario& scenario, const Tree& tree) {
  if (scenario.start.room && scenario.start.at)
    throw InputError(mark_at(tree, {"start"}), "start takes either a room or a point `at`, not both");
  if (scenario.start.room && scenario.start.storey)
    throw InputError(mark_at(tree, {"start", "storey"}),
                     "a start in a room takes no storey, which follows from the room");
  if (scenario.start.random && (scenario.start.room || scenario.start.at))
    throw InputError(mark_at(tree, {"start", "random"}), "a drawn start takes neither a room nor a point `at`");
  const bool names_rooms = tree.find("route") != nullptr && tree.find("route")->find("rooms") != nullptr;
  if (scenario.route.shuttle && names_rooms && !scenario.route.rooms.empty())
    throw InputError(mark_at(tree, {"route"}), "route takes either rooms or shuttle, not both");
  if (scenario.route.random && (scenario.route.shuttle || names_rooms))
    throw InputError(mark_at(tree, {"route", "random"}), "a drawn route takes neither rooms nor shuttle");
  if (names_rooms && scenario.route.rooms.empty() && !scenario.route.shuttle)
    throw InputError(mark_at(tree, {"route", "rooms"}), "names no room; name rooms to walk to, or all");
  check_route_counts(scenario.route, tree);
}

void check_kidnap(const Scenario& scenario, const Tree& tree) {
  if (!scenario.kidnap) return;
  const Start& to = scenario.kidnap->to;
  if (to.random.has_value() + to.room.has_value() + to.at.has_value() != 1)
    throw InputError(mark_at(tree, {"kidnap", "to"}), "needs exactly one of a room, a point `at` and a draw `random`");
  if (scenario.kidnap->after_s + scenario.kidnap->away_s >= scenario.duration_s)
    throw InputError(mark_at(tree, {"kidnap"}),
                     "the robot is not set down before the run ends; duration_s must be more "
                     "than after_s and away_s together");
}

void check_bodies(const Scenario& scenario, const Tree& tree) {
  constexpr std::size_t most = bim::MovingBodies::most;
  const std::size_t people = scenario.people.size();
  if (people + scenario.moving_doors.size() <= most) return;
  const Tree& first_too_many =
      people > most ? tree.find("people")->as_list()[most] : tree.find("moving_doors")->as_list()[most - people];
  throw InputError(first_too_many.mark, "people and moving doors together must be at most " + std::to_string(most) +
                                            ", not " + std::to_string(people + scenario.moving_doors.size()));
}

void check_pushes(const PushesSpec& pushes, const Tree& tree) {
  if (pushes.min_n && *pushes.min_n > pushes.max_n)
    throw InputError(mark_at(tree, {"pushes", "min_n"}), "min_n must not be greater than max_n");
}

/// The known name that is meant: the closest, else all that begin with the given one and an underscore, or are so in
/// a block.
std::string suggestion(const std::string& name, const std::vector<std::string>& known) {
  const std::string close = did_you_mean(name, known);
  if (!close.empty()) return "'" + close + "'";
  std::vector<std::string> longer;
  for (const std::string& each : known)
    if (!name.empty() && (each.starts_with(name) || each.find("." + name) != std::string::npos)) longer.push_back(each);
  std::string list;
  for (std::size_t i = 0; i < longer.size(); ++i)
    list += (i == 0 ? "" : i + 1 == longer.size() ? " or " : ", ") + ("'" + longer[i] + "'");
  return list;
}

}  // namespace

void check_gate(const GateSpec& gate, const Tree& written) {
  if (gate.max.has_value() == gate.min.has_value()) throw InputError(written.mark, "a gate needs either max or min");
  if (score::find_metric(gate.metric) != nullptr) return;
  std::vector<std::string> known;
  for (const score::MetricRow& row : score::metrics()) known.emplace_back(row.name);
  const std::string close = suggestion(gate.metric, known);
  const Tree* metric = written.is_map() ? written.find("metric") : nullptr;
  throw InputError(metric != nullptr ? metric->mark : written.mark,
                   "unknown metric '" + gate.metric + "'; " +
                       (close.empty() ? "docs/reference/metrics.md lists them" : "did you mean " + close + "?"));
}

void check_name(const std::string& name, const Mark& mark) {
  if (name.size() > longest_name)
    throw InputError(mark, "a name of " + std::to_string(name.size()) + " letters; it may have at most " +
                               std::to_string(longest_name));
}

ScenarioText read_scenario(std::string_view text, const std::string& file) {
  Tree tree = read_yaml(text, file);
  if (!tree.is_map() || tree.as_map().empty() || tree.as_map().front().first != "scenario")
    throw InputError({file, 1, 1}, "the first key of a scenario must be 'scenario: 1'");
  tree = with_processes_apart(with_lists(std::move(tree)));
  ScenarioText result{from_tree<Scenario>(tree), tree};
  check_name(result.scenario.name, mark_at(tree, {"name"}));
  check_gates(result.scenario, tree);
  check_route_and_start(result.scenario, tree);
  check_pushes(result.scenario.pushes, tree);
  check_faults(result.scenario.faults, mark_at(tree, {"faults"}));
  check_bodies(result.scenario, tree);
  check_kidnap(result.scenario, tree);
  return result;
}

std::string write_scenario(const Scenario& scenario) { return write_yaml(to_tree(scenario)); }

Mark mark_at(const Tree& tree, std::initializer_list<std::string_view> path) {
  const Tree* node = &tree;
  for (const std::string_view key : path) {
    const Tree* child = node->is_map() ? node->find(key) : nullptr;
    if (child == nullptr) break;
    node = child;
  }
  return node->mark;
}

sim::LidarConfig lidar_config(const LidarSpec& spec) {
  sim::LidarConfig config = sim::lidar_config(spec.preset);
  config.model = spec.model;
  config.returns = spec.returns;
  const auto set = [](auto& value, const auto& given) { value = given.value_or(value); };
  set(config.range_noise, spec.range_noise);
  set(config.unit_bias, spec.unit_bias);
  set(config.laser_bias, spec.laser_bias);
  set(config.reflectivity_noise, spec.reflectivity_noise);
  set(config.dropout, spec.dropout);
  set(config.optics, spec.optics);
  set(config.footprint, spec.footprint);
  set(config.distance_bias_m, spec.distance_bias_m);
  set(config.reflectivity_bias_m, spec.reflectivity_bias_m);
  set(config.incidence_bias_m, spec.incidence_bias_m);
  set(config.warm_up_m, spec.warm_up_m);
  set(config.warm_up_s, spec.warm_up_s);
  set(config.airborne_per_m, spec.airborne_per_m);
  return config;
}

sim::Conditions conditions(const GroundSpec& ground, const PushesSpec& pushes) {
  constexpr double least_share = 0.3;  // docs/methods/robot.md
  sim::Conditions out;
  out.friction = ground.friction;
  out.terrain_noise_m = 1e-3 * ground.uneven_mm;
  out.pushes.max_n = pushes.max_n;
  out.pushes.min_n = pushes.min_n.value_or(least_share * pushes.max_n);
  out.pushes.every_s = pushes.every_s;
  out.pushes.on_stairs = pushes.on_stairs;
  return out;
}

namespace {

std::string text_of(const Tree& scalar) {
  const auto* text = std::get_if<std::string>(&scalar.value);
  return text != nullptr ? *text : write_json(scalar, 0);
}

/// Fields of one part of the scenario that are not as usual.
void add_differences(const std::string& part, const Tree& usual, const Tree& written, std::vector<std::string>& names) {
  for (const auto& [key, value] : written.as_map()) {
    const Tree* other = usual.find(key);
    const std::string text = text_of(value);
    if (other == nullptr || text != text_of(*other)) names.push_back(part + "." + key + ": " + text);
  }
}

}  // namespace

std::vector<std::string> off_defaults(const Scenario& scenario) {
  std::vector<std::string> names;
  const Scenario defaults;
  add_differences("lidar", to_tree(defaults.lidar), to_tree(scenario.lidar), names);
  if (scenario.odometry.preset != defaults.odometry.preset)
    names.push_back("odometry.preset: " + to_tree(scenario.odometry).find("preset")->as_string());
  if (scenario.faults) add_differences("faults", to_tree(FaultsSpec{}), to_tree(*scenario.faults), names);
  add_differences("ground", to_tree(defaults.ground), to_tree(scenario.ground), names);
  if (scenario.pushes.max_n > 0.0) add_differences("pushes", to_tree(defaults.pushes), to_tree(scenario.pushes), names);
  const bim::BuildingOptions& options = scenario.building_options;
  if (options.doors != defaults.building_options.doors)
    names.push_back("doors: " + to_tree(options).find("doors")->as_string());
  if (options.furniture != defaults.building_options.furniture)
    names.push_back(std::string("furniture: ") + (options.furniture ? "true" : "false"));
  if (scenario.furnish) {
    const Tree furnish = to_tree(*scenario.furnish);
    for (const auto& [key, value] : furnish.as_map()) names.push_back("furnish." + key + ": " + text_of(value));
  }
  add_differences("plan", to_tree(defaults.plan), to_tree(scenario.plan), names);
  add_differences("world", to_tree(defaults.world), to_tree(scenario.world), names);
  if (scenario.kidnap) names.emplace_back("kidnap");
  if (!scenario.people.empty()) names.push_back("people: " + std::to_string(scenario.people.size()));
  if (!scenario.moving_doors.empty()) names.push_back("moving_doors: " + std::to_string(scenario.moving_doors.size()));
  return names;
}

}  // namespace plumbline::scenarios
