// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/runner.h"

#include "bim/digest/float_mode.h"
#include "bim/errors.h"
#include "bim/mesh/mesh.h"
#include "bim/plan/plan.h"
#include "bim/random/stream.h"
#include "scenarios/run/ground_truth_recorder.h"
#include "scenarios/run/method_runner.h"
#include "scenarios/run/run_pipeline.h"
#include "scenarios/run/simulated_run.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

std::vector<std::unique_ptr<Participant>> make_participants(const ResolvedScenario& resolved) {
  const auto plan = std::make_shared<const bim::Plan>(bim::make_plan(resolved.site.as_planned));
  std::vector<std::unique_ptr<Participant>> participants;
  for (const std::string& name : resolved.scenario.methods) {
    if (name == truth_method) {
      participants.push_back(make_truth());
      continue;
    }
    const slam::MethodRow* row = slam::find_method(name, resolved.table);
    if (row == nullptr) throw InternalError("method '" + name + "' is not in the table");
    slam::MethodInput input;
    input.seed = method_seed(resolved.scenario.seed, name);
    input.calibration = sim::World::calibration();
    if (row->needs_plan) {
      input.plan = plan;
      input.prior = resolved.prior;
    }
    participants.push_back(make_estimator(*row, input));
  }
  return participants;
}

RunRecord execute(const ResolvedScenario& resolved, const RunOptions& options) {
  set_float_mode();
  const bim::Building& as_built = resolved.site.as_built;
  const bim::BuildingMesh mesh = bim::build_mesh(as_built);
  Walk walk(resolved, mesh);
  FrameRecorder recorder(mesh);
  RunRecord record;

  const FrameSource source = [&](sim::WorldFrame& frame) {
    try {
      if (!walk.next(frame)) return false;
    } catch (const ScenarioFailure& failure) {
      record.failure = failure.what();
      return false;
    }
    for (const slam::StageTime& time : frame.times) add_time(record.sim_times, time);
    return !options.until_s || slam::seconds(frame.scan.stamp) <= *options.until_s;
  };
  const FrameObserver observe = [&](const sim::WorldFrame& frame) {
    recorder.observe(frame);
    if (options.sensors) options.sensors(frame);
    if (options.tick) options.tick(slam::seconds(frame.scan.stamp));
  };
  std::vector<std::unique_ptr<Participant>> participants;
  if (options.methods) participants = make_participants(resolved);
  record.methods = run_pipeline(source, observe, std::move(participants), {.threads = options.threads});

  recorder.move_into(record);
  std::vector<DigestLog> logs = {recorder.digests()};
  for (const MethodRecord& method : record.methods) logs.push_back(method.digests);
  record.digests = merge_logs(logs);
  return record;
}

}  // namespace plumbline::scenarios
