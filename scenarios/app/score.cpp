// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/printable.h"
#include "bim/config/tree.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/estimate_score.h"
#include "scenarios/app/outside_estimate.h"
#include "scenarios/app/outside_gate.h"
#include "scenarios/app/summary.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/ground_truth_recorder.h"
#include "scenarios/run/run_files.h"
#include "scenarios/spec/method_names.h"
#include "slam/io/clouds/cloud_file.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::scenarios {

namespace {

/// What the scores that stand say of outside estimates which stay: their files are in the manifest of the run since.
std::vector<std::string> altered_before(const std::string& dir, const FinishedRun& run) {
  std::vector<std::string> before;
  const std::string path = dir + "/results.json";
  if (!std::filesystem::exists(path)) return before;
  Tree results;
  try {
    results = read_json(read_text_file(path), path);
  } catch (const InputError&) {
    return before;  // it is written anew
  }
  const Tree* names = results.is_map() ? results.find("unchecked") : nullptr;
  if (names == nullptr || !names->is_list()) return before;
  for (const Tree& name : names->as_list())
    for (const MethodRecord& method : run.record.methods)
      if (name.as_string().starts_with(method.name + "=")) before.push_back(name.as_string());
  return before;
}

/// Only outside estimates can be dropped: the run's own cannot be had again without a run.
void check_dropped(const std::vector<std::string>& dropped, const FinishedRun& run) {
  const Mark mark{"--drop", 0, 0};
  const auto& own = run.scenario.methods;
  std::vector<std::string> outside;
  for (const MethodRecord& method : run.record.methods)
    if (std::find(own.begin(), own.end(), method.name) == own.end()) outside.push_back(method.name);
  for (const std::string& name : dropped) {
    if (std::find(own.begin(), own.end(), name) != own.end())
      throw InputError(mark, "'" + name + "' is a method of this run; only outside estimates can be dropped");
    if (std::find(outside.begin(), outside.end(), name) != outside.end()) continue;
    const std::string close = did_you_mean(name, outside);
    throw InputError(
        mark, "there is no outside estimate '" + name + "'" + (close.empty() ? "" : "; did you mean '" + close + "'?"));
  }
}

struct ScoreArguments {
  std::string dir;
  std::vector<std::string> estimates;
  std::vector<std::string> maps;
  std::vector<std::string> gates;
  std::vector<std::string> dropped;
  std::string reference;
  bool unchecked = false;
};

/// Of every estimate that is given with them.
std::vector<GateSpec> gates_of(const std::vector<std::string>& texts) {
  std::vector<GateSpec> gates;
  for (const std::string& text : texts) {
    gates.push_back(parse_gate(text));
    Tree written = Tree::map();
    written.mark = {"--gate", 0, 0};
    check_gate(gates.back(), written);
  }
  return gates;
}

/// NAME=FILE: a cloud in the frame of the trajectory of this name.
void add_map(const std::string& text, std::vector<MethodRecord>& outside) {
  const Mark mark{"--map", 0, 0};
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto method =
      std::find_if(outside.begin(), outside.end(), [&](const MethodRecord& m) { return m.name == name; });
  if (equals == std::string::npos || equals + 1 == text.size())
    throw InputError(mark, "'" + text + "' must be NAME=FILE, a .ply or .pcd");
  if (method == outside.end())
    throw InputError(mark, "there is no --estimate '" + name + "' that it could be the map of");
  const std::string file = text.substr(equals + 1);
  const std::vector<Eigen::Vector3f> points_F = slam::read_cloud_points(file);
  for (const Eigen::Vector3f& p : points_F)
    if (p.norm() > slam::farthest_map_point_m)
      throw InputError({file, 0, 0},
                       "holds a point farther than 50 km from the origin; a map is in the frame of its poses");
  method->estimate.map_F = slam::thin_map(points_F);
  if (method->estimate.map_F.empty()) throw InputError({file, 0, 0}, "holds no point");
}

/// Which gates an outside estimate is asked, and whose they are.
std::string asked_text(const MethodRecord& method, const score::RunScore& score) {
  std::string gates;
  for (const score::GateResult& gate : score.gates)
    if (gate.method == method.name)
      gates += (gates.empty() ? "" : ", ") + gate.metric + " " + gate.op + " " + format_number(gate.limit);
  if (gates.empty())
    return method.name + " is judged by no gate: none of the scenario's applies, and --gate gives none\n";
  return method.name + " is asked " +
         (method.gates.empty() ? "the strictest of the scenario's gates: " : "by --gate: ") + gates + "\n";
}

int score_again(const ScoreArguments& arguments) {
  const auto& [dir, estimates, maps, gates, dropped, reference, unchecked] = arguments;
  const std::vector<GateSpec> own_gates = gates_of(gates);
  if (estimates.empty() && !(gates.empty() && maps.empty()))
    throw InputError({gates.empty() ? "--map" : "--gate", 0, 0}, "is of outside estimates; give them with --estimate");
  FinishedRun run = read_run(dir);
  remove_abandoned(dir);
  std::vector<std::string> written = {"report.html", "junit.xml", "results.json"};
  std::vector<std::string> altered = altered_files(dir, {written, false});
  refuse_altered(dir, altered, unchecked);
  check_dropped(dropped, run);
  std::vector<MethodRecord> outside;
  std::string said;
  for (const std::string& text : estimates) {
    Outside given = read_outside(text, dir, run, unchecked);
    MethodRecord& read = given.method;
    said += given.said;
    if (std::any_of(outside.begin(), outside.end(), [&](const MethodRecord& m) { return m.name == read.name; }))
      throw InputError({"--estimate", 0, 0}, "'" + read.name + "' is given twice");
    read.gates = own_gates;
    for (GateSpec& gate : read.gates) gate.method = read.name;
    outside.push_back(std::move(read));
    altered.insert(altered.end(), given.altered.begin(), given.altered.end());
    const auto& names = run.scenario.methods;
    if (outside.back().name == truth_method ||
        std::find(names.begin(), names.end(), outside.back().name) != names.end())
      throw InputError({"--estimate", 0, 0},
                       "'" + outside.back().name + "' is a method of this run; give another name");
  }
  for (const std::string& text : maps) add_map(text, outside);
  for (const std::string& name : altered_before(dir, run)) {
    const std::string method = name.substr(0, name.find('='));
    const bool is_new =
        std::any_of(outside.begin(), outside.end(), [&](const MethodRecord& m) { return m.name == method; });
    if (!is_new && std::find(dropped.begin(), dropped.end(), method) == dropped.end()) altered.push_back(name);
  }
  catch_interrupts();  // which nothing looks at: files and manifest change together
  for (const std::string& name : dropped) remove_method(dir, name);
  for (const MethodRecord& method : outside) write_method(dir, method);
  if (!outside.empty() || !dropped.empty()) run = read_run(dir);
  run.altered = altered;
  const bool has_replay = std::filesystem::exists(dir + "/replay.html");
  const score::RunScore score = score_and_report(dir, run, [&](const score::RunScore&) { return has_replay; });
  std::vector<std::string> methods = dropped;
  for (const MethodRecord& method : outside) methods.push_back(method.name);
  for (const std::string& method : methods)
    for (const std::string& name : files_of_method(method)) written.push_back(name);
  renew_manifest(dir, written);
  std::string asked;
  for (const MethodRecord& method : outside) asked += asked_text(method, score);
  print("report: " + printable(dir) + "/report.html\n" + said + asked + summarise(run, score));
  return exit_code(run, score);
}

/// A run, or an estimate of a recording that has no run.
int score_any(const ScoreArguments& arguments) {
  const std::string& dir = arguments.dir;
  if (is_estimate_directory(dir)) {
    if (!arguments.estimates.empty() || !arguments.maps.empty() || !arguments.dropped.empty())
      throw InputError({dir, 0, 0}, "is an estimate; --estimate, --map and --drop are of run directories");
    std::vector<GateSpec> gates;
    for (const std::string& text : arguments.gates) gates.push_back(parse_gate(text));
    return score_estimate(dir, arguments.reference, gates, arguments.unchecked);
  }
  if (!arguments.reference.empty())
    throw InputError({"--reference", 0, 0}, "is of a directory of plumbline estimate; '" + dir + "' is none");
  return score_again(arguments);
}

}  // namespace

Command add_score(CommandLine& program) {
  const auto options = std::make_shared<ScoreArguments>();
  CommandLine line = program.add_command(
      "score",
      "Scores a run directory again, with estimates of other programs or of plumbline estimate; or an estimate alone");
  line.option("DIR", options->dir, "run directory, or directory that plumbline estimate wrote").takes("DIR").required();
  line.option(
      "--estimate", options->estimates,
      "NAME=FILE[,frame=W|M][,topic=TOPIC][,shift=S|auto]: poses of the robot (TUM, KITTI or EuRoC, or a topic of a "
      "bag) "
      "in the plan's frame W or its own M [M], S seconds added to their stamps, or as many as make them move with the "
      "robot; or NAME=directory that plumbline estimate wrote, of the run's recording");
  line.option("--map", options->maps,
              "NAME=FILE: the map (.ply, .pcd) of the estimate of this name, in the frame of its poses");
  line.option(
          "--gate", options->gates,
          "METRIC<=X or METRIC>=X, in quotes: asked of the estimates given, in place of the scenario's gates; of an "
          "estimate alone, a value of score.json")
      .takes("GATE");
  line.option("--drop", options->dropped, "removes the outside estimate of this name, which was given before");
  line.option(
      "--reference", options->reference,
      "FILE[,frame=W] or BAG,topic=TOPIC[,frame=W], of an estimate: true poses (TUM, KITTI or EuRoC) of the same "
      "frame of the robot, on the estimate's clock, in any world frame; both are aligned. frame=W: in the "
      "plan's frame; a localization is scored there, too, without alignment");
  line.flag("--unchecked", options->unchecked,
            "takes files that were altered since they were written; results.json names them");
  line.footer(
      "Example: plumbline score runs/quickstart-1 --estimate kiss=kiss.tum --estimate amcl=amcl.tum,frame=W\n"
      "         plumbline score runs/quickstart-1 --estimate mine=walk.mcap,topic=/odom_estimated,shift=auto\n"
      "         plumbline score runs/quickstart-1 --estimate paper=estimates/paper\n"
      "         plumbline score runs/quickstart-1 --estimate mine=mine.tum --map mine=mine.ply --gate "
      "'map_rmse_m<=0.05'\n"
      "         plumbline score estimates/street --reference street.tum --gate 'ate_aligned_rmse_m<=0.5'\n"
      "         plumbline score estimates/office --reference total_station.tum,frame=W --gate "
      "'localization.sure_and_wrong<=0'");
  return {line, [options] { return score_any(*options); }};
}

}  // namespace plumbline::scenarios
