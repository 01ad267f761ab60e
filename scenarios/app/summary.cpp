// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string_view>

#include "bim/config/printable.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"
#include "scenarios/report/method_cards.h"
#include "scenarios/report/report_builder.h"
#include "scenarios/score/moment.h"
#include "scenarios/score/walk_end.h"
#include "scenarios/spec/injected_faults.h"

namespace plumbline::scenarios {

namespace {

struct Column {
  const char* title;
  std::string_view metric;
  int decimals;
  bool is_time = false;
};
constexpr std::array<Column, 7> columns = {{{"ATE m", "ate_aligned_rmse_m", 3},
                                            {"RPE/m", "rpe_1m_rmse_m", 3},
                                            {"map m", "map_rmse_m", 3},
                                            {"mapped", "map_completeness", 2},
                                            {"rooms", "rooms.recall", 2},
                                            {"APE m", "localization.ape_rmse_m", 3},
                                            {"found s", "localization.converged_at_s", 1, true}}};

/// start_s: of the first scan; a time is shown on the run's clock, as on the pages, and its metric counts from there.
std::string cell(const score::MethodScore& score, const Column& column, double start_s) {
  std::optional<double> value = score::find_metric(column.metric)->value(score);
  if (value && column.is_time) *value += start_s;
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

/// The blocks of results.json that say which methods are bad and which are judged.
Tree judging_blocks(const score::RunScore& score) {
  Tree methods = Tree::map(), gates = Tree::list();
  for (const score::MethodScore& method : score.methods) methods.set(method.name, score::to_results(method));
  for (const score::GateResult& gate : score.gates) gates.push(score::to_results(gate));
  return Tree::map().set("methods", std::move(methods)).set("gates", std::move(gates));
}

/// Says that a method's answer was sure and wrong, where none of its gates fails and none asks for that; else empty.
std::string sure_and_wrong(const score::MethodScore& method, const std::vector<score::GateResult>& gates) {
  constexpr std::string_view metric = "localization.sure_and_wrong";
  if (!method.localization || !score::is_sure_and_wrong(method.localization->verdict)) return "";
  if (std::any_of(gates.begin(), gates.end(), [&](const score::GateResult& gate) {
        return gate.method == method.name && (!gate.passed || gate.metric == metric);
      }))
    return "";
  const score::LocalizationRules rules;
  const double off_m = method.localization->ape_rmse_m.value_or(0.0);
  const double off_deg = method.localization->yaw_rmse_deg.value_or(0.0);
  std::string what = "on one pose, which the scans do not distinguish from others";  // a guess, which may be right
  if (method.localization->verdict == score::LocalizationVerdict::false_convergence || off_m > rules.position_m ||
      off_deg > rules.yaw_deg) {
    char off[48];
    std::snprintf(off, sizeof(off), ", %.3g m and %.3g deg off rms", off_m, off_deg);
    what = std::string("on a wrong pose") + off;
  }
  return method.name + ": CONVERGED " + what + "; no gate asks for it: " + std::string(metric) + "<=0";
}

/// Says how long a method that was not localized again after a kidnapping was CONVERGED on a wrong pose, where none of
/// its gates fails and none asks for that; else empty. Its verdict is of the time before.
std::string wrong_after_kidnap(const score::MethodScore& method, const std::vector<score::GateResult>& gates) {
  constexpr std::string_view metric = "localization.kidnap_wrong_s";
  if (!method.localization || method.localization->kidnap_found_s) return "";
  const double wrong_s = method.localization->kidnap_wrong_s.value_or(0.0);
  if (!(wrong_s > 0.0)) return "";
  if (std::any_of(gates.begin(), gates.end(), [&](const score::GateResult& gate) {
        return gate.method == method.name && (!gate.passed || gate.metric == metric);
      }))
    return "";
  char time[32];
  std::snprintf(time, sizeof(time), "%.1f s", wrong_s);
  return method.name + ": CONVERGED on a wrong pose for up to " + time +
         " after the kidnapping; no gate asks for it: " + std::string(metric) + "<=0";
}

/// What the columns do not show of a method's answers: how often it disclaimed them, and rooms that are none.
std::string beside_columns(const score::MethodScore& method) {
  std::string text;
  const double lost = method.tracking ? method.tracking->lost_share : 0.0;
  if (lost > 0.0) {
    char share[48];
    std::snprintf(share, sizeof(share), "LOST at %.2g %% of the scans", 100.0 * lost);
    text = share;
  }
  const int found = method.rooms ? method.rooms->found : 0, matched = method.rooms ? method.rooms->matched : 0;
  if (found > matched)
    text += (text.empty() ? "" : "; ") + std::to_string(found - matched) + " of the " + std::to_string(found) +
            " rooms that it found match none of the building";
  return text.empty() ? "" : method.name + ": " + text;
}

/// A line for the first failed gate of each method, or for each method that is bad and not judged.
std::string looks(const std::string& page, const score::RunScore& score) {
  std::string text;
  std::set<std::string> named;
  for (const score::GateResult& gate : score.gates)
    if (!gate.passed && !gate.see.empty() && named.insert(gate.method).second)
      text += "look:  " + page + gate.see + "\n";
  for (const Unjudged& method : unjudged(judging_blocks(score)))
    if (named.insert(method.method).second) text += "look:  " + page + "#m=" + score::in_link(method.method) + "\n";
  return text;
}

/// The last scan that the method had which stopped first, s.
std::optional<double> first_crash_s(const FinishedRun& run) {
  std::optional<double> first;
  for (const MethodRecord& method : run.record.methods) {
    if (!method.crashed) continue;
    const double at_s = method.causal.empty() ? 0.0 : slam::seconds(method.causal.back().stamp);
    first = std::min(first.value_or(at_s), at_s);
  }
  return first;
}

}  // namespace

std::string summarise(const FinishedRun& run, const score::RunScore& score) {
  char head[160];
  std::snprintf(head, sizeof(head), "%s, seed %llu: %.1f m in %.1f s, digest %s\n",
                printable(run.scenario.name).c_str(), static_cast<unsigned long long>(run.scenario.seed),
                score.distance_m, score.duration_s, score.digest.c_str());
  std::string text = head;
  text += "planned walk: " + printable(walk_sentence(run.walk)) + "\n";
  for (const std::string& fault : injected_faults(run.scenario)) text += "injected: " + printable(fault) + "\n";
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
  const double start_s = run.scans.empty() ? 0.0 : slam::seconds(run.scans.front());
  for (const score::MethodScore& method : score.methods) {
    text += row(method.name, width, method.verdict);
    for (const Column& column : columns) text += cell(method, column, start_s);
    text += method.error.empty() ? "\n" : "  " + printable(method.error) + "\n";
  }
  for (const score::MethodScore& method : score.methods)
    if (const std::string beside = beside_columns(method); !beside.empty()) text += "note: " + printable(beside) + "\n";
  for (const Unjudged& method : unjudged(judging_blocks(score)))
    text += (method.crashed() ? "FAILED: " : "not judged: ") + printable(method.method + ": " + method.what) + "\n";
  for (const score::MethodScore& method : score.methods)
    if (const std::string said = sure_and_wrong(method, score.gates); !said.empty())
      text += "warning: " + printable(said) + "\n";
  for (const score::MethodScore& method : score.methods)
    if (const std::string said = wrong_after_kidnap(method, score.gates); !said.empty())
      text += "warning: " + printable(said) + "\n";
  for (const score::GateResult& gate : score.gates)
    text += (gate.passed ? "passed: " : "FAILED: ") + score::describe(gate) + "\n";
  if (score.gates.empty()) return text + "no gates\n";
  const auto passed = std::count_if(score.gates.begin(), score.gates.end(), [](const auto& g) { return g.passed; });
  return text + "gates: " + std::to_string(passed) + " of " + std::to_string(score.gates.size()) + " passed\n";
}

std::string next_steps(const std::string& dir, bool has_replay, const FinishedRun& run, const score::RunScore& score) {
  const std::string page = printable(dir) + "/replay.html", shown = looks(page, score);
  const std::string folder = printable(shell_argument(dir)),
                    make_page = "look:  plumbline report --3d " + folder + "\n";
  if (exit_code(run, score) == 0) {
    if (has_replay) return shown.empty() ? "look:  " + page + "\n" : shown;
    return shown.empty() ? "" : make_page;
  }
  const auto failed =
      std::find_if(score.gates.begin(), score.gates.end(), [](const score::GateResult& gate) { return !gate.passed; });
  double at_s = score.duration_s;
  const bool by_method = run.record.failure.empty(), by_gate = by_method && failed != score.gates.end();
  if (by_gate) at_s = score::telling_moment(run, score, *failed).value_or(at_s);
  if (by_method && !by_gate) at_s = first_crash_s(run).value_or(at_s);
  const std::string until = format_number(score::rounded_up(at_s, 10.0));
  const bool has_link = by_gate ? !failed->see.empty() : by_method && !shown.empty();
  return (!has_replay ? make_page
          : has_link  ? shown
                      : "look:  " + page + "#t=" + until + "\n" + (by_method ? shown : "")) +
         "again: plumbline replay " + folder + (at_s > 0.0 ? " --until " + until : "") + "\n";
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
