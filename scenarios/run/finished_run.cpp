// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/finished_run.h"

#include <utility>

#include "scenarios/run/as_written.h"
#include "scenarios/run/run_files.h"

namespace plumbline::scenarios {

std::vector<slam::Nanoseconds> scans_of(const DigestLog& log) {
  std::vector<slam::Nanoseconds> scans;
  for (const DigestEntry& entry : log)
    if (entry.stage == "sim.lidar") scans.push_back(entry.tick);
  return scans;
}

FinishedRun finished_run(const ResolvedScenario& resolved, RunRecord record) {
  round_as_written(record.truth_W);
  for (MethodRecord& method : record.methods) {
    round_as_written(method);
    if (is_oracle(method)) give_truth(record, method);
  }
  FinishedRun run;
  run.scenario = resolved.scenario;
  run.building = resolved.building;
  run.walk = resolved.walk;
  run.scans = scans_of(record.digests);
  run.record = std::move(record);
  return run;
}

}  // namespace plumbline::scenarios
