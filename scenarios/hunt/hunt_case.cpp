// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt_case.h"

#include <algorithm>
#include <filesystem>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/generators/generators.h"
#include "scenarios/host/files.h"
#include "scenarios/hunt/hunt.h"
#include "scenarios/hunt/methods_alone.h"
#include "scenarios/spec/generated_walk.h"
#include "scenarios/spec/resolve.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// What a hunt asks of every run, as a sweep would.
SweepFile asked_of_all(const HuntFile& file) {
  SweepFile sweep;
  sweep.methods = file.methods;
  return sweep;
}

/// Beside scenario.yaml, whatever the user calls it. The ending says what it is.
std::string name_in_case(const std::string& building) {
  constexpr std::string_view plan = ".plan.yaml";
  return "building" + (building.ends_with(plan) ? std::string(plan) : fs::path(building).extension().string());
}

}  // namespace

HuntCases::HuntCases(const Hunt& hunt, const std::string& work, slam::MethodTable table)
    : hunt_(hunt), work_(work), table_(table) {
  for (const HuntBase& base : hunt.bases) {
    if (!base.family) {
      const auto& scenario = templates_.try_emplace(base.scenario, base.scenario, base.mark).first->second;
      if (scenario.building_bytes().empty())
        throw InputError(base.mark, "the building of '" + base.scenario + "' does not exist");
      bytes_.try_emplace(base.scenario, std::make_shared<const std::string>(scenario.building_bytes()));
    }
    check_ends(base);
  }
}

/// All ranges at their least and at their greatest, and every value that is named.
void HuntCases::check_ends(const HuntBase& base) const {
  const std::size_t dimensions = base.dimensions(hunt_.file), first = dimensions - hunt_.file.vary.size();
  for (const double u : {0.0, 1.0 - 1e-9}) check(base, Point(dimensions, u));
  for (std::size_t k = 0; k < hunt_.file.vary.size(); ++k) {
    const std::size_t count = hunt_.file.vary[k].values.size();
    for (std::size_t i = 0; i < count; ++i) {
      Point point(dimensions, 0.0);
      point[first + k] = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      check(base, point);
    }
  }
}

/// A key that no scenario has, a value that it cannot have or an unknown method is a mistake, wherever it is drawn.
void HuntCases::check(const HuntBase& base, const Point& point) const {
  HuntRun run;
  run.values = values_at(base, point);
  const std::size_t first = base.family ? base.family->options.size() : 0;
  if (base.family) {
    Scenario scenario;
    scenario.building = "building.plan.yaml";
    write_file(work_ + "/" + base.name + ".yaml", write_scenario(scenario));
  }
  const std::string path = base.family ? work_ + "/" + base.name + ".yaml" : base.scenario;
  const RunCase made = varied(ScenarioTemplate(path, base.mark), nullptr, base, first, run);
  const std::vector<std::string> methods = methods_of_case(made);
  const ProcessTable table = ScenarioTemplate(path, base.mark).methods(table_, base.mark);
  check_methods(methods, std::vector<Mark>(methods.size(), base.mark), table.table());
  check_gated(methods, table.table());
}

/// A gate of a method that is not asked for would be refused in every run.
void HuntCases::check_gated(const std::vector<std::string>& methods, slam::MethodTable table) const {
  for (std::size_t i = 0; i < hunt_.file.gates.size(); ++i) {
    const std::string& method = hunt_.file.gates[i].method;
    const Mark& mark = hunt_.gate_marks[i];
    if (std::find(methods.begin(), methods.end(), method) != methods.end()) continue;
    check_methods({method}, {mark}, table);
    if (!methods.empty())
      throw InputError(mark, "the gate's method '" + method + "' is not one of the methods of the runs");
  }
}

DrawnValues HuntCases::values_at(const HuntBase& base, const Point& point) const {
  DrawnValues values;
  const std::size_t first = base.family ? base.family->options.size() : 0;
  for (std::size_t k = 0; k < first; ++k) {
    const HuntRange& range = base.family->options[k];
    values.emplace_back(base.name + " " + range.key, value_at(range, point[k]));
  }
  for (std::size_t k = 0; k < hunt_.file.vary.size(); ++k)
    values.emplace_back(hunt_.file.vary[k].key, value_at(hunt_.file.vary[k], point[first + k]));
  return values;
}

void HuntCases::make(HuntRun& run) const {
  const HuntBase& base = hunt_.bases[run.base];
  run.values = values_at(base, run.point);
  try {
    run.run = base.family ? generated(base, run)
                          : varied(templates_.at(base.scenario), bytes_.at(base.scenario), base, 0, run);
  } catch (const InputError& error) {
    const std::string what = error.what();
    const std::size_t place = what.find(": ");
    run.why = what.starts_with(work_) && place != std::string::npos ? what.substr(place + 2) : what;
  }
}

RunCase HuntCases::generated(const HuntBase& base, const HuntRun& run) const {
  Tree options = Tree::map();
  options.mark = base.mark;
  for (std::size_t k = 0; k < base.family->options.size(); ++k)
    options.set(base.family->options[k].key, run.values[k].second);
  if (options.find("seed") == nullptr) options.set("seed", std::to_string(run.seed));
  const bim::GeneratedPlan plan = bim::generate(base.family->family, options);
  const std::string text = bim::write_plan(plan.plan), name = base.name + ".plan.yaml";
  write_file(work_ + "/" + name, text);
  write_file(work_ + "/" + base.name + ".yaml", write_scenario(generated_walk(plan, text, name)));
  return varied(ScenarioTemplate(work_ + "/" + base.name + ".yaml", base.mark),
                std::make_shared<const std::string>(text), base, base.family->options.size(), run);
}

RunCase HuntCases::varied(const ScenarioTemplate& scenario, Bytes bytes, const HuntBase& base, std::size_t first,
                          const HuntRun& run) const {
  SweepVariant variant;
  for (std::size_t k = 0; k < hunt_.file.vary.size(); ++k)
    variant.set.push_back(hunt_.file.vary[k].key + "=" + run.values[first + k].second);
  Tree tree = scenario.with(variant, nullptr, asked_of_all(hunt_.file), base.mark, table_);
  tree.set("seed", std::to_string(run.seed));
  if (!hunt_.file.gates.empty()) {
    Tree gates = Tree::list();
    for (const GateSpec& gate : hunt_.file.gates) gates.push(to_tree(gate));
    tree.set("gates", std::move(gates));
  }
  const std::string name = name_in_case(scenario.building());
  tree.set("building", name);
  return {tree, name, std::move(bytes)};
}

}  // namespace plumbline::scenarios
