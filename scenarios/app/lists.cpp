// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/run/method_runner.h"
#include "scenarios/spec/library.h"
#include "scenarios/spec/method_names.h"
#include "scenarios/spec/resolve.h"
#include "scenarios/spec/scenario_schema.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

std::string needs_of(const slam::MethodRow& row) {
  const bool odometry = !runs_on_lidar_alone(row);
  if (row.needs_plan) return odometry ? " (needs the plan and odometry)" : " (needs the plan)";
  return odometry ? " (needs odometry)" : "";
}

int list_methods(slam::MethodTable table) {
  std::size_t widest = truth_method.size();
  for (const slam::MethodRow& row : table) widest = std::max(widest, row.name.size());
  const int width = static_cast<int>(widest);
  for (const slam::MethodRow& row : table)
    std::printf("%-*s %s%s\n", width, std::string(row.name).c_str(), std::string(row.summary).c_str(),
                needs_of(row).c_str());
  std::printf("%-*s %s\n", width, std::string(truth_method).c_str(),
              "the true poses; its errors are 0, which checks the scores");
  return 0;
}

int print_config(const std::string& name, bool all, slam::MethodTable table) {
  check_methods({name}, {Mark{"--config", 0, 0}}, table);
  const slam::MethodRow* row = row_of(name, table);
  if (row == nullptr || !row->config_schema)
    throw InputError({"--config", 0, 0}, "method '" + name + "' has no values to set");
  const std::vector<SchemaField> fields = row->config_schema().front().fields;
  const std::vector<SchemaField> shown = all ? fields : basic_fields(fields);
  std::fputs(schema_yaml(shown).c_str(), stdout);
  if (shown.size() < fields.size())
    std::printf("# %zu more: plumbline methods --config %s --all\n", fields.size() - shown.size(), name.c_str());
  return 0;
}

/// Of the library by the names that run takes, of another folder by their paths. Throws InputError of the first that
/// cannot be read, once the others are listed.
int list_scenarios(const std::string& given) {
  const std::string folder = given.empty() ? library_folder() : given;
  if (folder.empty())
    throw EnvironmentError("the scenarios that come with the program are not beside it; name a folder with scenarios");
  if (!fs::is_directory(folder)) throw InputError({folder, 0, 0}, "no such directory; name one with scenarios in it");
  std::optional<InputError> wrong;
  for (const std::string& path : scenario_files(folder)) {
    Scenario scenario;
    try {
      scenario = read_scenario(read_text_file(path), path).scenario;
    } catch (const InputError& error) {
      if (!wrong) wrong = error;
      continue;
    }
    std::string methods;
    for (const std::string& name : scenario.methods) methods += " " + name;
    const std::string shown =
        given.empty() ? fs::path(path).lexically_relative(folder).replace_extension().string() : path;
    std::printf("%-40s %-20s%s\n", printable(shown).c_str(), printable(scenario.name).c_str(),
                printable(methods).c_str());
  }
  if (wrong) throw *wrong;
  return 0;
}

int print_schema() {
  std::fputs(scenario_page().c_str(), stdout);
  return 0;
}

}  // namespace

Command add_methods(CommandLine& program, slam::MethodTable table) {
  struct Options {
    std::string config;
    bool all = false;
  };
  const auto options = std::make_shared<Options>();
  CommandLine line = program.add_command("methods", "Lists the methods, or prints the parameters of one");
  const Argument config =
      line.option(
              "--config", options->config,
              "prints instead the basic parameters of this method at their defaults, as a file for estimate --config")
          .takes("METHOD");
  line.flag("--all", options->all, "every parameter").needs(config);
  line.footer("Example: plumbline methods\n         plumbline methods --config vgicp > vgicp.yaml");
  return {line, [options, table] {
            return options->config.empty() ? list_methods(table) : print_config(options->config, options->all, table);
          }};
}

Command add_scenarios(CommandLine& program) {
  struct Options {
    std::string folder;
    bool schema = false;
  };
  const auto options = std::make_shared<Options>();
  CommandLine line = program.add_command(
      "scenarios", "Lists the scenarios that come with the program, by the names that run takes; or those of a folder");
  line.option("FOLDER", options->folder, "folder with scenarios, and the folders in it [those of the program]")
      .takes("DIR");
  line.flag("--schema", options->schema, "prints instead every key of scenario files, with examples");
  line.footer("Example: plumbline scenarios\n         plumbline scenarios my_scenarios");
  return {line, [options] { return options->schema ? print_schema() : list_scenarios(options->folder); }};
}

}  // namespace plumbline::scenarios
