// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "scenarios/host/terminal.h"
#include "scenarios/sweep/table.h"

namespace plumbline::scenarios {

namespace {

/// Every key that is drawn, in the order of the file.
std::vector<std::string> drawn_keys(const Hunt& hunt) {
  std::vector<std::string> keys;
  const auto add = [&](const std::string& key) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  };
  for (const HuntBase& base : hunt.bases)
    if (base.family)
      for (const HuntRange& range : base.family->options) add(base.name + " " + range.key);
  for (const HuntRange& range : hunt.file.vary) add(range.key);
  return keys;
}

std::string in_four_digits(double value) {
  constexpr double steps = 1e4;
  return format_number(std::round(value * steps) / steps);
}

std::string kind_text(const FailureSignature& failure) {
  std::string text = failure.method + ": " + failure.verdict;
  if (failure.gate)
    text += ", " + failure.gate->metric + " " + failure.gate->op + " " + format_number(failure.gate->limit);
  if (!failure.cause.empty()) text += " (" + failure.cause + ")";
  return text + (failure.error.empty() ? "" : " (" + failure.error + ")");
}

std::string joined_keys(const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : " ") + key;
  return text;
}

/// What a method did: from its verdict on.
std::vector<std::string> outcome_words(const MethodOutcome& outcome) {
  const bool failed = outcome.failure.has_value();
  return {outcome.method,
          outcome.verdict,
          failed && outcome.failure->gate ? outcome.failure->gate->metric : "",
          failed ? outcome.failure->cause + outcome.failure->error : "",
          outcome.evidence,
          outcome.error_m ? in_four_digits(*outcome.error_m) : "",
          !failed                   ? ""
          : outcome.blame.of_method ? "yes"
                                    : "no",
          outcome.blame.why,
          in_four_digits(outcome.badness)};
}

int failed_walks(const HuntResult& result) {
  return static_cast<int>(
      std::count_if(result.runs.begin(), result.runs.end(), [](const HuntRun& run) { return run.outcomes.empty(); }));
}

/// A base of which no walk began is as good as not named.
std::string bases_without_run(const Hunt& hunt, const HuntResult& result) {
  std::string text;
  for (std::size_t base = 0; base < hunt.bases.size(); ++base) {
    const auto drawn = [&](const HuntRun& run) { return run.base == base; };
    const auto begun = [&](const HuntRun& run) { return run.base == base && run.begun; };
    const auto first = std::find_if(result.runs.begin(), result.runs.end(), drawn);
    if (first == result.runs.end() || std::any_of(result.runs.begin(), result.runs.end(), begun)) continue;
    text += "no draw of " + hunt.bases[base].name + " made a run; the first: " + first->why + "\n";
  }
  return text;
}

}  // namespace

std::string folder_of_finding(std::size_t i) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "failures/%02zu", i + 1);
  return text.data();
}

std::string hunt_csv(const Hunt& hunt, const HuntResult& result) {
  const std::vector<std::string> keys = drawn_keys(hunt);
  std::vector<std::string> head = {"run", "near", "base", "seed"};
  head.insert(head.end(), keys.begin(), keys.end());
  for (const char* name : {"method", "verdict", "gate", "cause", "evidence", "error_m", "fault", "why", "badness"})
    head.emplace_back(name);
  std::string text = csv_line(head);
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const HuntRun& run = result.runs[i];
    std::vector<std::string> begin = {std::to_string(i + 1), run.near ? std::to_string(*run.near + 1) : "",
                                      hunt.bases[run.base].name, std::to_string(run.seed)};
    for (const std::string& key : keys) {
      const auto value =
          std::find_if(run.values.begin(), run.values.end(), [&](const auto& v) { return v.first == key; });
      begin.push_back(value == run.values.end() ? "" : value->second);
    }
    std::vector<MethodOutcome> outcomes = run.outcomes;
    if (outcomes.empty()) outcomes.push_back({"", "failed", "", {}, {}, {false, run.why}, 0.0});
    for (const MethodOutcome& outcome : outcomes) {
      std::vector<std::string> line = begin;
      for (std::string& word : outcome_words(outcome)) line.push_back(std::move(word));
      text += csv_line(line);
    }
  }
  return text;
}

Tree hunt_results(const Hunt& hunt, const HuntResult& result) {
  Tree tree = Tree::map();
  tree.set("plumbline", PLUMBLINE_VERSION).set("name", hunt.file.name);
  tree.set("runs", static_cast<std::int64_t>(result.runs.size())).set("failed_walks", failed_walks(result));
  tree.set("interrupted", result.signal != 0);
  Tree findings = Tree::list();
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const HuntFinding& finding = result.findings[i];
    Tree entry = Tree::map(), runs = Tree::list(), ingredients = Tree::list();
    for (const std::size_t run : finding.runs) runs.push(static_cast<std::int64_t>(run + 1));
    for (const std::string& key : finding.ingredients) ingredients.push(key);
    entry.set("folder", folder_of_finding(i)).set("failure", to_results(finding.failure));
    entry.set("ingredients", std::move(ingredients)).set("badness", finding.badness);
    entry.set("worst_run", static_cast<std::int64_t>(finding.worst + 1)).set("runs", std::move(runs));
    findings.push(std::move(entry));
  }
  Tree excused = Tree::list();
  for (const auto& [why, count] : result.excused) excused.push(Tree::map().set("why", why).set("failures", count));
  return tree.set("findings", std::move(findings)).set("not_the_methods_fault", std::move(excused));
}

std::string hunt_text(const Hunt& hunt, const HuntResult& result, const std::string& out) {
  std::string text;
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const HuntFinding& finding = result.findings[i];
    const std::string folder = out + "/" + folder_of_finding(i), run = folder + "/run";
    text += std::to_string(i + 1) + "  " + kind_text(finding.failure) + "; in " + std::to_string(finding.runs.size()) +
            (finding.runs.size() == 1 ? " run" : " runs") + "; with " + joined_keys(finding.ingredients) + "\n";
    text += "   plumbline run " + shell_argument(folder + "/scenario.yaml") + " -o " + shell_argument(run) + "\n";
    text += "   plumbline shrink " + shell_argument(run) + " --method " + shell_argument(finding.failure.method) +
            (finding.failure.gate ? " --gate " + finding.failure.gate->metric : "") + " -o " +
            shell_argument(folder + "/small") + "\n";
  }
  int excused = 0;
  for (const auto& [why, count] : result.excused) excused += count;
  if (excused > 0) text += "not the method's fault: " + std::to_string(excused) + " failures\n";
  for (const auto& [why, count] : result.excused) text += "  " + std::to_string(count) + "  " + why + "\n";
  text += bases_without_run(hunt, result);
  const int walks = failed_walks(result);
  if (walks > 0) text += std::to_string(walks) + " runs could not be made or walked to the end; hunt.csv says why\n";
  return text + std::to_string(result.runs.size()) + " runs, " + std::to_string(result.findings.size()) +
         " kinds of failure that are the method's fault\n";
}

}  // namespace plumbline::scenarios
