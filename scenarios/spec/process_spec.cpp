// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/process_spec.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "bim/errors.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/spec/method_names.h"
#include "slam/process/process_method.h"
#include "slam/process/search_path.h"

namespace plumbline::scenarios {

namespace {

/// Splits a command as a shell does where there is nothing but spaces and quotes.
std::vector<std::string> words_of(const std::string& text, const Mark& mark) {
  std::vector<std::string> words;
  std::string word;
  bool in_word = false;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0 && c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
      in_word = true;
    } else if (quote == 0 && c == ' ') {
      if (in_word) words.push_back(std::exchange(word, {}));
      in_word = false;
    } else {
      word += c;
      in_word = true;
    }
  }
  if (quote != 0) throw InputError(mark, "'" + text + "' has a quote that is not closed");
  if (in_word) words.push_back(word);
  return words;
}

void check(const ProcessSpec& process, slam::MethodTable table, const Mark& mark) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  constexpr std::size_t longest = 60;
  if (process.name.empty() || process.name.size() > longest ||
      !std::all_of(process.name.begin(), process.name.end(), allowed))
    throw InputError(mark, "a method's name must be 1 to 60 letters, digits, - and _, not '" + process.name + "'");
  if (process.name == "sim")
    throw InputError(mark, "'sim' is what digests call the simulator; give the process another name");
  if (process.name == truth_method || slam::find_method(process.name, table) != nullptr)
    throw InputError(mark, "method '" + process.name + "' is in the table already; give the process another name");
  if (process.command.empty() || process.command.front().empty())
    throw InputError(mark, "the process '" + process.name + "' needs a command: a program and its arguments");
}

slam::MethodRow row_for(const ProcessSpec& process) {
  slam::ProcessCommand command{process.name,   process.command, process.folder.value_or(""),
                               process.plan,   process.repeat,  process.start_s,
                               process.scan_s, process.finish_s};
  command.go_on = check_interrupt;
  slam::MethodRow row;
  row.name = process.name;
  row.summary = "a process of the user's";
  row.needs_plan = process.plan;
  row.make = [command = std::move(command)](const slam::MethodInput& input) {
    return slam::make_process_method(command, input);
  };
  row.standard = false;
  return row;
}

}  // namespace

std::optional<ProcessSpec> process_of(const std::string& text, const std::string& folder, const std::string& where) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return std::nullopt;
  ProcessSpec process;
  process.name = text.substr(0, equals);
  process.command = words_of(text.substr(equals + 1), {where, 0, 0});
  if (process.command.empty() || process.command.front().empty())
    throw InputError({where, 0, 0}, "names no program; say what starts your method, as in python3 my_slam.py");
  process.folder = folder;
  return process;
}

void check_program(const std::vector<std::string>& command, const std::string& folder, const Mark& mark) {
  const std::string& name = command.front();
  const auto runs = [](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    if (runs(path)) return;
    const std::string why = std::filesystem::is_directory(path) ? "it is a folder" : "it may not be executed";
    throw InputError(mark, std::filesystem::exists(path) ? "'" + name + "' is no program: " + why
                                                         : "there is no program '" + name + "'");
  }
  for (const std::string& one : slam::search_path(folder))
    if (runs(std::filesystem::path(one) / name)) return;
  throw InputError(mark, "there is no program '" + name + "' in PATH; of one in this folder say ./" + name);
}

ProcessTable::ProcessTable(slam::MethodTable table, std::vector<ProcessSpec> processes, const std::vector<Mark>& marks)
    : processes_(std::move(processes)), rows_(table.begin(), table.end()) {
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    check(processes_[i], rows_, marks[i]);
    rows_.push_back(row_for(processes_[i]));
  }
}

}  // namespace plumbline::scenarios
