// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/file_ending.h"
#include "bim/errors.h"
#include "bim/formats/mesh/mesh_file.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/localizability/planned_walk.h"
#include "scenarios/report/localizability_page.h"
#include "scenarios/spec/run_site.h"

namespace plumbline::scenarios {

namespace {

struct IdentifyOptions {
  std::string building;
  std::string storey;
  std::string out;
  BuildingMapOptions map;
  int threads = 0;
  int seeds = 20;
  bool json = false;
  bool force = false;
  double budget_s = 120.0;
  std::optional<Argument> step_option, budget_option;
  std::vector<Argument> of_buildings;
  std::vector<Argument> of_scenarios;
};

/// The page to write: FILE.html, or identify.html in a directory, which is made. Empty: none.
std::string page_path(const IdentifyOptions& options) {
  namespace fs = std::filesystem;
  if (options.out.empty()) return "";
  const bool page = fs::path(options.out).extension() == ".html";
  if (!page && fs::path(options.out).has_extension() && !fs::is_directory(options.out))
    throw InputError({options.out, 0, 0}, "must be a page (.html) or a directory");
  const std::string path = page ? options.out : options.out + "/identify.html";
  if (fs::exists(path) && !options.force) throw InputError({path, 0, 0}, "exists already; --force replaces it");
  return path;
}

bool is_scenario(const std::string& path) {
  if (!has_ending(path, ".yaml")) return false;
  return read_yaml(read_text_file(path), path).find("scenario") != nullptr;
}

void refuse_given(const std::vector<Argument>& others, const std::string& why) {
  for (const Argument& option : others)
    if (option.given()) throw InputError({option.name(), 0, 0}, why);
}

int identify_scenario(const IdentifyOptions& options, int threads) {
  const std::vector<SeedAnswers> walks = localizability_of_walks(options.building, options.seeds, threads);
  const std::string text = options.json ? write_json(walks_json(walks)) + "\n" : walks_text(walks);
  print(text);
  return 0;
}

int identify(const IdentifyOptions& options) {
  const int threads = options.threads > 0 ? options.threads : std::min(allowed_cpus(), 2);
  if (bim::is_mesh_path(options.building))
    throw InputError({options.building, 0, 0}, "is a mesh, which has no plan; name a plan or an .ifc");
  exit_on_interrupts();
  if (is_scenario(options.building)) {
    refuse_given(options.of_buildings,
                 "is for a building; with a scenario only --seeds, --json and --threads are allowed");
    return identify_scenario(options, threads);
  }
  refuse_given(options.of_scenarios, "is of a scenario's walks; this is a building");
  const std::string page = page_path(options);
  const RunBuilding building(load_site(options.building, Scenario()));  // as `run` has it
  BuildingMapOptions map_options = options.map;
  map_options.file = options.building;
  if (!options.storey.empty()) map_options.storey = options.storey;
  if (!options.step_option->given() || options.budget_option->given()) map_options.budget_s = options.budget_s;
  map_options.phase = [](const std::string& text) { print_note("identify: " + text); };
  map_options.threads = threads;
  std::optional<Progress> progress;
  map_options.progress = [&](std::size_t done, std::size_t all) {
    if (done == 0) progress.emplace("identify", ProgressOf{static_cast<double>(all), "places"});  // for each answer
    progress->at(static_cast<double>(done));
  };
  const BuildingMaps maps = maps_of(building, map_options);
  progress.reset();
  catch_interrupts();  // a page is written whole or not at all
  if (!page.empty()) {
    const std::filesystem::path folder = std::filesystem::path(page).parent_path();
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    write_file(page, localizability_page(building, std::filesystem::path(options.building).filename().string(), maps));
  }
  const std::string text =
      options.json ? write_json(localizability_json(building, maps)) + "\n" : localizability_text(building, maps);
  print(text);
  return 0;
}

}  // namespace

Command add_identify(CommandLine& program) {
  const auto options = std::make_shared<IdentifyOptions>();
  CommandLine line = program.add_command(
      "identify", "Maps where a single scan, or a walk, determines the pose in a building (assumes a VLP-16)");
  line.option("BUILDING", options->building,
              "plan or traffic-editor plan (.yaml) or .ifc; or a scenario, to analyse its planned walks")
      .required();
  options->step_option =
      line.option("--step", options->map.step_m, "spacing of the map's grid, m [0.5, or what --budget allows]")
          .range(0.1, 5.0);
  options->budget_option =
      line.option(
              "--budget", options->budget_s,
              "time budget on two cores, s; the finest grid whose estimated work fits is used, at least --step; the "
              "same on every machine")
          .range(1.0, 1e6)
          .shows_default();
  options->of_buildings = {
      line.option("--storey", options->storey, "only this storey, by its id or name"),
      *options->step_option,
      *options->budget_option,
      line.flag("--across", options->map.across, "storey unknown: aliased poses on other storeys count"),
      line.flag("--compass", options->map.compass_only, "only with a known initial heading (faster)"),
      line.option("-o,--out", options->out, "page to write (.html), or a directory for identify.html"),
      line.flag("--force", options->force, "replaces the page that is there")};
  line.flag("--json", options->json, "as JSON, every grid point");
  line.option("--threads", options->threads, "threads [2, or the CPUs allowed]").range(1, 1024);
  options->of_scenarios = {line.option("--seeds", options->seeds, "for a scenario: number of seeds, starting at 1")
                               .range(1, 100000)
                               .shows_default()};
  line.footer(
      "Answers by the building alone, and with the furniture as planned where there is any.\n"
      "Example: plumbline identify house.plan.yaml -o house.html\n"
      "         plumbline identify scenario.yaml --seeds 100");
  return {line, [options] { return identify(*options); }};
}

}  // namespace plumbline::scenarios
