// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/runner.h"

#include <algorithm>
#include <utility>

#include "bim/digest/float_mode.h"
#include "bim/errors.h"
#include "bim/random/stream.h"
#include "scenarios/run/ground_truth_recorder.h"
#include "scenarios/run/method_runner.h"
#include "scenarios/run/run_pipeline.h"
#include "scenarios/run/simulated_run.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

RunMethods make_methods(const ResolvedScenario& resolved) {
  RunMethods methods;
  for (const std::string& name : resolved.scenario.methods) {
    if (name == truth_method) {
      methods.oracle.emplace();
      continue;
    }
    const slam::MethodRow* row = row_of(name, resolved.table);
    if (row == nullptr) throw InternalError("method '" + name + "' is not in the table");
    slam::MethodInput input;
    input.seed = method_seed(resolved.scenario.seed, seed_name(*row));  // whatever it is fed
    input.calibration = resolved.calibration;
    if (row->needs_plan) {
      input.plan = resolved.building->plan_as_planned();
      input.prior = resolved.prior;
    }
    methods.estimators.push_back(std::make_unique<MethodRunner>(*row, std::move(input), choice_of(name).sensors));
  }
  return methods;
}

std::vector<MethodRecord> RunMethods::finish(const Scenario& scenario, std::vector<MethodRecord> estimated) {
  if (!oracle) return estimated;
  const auto at = std::find(scenario.methods.begin(), scenario.methods.end(), truth_method) - scenario.methods.begin();
  estimated.insert(estimated.begin() + at, oracle->finish());
  return estimated;
}

RunRecord execute(const ResolvedScenario& resolved, const RunOptions& options) {
  set_float_mode();
  SimulatedRun simulation(resolved);
  GroundTruthRecorder recorder(resolved.building->mesh_as_built());
  RunMethods methods;
  if (options.methods) methods = make_methods(resolved);
  RunRecord record;

  const SensorSource source = [&](slam::SensorFrame& sensors) {
    sim::WorldFrame frame;
    try {
      if (!simulation.next(frame)) return false;
    } catch (const ScenarioFailure& failure) {
      record.failure = failure.what();
      return false;
    }
    for (const slam::StageTime& time : frame.times) add_time(record.sim_times, time);
    const double t_s = slam::seconds(frame.sensors.scan.stamp);
    if (options.until_s && t_s > *options.until_s) return false;
    recorder.observe(frame);
    if (methods.oracle) methods.oracle->on_truth(frame.truth);
    if (options.observe) options.observe(frame);
    if (options.tick) options.tick(t_s);
    sensors = std::move(frame.sensors);
    return true;
  };
  record.methods = methods.finish(resolved.scenario,
                                  run_pipeline(source, std::move(methods.estimators), {.threads = options.threads}));

  recorder.move_into(record);
  std::vector<DigestLog> logs = {recorder.digests()};
  for (const MethodRecord& method : record.methods) logs.push_back(method.digests);
  record.digests = merge_logs(logs);
  return record;
}

}  // namespace plumbline::scenarios
