// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "bim/config/printable.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"
#include "scenarios/report/report_builder.h"
#include "scenarios/score/moment.h"
#include "scenarios/score/walk_end.h"

namespace plumbline::scenarios {

namespace {

struct Column {
  const char* title;
  std::string_view metric;
  int decimals;
};
constexpr std::array<Column, 7> columns = {{{"ATE m", "ate_aligned_rmse_m", 3},
                                            {"RPE/m", "rpe_1m_rmse_m", 3},
                                            {"map m", "map_rmse_m", 3},
                                            {"mapped", "map_completeness", 2},
                                            {"rooms", "rooms.recall", 2},
                                            {"APE m", "localization.ape_rmse_m", 3},
                                            {"found s", "localization.converged_at_s", 1}}};

std::string cell(const score::MethodScore& score, const Column& column) {
  const std::optional<double> value = score::find_metric(column.metric)->value(score);
  char text[32];
  if (value)
    std::snprintf(text, sizeof(text), "%9.*f", column.decimals, *value);
  else
    std::snprintf(text, sizeof(text), "%9s", "-");
  return text;
}

std::string row(const std::string& name, std::size_t width, const std::string& verdict) {
  char text[32];
  std::snprintf(text, sizeof(text), " %-18s", verdict.c_str());
  return name + std::string(width - std::min(width, name.size()), ' ') + text;
}

}  // namespace

std::string summarise(const FinishedRun& run, const score::RunScore& score) {
  char head[160];
  std::snprintf(head, sizeof(head), "%s, seed %llu: %.1f m in %.1f s, digest %s\n",
                printable(run.scenario.name).c_str(), static_cast<unsigned long long>(run.scenario.seed),
                score.distance_m, score.duration_s, score.digest.c_str());
  std::string text = head;
  text += "planned walk: " + printable(walk_sentence(run.walk)) + "\n";
  for (const std::string& warning : score::warnings_of_walk(run)) text += "warning: " + printable(warning) + "\n";
  if (!run.record.failure.empty()) text += "the scenario failed: " + printable(run.record.failure) + "\n";
  std::size_t width = 22;
  for (const score::MethodScore& method : score.methods) width = std::max(width, method.name.size());
  text += row("method", width, "verdict");
  for (const Column& column : columns) {
    char title[16];
    std::snprintf(title, sizeof(title), "%9s", column.title);
    text += title;
  }
  text += "\n";
  for (const score::MethodScore& method : score.methods) {
    text += row(method.name, width, method.verdict);
    for (const Column& column : columns) text += cell(method, column);
    text += method.error.empty() ? "\n" : "  " + printable(method.error) + "\n";
  }
  for (const score::GateResult& gate : score.gates)
    text += (gate.passed ? "passed: " : "FAILED: ") + score::describe(gate) + "\n";
  if (score.gates.empty()) return text + "no gates\n";
  const auto passed = std::count_if(score.gates.begin(), score.gates.end(), [](const auto& g) { return g.passed; });
  return text + "gates: " + std::to_string(passed) + " of " + std::to_string(score.gates.size()) + " passed\n";
}

std::string next_steps(const std::string& dir, const FinishedRun& run, const score::RunScore& score) {
  if (exit_code(run, score) == 0) return "";
  const auto failed =
      std::find_if(score.gates.begin(), score.gates.end(), [](const score::GateResult& gate) { return !gate.passed; });
  double at_s = score.duration_s;
  std::string link;
  if (run.record.failure.empty() && failed != score.gates.end()) {
    at_s = score::telling_moment(run, score, *failed).value_or(at_s);
    link = failed->see;
  }
  if (link.empty()) link = "#t=" + format_number(score::rounded_up(at_s, 10.0));
  return "look:  " + printable(dir) + "/replay.html" + link + "\n" + "again: plumbline replay " +
         printable(shell_argument(dir)) + " --until " + format_number(score::rounded_up(at_s, 10.0)) + "\n";
}

std::map<std::string, Tree> read_graphs(const std::string& dir, const FinishedRun& run) {
  std::map<std::string, Tree> graphs;
  for (const MethodRecord& method : run.record.methods) {
    const std::string path = dir + "/" + method.name + ".graph.json";
    if (std::filesystem::exists(path)) graphs.emplace(method.name, read_json(read_text_file(path), path));
  }
  return graphs;
}

int exit_code(const FinishedRun& run, const score::RunScore& score) {
  if (!run.record.failure.empty()) return 4;
  return score.passed() ? 0 : 1;
}

score::RunScore score_and_report(const std::string& dir, const FinishedRun& run,
                                 const std::function<bool(const score::RunScore&)>& has_replay) {
  score::RunScore score = score::score_run(run);
  ReportInput input = report_input(run, score);
  input.has_replay = has_replay(score);
  write_file(dir + "/report.html", render_report(input));
  score::write_scores(dir, run, score);
  return score;
}

}  // namespace plumbline::scenarios
