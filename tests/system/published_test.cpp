// SPDX-License-Identifier: Apache-2.0
// A fixed sample of the table that ci/full makes of the S-Graphs+ papers' kinds of scenario: what is published of real
// sensors stands here too, so that neither is the world too easy nor a baseline spoiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

/// results.json of a scenario after the gates in its own file have passed.
nlohmann::json run_file(const std::string& file, const std::string& methods) {
  const Folder folder;
  const std::string dir = folder / "run";
  const Outcome outcome = plumbline({"run", file, "--method", "truth," + methods, "--out", dir, "--threads", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  return nlohmann::json::parse(read_file(dir + "/results.json"))["methods"];
}

const std::string library = "scenarios/library/s_graphs/";

double ate(const nlohmann::json& methods, const char* name) { return methods[name]["ate_aligned_rmse_m"]; }

/// The largest aligned ATE of a scenario and method over the seeds of ci/results/slam.tsv, m.
double worst_committed_ate(const std::string& scenario, const std::string& method) {
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, '\t');) cells.push_back(cell);
    return cells;
  };
  std::istringstream table(read_file(project_file("ci/results/slam.tsv")));
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> columns = cells_of(line);
  const auto column = [&](const char* name) {
    const auto at = std::find(columns.begin(), columns.end(), name);
    EXPECT_NE(at, columns.end()) << name;
    return static_cast<std::size_t>(at - columns.begin());
  };
  const std::size_t of_scenario = column("scenario"), of_method = column("method"), of_sensors = column("sensors"),
                    of_ate = column("ate_aligned_rmse_m");
  double worst = 0.0;
  int rows = 0;
  while (std::getline(table, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.at(of_scenario) != scenario || cells.at(of_method) != method || cells.at(of_sensors) != "all") continue;
    worst = std::max(worst, std::stod(cells.at(of_ate)));
    ++rows;
  }
  EXPECT_GE(rows, 3) << scenario << " " << method;
  return worst;
}

TEST(Published, RoomsAlongACorridorWithALoop) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const nlohmann::json methods = run_file(project_file(library + "se2.yaml"), "vgicp,keyframe_graph,s_graphs_plus");
  EXPECT_LE(ate(methods, "keyframe_graph"), ate(methods, "vgicp"));
  EXPECT_LE(ate(methods, "s_graphs_plus"), 0.68 * ate(methods, "keyframe_graph"));  // the paper's mean of five
  const auto& rooms = methods["s_graphs_plus"]["rooms"];
  EXPECT_GE(rooms["precision"], 0.97);
  EXPECT_GE(methods["s_graphs_plus"]["map_completeness"], 0.9);
  EXPECT_LE(methods["s_graphs_plus"]["map_rmse_m"], 0.03);
}

TEST(Published, ASmallRoomAtSpeed) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;  // t8 for two rounds of its six
  std::string text = read_file(project_file(library + "t8.yaml"));
  const auto replace = [&text](const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), with);
  };
  replace("times: 6", "times: 2");
  replace("small_room.plan.yaml", project_file(library + "small_room.plan.yaml"));
  write_file(folder / "t8.yaml", text);
  const nlohmann::json methods = run_file(folder / "t8.yaml", "vgicp,s_graphs_plus");
  // Two rounds drift less than six; half as much again as the worst committed seed of six is allowed.
  for (const char* name : {"vgicp", "s_graphs_plus"}) {
    EXPECT_EQ(methods[name]["verdict"], "complete") << name;
    EXPECT_LE(ate(methods, name), std::min(0.04, 1.5 * worst_committed_ate("t8", name))) << name;
  }
}

}  // namespace
}  // namespace plumbline::system_tests
