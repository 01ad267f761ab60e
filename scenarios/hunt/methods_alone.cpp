// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/methods_alone.h"

#include <algorithm>
#include <csignal>
#include <string_view>

#include "scenarios/spec/method_names.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace {

bool has_results(const Trial& trial) { return trial.signal == 0 && trial.results && trial.why.empty(); }

/// Why no method is at fault, whatever each does alone; empty where one may be.
std::string why_none(const Trial& truth, const Trial& together) {
  if (has_results(truth)) return {};
  if (truth.signal != 0) return truth.why + ", with the truth alone, too";
  return together.why + "; with the truth alone: " + truth.why;
}

}  // namespace

MethodsAlone methods_alone(const RunCase& run, const Trial& together, const TryCases& try_all) {
  if (together.signal == SIGKILL) return {{}, together.why + ": killed, as where memory is short"};
  std::vector<std::string> methods = methods_of_case(run);
  std::erase(methods, std::string(truth_method));
  if (methods.empty()) return {{}, together.why};
  methods.insert(methods.begin(), std::string(truth_method));
  std::vector<RunCase> alone;
  for (const std::string& method : methods) alone.push_back(with_method(run, method));
  const std::vector<Trial> trials = try_all(alone, {});
  if (std::string why = why_none(trials.front(), together); !why.empty()) return {{}, std::move(why)};
  MethodsAlone result;
  bool any_died = false;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    const Trial& trial = trials[i];
    if (trial.signal != 0 && trial.signal != SIGKILL) {
      result.outcomes.push_back(died(methods[i], trial.why));
      any_died = true;
    } else if (has_results(trial)) {
      for (MethodOutcome& outcome : outcomes_of(*trial.results)) result.outcomes.push_back(std::move(outcome));
    }
  }
  if (!any_died) return {{}, together.why + ", but with no method alone"};
  return result;
}

std::vector<std::string> methods_of_case(const RunCase& run) {
  return read_scenario(write_yaml(run.scenario), "scenario.yaml").scenario.methods;
}

RunCase with_method(RunCase run, const std::string& method) {
  Tree methods = Tree::list(), gates = Tree::list();
  methods.push(method);
  const Tree* all = run.scenario.find("gates");
  if (all != nullptr && all->is_list())
    for (const Tree& gate : all->as_list())
      if (gate.find("method")->as_string() == method) gates.push(gate);
  run.scenario.set("methods", methods).set("gates", gates);
  return run;
}

}  // namespace plumbline::scenarios
