// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/run_case.h"

#include <filesystem>

#include "bim/digest/digest.h"
#include "bim/load/load.h"
#include "scenarios/host/files.h"
#include "scenarios/spec/process_tree.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

RunCase read_case(const std::string& scenario_path) {
  const std::string text = read_text_file(scenario_path);
  const Scenario scenario = read_scenario(text, scenario_path).scenario;
  const fs::path folder = fs::absolute(scenario_path).parent_path().lexically_normal();
  const fs::path building = folder / scenario.building;
  RunCase run{with_process_folders(read_yaml(text, scenario_path), folder.string()), building.filename().string(),
              std::make_shared<const std::string>(bim::read_building_file(building.string()))};
  run.scenario.set("building", run.building);
  return run;
}

void write_case(const std::string& folder, const RunCase& run) {
  write_file(folder + "/" + run.building, *run.bytes);
  write_file(folder + "/scenario.yaml", write_yaml(run.scenario));
}

void check_case(const RunCase& run) { (void)read_scenario(write_yaml(run.scenario), "scenario.yaml"); }

std::uint64_t seed_of(const RunCase& run) {
  return read_scenario(write_yaml(run.scenario), "scenario.yaml").scenario.seed;
}

std::uint64_t digest_of(const RunCase& run) {
  return Digest().add(write_yaml(run.scenario)).add(run.building).add(*run.bytes).value();
}

}  // namespace plumbline::scenarios
