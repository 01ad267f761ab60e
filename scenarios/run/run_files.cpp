// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/run_files.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "scenarios/host/files.h"
#include "scenarios/run/cloud_file.h"
#include "scenarios/run/estimate_file.h"
#include "scenarios/spec/method_names.h"
#include "scenarios/spec/run_site.h"
#include "slam/io/clouds/cloud_file.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view estimate_end = ".estimate.json";
/// Of what a method may leave besides estimate and trajectories.
constexpr std::array<const char*, 4> other_ends = {".map.ply", ".map.pcd", ".graph.json", ".hypotheses.jsonl"};

/// The scenario's methods in its order, then every other method with an estimate here, by name.
std::vector<std::string> method_names_in(const std::string& dir, const Scenario& scenario) {
  std::vector<std::string> names = scenario.methods;
  for (std::string& name : estimates_in(dir))
    if (std::find(scenario.methods.begin(), scenario.methods.end(), name) == scenario.methods.end())
      names.push_back(std::move(name));
  return names;
}

}  // namespace

bool is_oracle(const MethodRecord& method) { return method.name == truth_method; }

void give_truth(const RunRecord& run, MethodRecord& oracle) {
  oracle.causal = run.truth_W;
  oracle.estimate.trajectory = run.truth_W;
  oracle.estimate.map_F = run.surface_W;
}

void write_method(const std::string& dir, const MethodRecord& method) {
  const std::string stem = dir + "/" + method.name;
  write_file(stem + std::string(estimate_end), write_estimate(method));
  if (is_oracle(method)) return;
  write_file(stem + ".tum", slam::write_tum(method.causal));
  write_file(stem + ".final.tum", slam::write_tum(method.estimate.trajectory));
  for (const char* end : other_ends) fs::remove(stem + end);  // of an estimate that had this name before
  if (!method.estimate.map_F.empty()) {
    write_file(stem + ".map.ply", write_ply(method.estimate.map_F));
    slam::write_cloud_file(stem + ".map.pcd", slam::cloud_of(method.estimate.map_F));
  }
  if (!method.estimate.graph.is_null()) write_file(stem + ".graph.json", write_json(method.estimate.graph, 0) + "\n");
  if (method.localization) write_file(stem + ".hypotheses.jsonl", write_beliefs(method.beliefs));
}

void remove_method(const std::string& dir, const std::string& name) {
  const std::string stem = dir + "/" + name;
  fs::remove(stem + std::string(estimate_end));  // first: without it the others belong to no method
  for (const char* end : {".tum", ".final.tum"}) fs::remove(stem + end);
  for (const char* end : other_ends) fs::remove(stem + end);
}

std::vector<std::string> files_of_method(const std::string& name) {
  std::vector<std::string> files = {name + std::string(estimate_end), name + ".tum", name + ".final.tum"};
  for (const char* end : other_ends) files.push_back(name + end);
  return files;
}

MethodRecord read_method(const std::string& dir, const std::string& name) {
  const std::string stem = dir + "/" + name;
  const auto text_if_there = [](const std::string& path) {
    std::error_code error;
    return fs::exists(path) && fs::file_size(path, error) > 0 ? read_text_file(path) : std::string();
  };
  MethodRecord method;
  const std::string estimate = stem + std::string(estimate_end);
  read_estimate(read_text_file(estimate), estimate, method);
  if (method.name != name) throw InputError({estimate, 0, 0}, "is of method '" + method.name + "', not " + name);
  method.causal = slam::read_tum(text_if_there(stem + ".tum"), stem + ".tum");
  method.estimate.trajectory = slam::read_tum(text_if_there(stem + ".final.tum"), stem + ".final.tum");
  const std::string map = text_if_there(stem + ".map.ply");
  if (!map.empty()) method.estimate.map_F = read_ply(map, stem + ".map.ply");
  method.beliefs = read_beliefs(text_if_there(stem + ".hypotheses.jsonl"), stem + ".hypotheses.jsonl");
  return method;
}

std::vector<std::string> estimates_in(const std::string& dir) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(dir)) {
    const std::string file = entry.path().filename().string();
    if (file.size() > estimate_end.size() && file.ends_with(estimate_end))
      names.push_back(file.substr(0, file.size() - estimate_end.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

void write_run_files(const std::string& dir, const ResolvedScenario& resolved, const RunRecord& record) {
  write_file(dir + "/" + resolved.scenario.building, resolved.building_bytes);
  write_file(dir + "/scenario.yaml", write_scenario(resolved.scenario));
  write_file(dir + "/digests.csv", write_digests(record.digests));
  write_file(dir + "/truth.tum", slam::write_tum(record.truth_W));
  write_file(dir + "/truth_surface.ply", write_ply(record.surface_W));
  for (const MethodRecord& method : record.methods) write_method(dir, method);
  if (!record.failure.empty()) write_file(dir + "/failure.txt", record.failure + "\n");
}

void check_run_directory(const std::string& dir) {
  if (!fs::is_directory(dir)) throw InputError({dir, 0, 0}, "no such directory; a run directory is expected");
  if (fs::exists(dir + "/recording.yaml"))
    throw InputError({dir, 0, 0}, "is a recording, not a run; run plumbline estimate on it first");
  for (const char* name : {"scenario.yaml", "digests.csv", "truth.tum", "truth_surface.ply"})
    if (!fs::exists(dir + "/" + name))
      throw InputError({dir, 0, 0}, "is no run directory, since it has no " + std::string(name) +
                                        "; name one that plumbline run wrote, or score one of plumbline estimate");
}

FinishedRun read_run(const std::string& dir) {
  check_run_directory(dir);
  const auto path = [&](std::string_view name) { return dir + "/" + std::string(name); };
  FinishedRun run;
  run.scenario = read_scenario(read_text_file(path("scenario.yaml")), path("scenario.yaml")).scenario;
  run.building = std::make_shared<const RunBuilding>(load_site(path(run.scenario.building), run.scenario),
                                                     run.scenario.plan.furniture);
  run.walk = walk_coverage(run.building->variants(), run.scenario);
  RunRecord& record = run.record;
  record.digests = read_digests(read_text_file(path("digests.csv")), path("digests.csv"));
  run.scans = scans_of(record.digests);
  if (run.scans.empty()) throw InputError({path("digests.csv"), 0, 0}, "holds no scan; the run ended before its first");
  record.truth_W = slam::read_tum(read_text_file(path("truth.tum")), path("truth.tum"));
  record.surface_W = read_ply(read_text_file(path("truth_surface.ply")), path("truth_surface.ply"));
  for (const std::string& name : method_names_in(dir, run.scenario)) {
    MethodRecord& method = record.methods.emplace_back(read_method(dir, name));
    if (is_oracle(method)) give_truth(record, method);
  }
  if (fs::exists(path("failure.txt"))) {
    record.failure = read_text_file(path("failure.txt"));
    while (!record.failure.empty() && record.failure.back() == '\n') record.failure.pop_back();
  }
  return run;
}

}  // namespace plumbline::scenarios
