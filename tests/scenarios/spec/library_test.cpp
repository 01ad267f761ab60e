// SPDX-License-Identifier: Apache-2.0
// What ships with the program: every plan is sound and closed, every scenario resolves.
#include "scenarios/spec/library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "scenarios/spec/resolve.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

std::string library() { return project_file("scenarios/library"); }

std::vector<std::string> files_of_kind(const std::string& kind) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(library())) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".yaml") continue;
    if (read_yaml(read_text_file(path), path).as_map().front().first == kind) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Library, PlansAreSoundAndTheirMeshesClosed) {
  const std::vector<std::string> plans = files_of_kind("plan");
  EXPECT_GE(plans.size(), 13U);
  for (const std::string& path : plans) {
    const bim::PlannedAndBuilt site = bim::load_planned_and_built(path);
    for (const bim::Building* building : {&site.as_planned, &site.as_built}) {
      const bim::BuildingMesh mesh = bim::build_mesh(*building);
      EXPECT_TRUE(mesh.warnings.empty()) << path;
      for (const bim::MeshElement& element : mesh.elements) EXPECT_TRUE(element.closed) << path << " " << element.id;
    }
  }
}

TEST(Library, ScenariosResolve) {
  const std::vector<std::string> scenarios = files_of_kind("scenario");
  EXPECT_GE(scenarios.size(), 19U);
  for (const std::string& path : scenarios) {
    Overrides overrides;  // the seed says where some start
    overrides.seed = 3;
    const ResolvedScenario resolved = resolve(path, overrides);
    EXPECT_GE(resolved.world.waypoints.size(), 2U) << path;
  }
}

TEST(Library, ANameOfNoScenarioIsRefusedWithWhereTheNamesAre) {
  EXPECT_NE(input_error([] { static_cast<void>(find_input("quickstrt")); }).find("did you mean 'quickstart'?"),
            std::string::npos);
  EXPECT_EQ(input_error([] { static_cast<void>(find_input("nosuch")); }),
            "nosuch: is not a file and not a library scenario; `plumbline scenarios` lists the latter");
  EXPECT_EQ(find_input("nosuch.yaml"), "nosuch.yaml");
}

TEST(Library, ABrokenLinkIsNoScenario) {
  namespace fs = std::filesystem;
  const Folder folder;
  fs::create_directory(folder / "inner");
  fs::copy_file(library() + "/quickstart.yaml", folder / "inner/one.yaml");
  fs::create_symlink("loop.yaml", folder / "loop.yaml");
  fs::create_symlink("nowhere.yaml", folder / "dangling.yaml");
  fs::create_directory_symlink(folder.path(), folder / "inner/again");
  fs::create_directory(folder / "folder.yaml");
  EXPECT_EQ(scenario_files(folder.path()), std::vector<std::string>{folder / "inner/one.yaml"});
  EXPECT_TRUE(scenario_files(folder / "none").empty());
}

TEST(Library, TheHouseOfTheFirstSiteIsWhatOurWriterMakesOfItsPlan) {
  const std::string house = library() + "/s_graphs/c1";
  EXPECT_TRUE(read_text_file(house + ".ifc") == bim::write_ifc(bim::load_building(house + ".plan.yaml")))
      << "write it again: plumbline inspect c1.plan.yaml --ifc c1.ifc";
}

TEST(Library, MethodsOfTheSiteAreGivenThePlanAndTheWorldWhatWasBuilt) {
  const ResolvedScenario resolved = resolve(library() + "/construction_site.yaml", {});
  const auto wall = [](const bim::Building& building, const std::string& id) {
    return std::any_of(building.walls.begin(), building.walls.end(), [&](const bim::Wall& w) { return w.id == id; });
  };
  EXPECT_TRUE(wall(resolved.building->as_planned(), "office_archive"));
  EXPECT_FALSE(wall(resolved.building->as_built(), "office_archive"));
  EXPECT_FALSE(wall(resolved.building->as_planned(), "site_office"));
  EXPECT_TRUE(wall(resolved.building->as_built(), "site_office"));
}

/// A method in the plan that is sure and wrong must not pass for want of a bound.
TEST(Library, EveryLocalizationHasAGate) {
  for (const std::string& path : files_of_kind("scenario")) {
    const Scenario scenario = read_scenario(read_text_file(path), path).scenario;
    for (const std::string& method : scenario.methods) {
      const slam::MethodRow* row = slam::find_method(method, slam::methods());
      if (row == nullptr || !row->needs_plan) continue;
      const auto bounds = [&](const GateSpec& gate) {
        return gate.method == method && gate.metric == "localization.sure_and_wrong" && gate.max == 0.0;
      };
      EXPECT_TRUE(std::any_of(scenario.gates.begin(), scenario.gates.end(), bounds)) << path << " " << method;
    }
  }
}

TEST(Library, AClosedDoorOnTheOnlyWayIsNamed) {
  const Folder folder;
  std::filesystem::copy_file(library() + "/house.plan.yaml", folder / "house.plan.yaml");
  const auto error_of = [&](const std::string& route) {
    const std::string path = folder / "shut.yaml";
    FILE* file = std::fopen(path.c_str(), "w");
    std::fputs(("scenario: 1\nbuilding: house.plan.yaml\ndoors: closed\nstart: {room: living}\n" + route).c_str(),
               file);
    std::fclose(file);
    return input_error([&] { (void)resolve(path, {}); });
  };
  const std::string named = error_of("route: {rooms: [kitchen]}\n");
  EXPECT_NE(named.find("shut.yaml:5:"), std::string::npos) << named;
  EXPECT_NE(named.find("doors 'door_hall', 'door_kitchen' on the way are closed"), std::string::npos) << named;
  const std::string all = error_of("route: {rooms: all}\n");
  EXPECT_NE(all.find("'door_hall'"), std::string::npos) << all;
  const std::string shuttle = error_of("route: {shuttle: bath}\n");
  EXPECT_NE(shuttle.find("'door_bath'"), std::string::npos) << shuttle;
}

}  // namespace
}  // namespace plumbline::scenarios
