// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/trial.h"

#include <algorithm>
#include <filesystem>

#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/sweep/children.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

constexpr int bad_input = 2, first_signal = 128;

std::string folder_of(const std::string& folder, std::size_t i) { return folder + "/trial" + std::to_string(i); }

/// What a child says, without the folder that it was tried in.
std::string said(const ChildEnd& end, const std::string& folder) {
  std::string text = without_place(end.last_line, folder);
  for (std::size_t at = text.find(folder + "/"); at != std::string::npos; at = text.find(folder + "/"))
    text.erase(at, folder.size() + 1);
  return text;
}

/// A full disk ends a search; what a building or a method of a trial brings to an error does not.
Trial trial_of(const ChildEnd& end, const std::string& folder) {
  if (is_of_environment(end)) throw EnvironmentError("a run could not be made: " + end.last_line);
  Trial trial;
  const std::string file = folder + "/scenario/results.json";
  if (fs::exists(file)) trial.results = read_json(read_text_file(file), file);
  trial.signal = std::max(0, end.code - first_signal);
  trial.refused = end.code == bad_input;
  if (trial.signal != 0) trial.why = "the program died of signal " + std::to_string(trial.signal);
  if (end.code != 0 && trial.signal == 0) trial.why = said(end, folder);
  return trial;
}

}  // namespace

std::vector<Trial> try_cases(const std::vector<RunCase>& cases, const std::string& folder, int jobs,
                             const std::function<void()>& ended) {
  std::vector<Trial> trials(cases.size());
  run_children(
      cases.size(), jobs,
      [&](std::size_t i) -> std::vector<std::string> {
        const std::string own = folder_of(folder, i);
        fs::create_directories(own);
        write_case(own, cases[i]);
        return {"sweep", "--seed", std::to_string(seed_of(cases[i])), "--runs", own + "/scenario.yaml"};
      },
      [&](std::size_t i, const ChildEnd& end) {
        const std::string own = folder_of(folder, i);
        trials[i] = trial_of(end, own);
        std::error_code error;
        fs::remove_all(own, error);
        if (ended) ended();
      });
  return trials;
}

TryCases in_processes(const std::string& folder, int jobs) {
  return [folder, jobs](const std::vector<RunCase>& cases, const std::function<void()>& ended) {
    return try_cases(cases, folder, jobs, ended);
  };
}

void run_program_once(const std::vector<std::string>& arguments, const std::vector<int>& allowed) {
  run_children(
      1, 1, [&](std::size_t) { return arguments; },
      [&](std::size_t, const ChildEnd& end) {
        if (std::find(allowed.begin(), allowed.end(), end.code) == allowed.end())
          throw EnvironmentError("plumbline " + arguments.front() + " ended with " + std::to_string(end.code) + ": " +
                                 end.last_line);
      });
}

}  // namespace plumbline::scenarios
