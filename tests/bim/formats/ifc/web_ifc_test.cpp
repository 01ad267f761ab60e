// SPDX-License-Identifier: Apache-2.0
// Written files in an independent reader, web-ifc; skipped without node and without
//   npm ci --prefix tests/golden/web_ifc
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "tests/data.h"
#include "tests/test_name.h"

namespace plumbline::bim {
namespace {

struct Measured {
  std::map<std::string, int> counts;
  std::map<std::string, double> wall_volumes_m3;  ///< by GlobalId
};

/// What the script prints, nothing where it could not run.
std::optional<Measured> measured(const std::filesystem::path& file) {
  const std::filesystem::path folder = project_file("tests/golden/web_ifc");
  if (!std::filesystem::exists(folder / "node_modules" / "web-ifc")) return std::nullopt;
  const std::string command = "node '" + (folder / "measure.mjs").string() + "' '" + file.string() + "' 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get()) != nullptr) output += buffer.data();
  if (output.find("not found") != std::string::npos && output.find("count") == std::string::npos) return std::nullopt;
  Measured result;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what, name;
    words >> what >> name;
    if (what == "count") words >> result.counts[name];
    if (what == "wall") words >> result.wall_volumes_m3[name];
  }
  EXPECT_FALSE(result.counts.empty()) << output;
  return result;
}

int openings_of(const Building& building, OpeningKind kind) {
  return static_cast<int>(std::count_if(building.openings.begin(), building.openings.end(),
                                        [&](const Opening& opening) { return opening.kind == kind; }));
}

std::map<std::string, int> expected_counts(const Building& building) {
  int boundaries = 0, flights = 0, landings = 0;
  for (const Room& room : building.rooms) boundaries += static_cast<int>(room.walls.size() + room.virtual_edges.size());
  for (const Stair& stair : building.stairs) {
    flights += static_cast<int>(stair.flights.size());
    landings += static_cast<int>(stair.landings.size());
  }
  return {{"IFCBUILDINGSTOREY", static_cast<int>(building.storeys.size())},
          {"IFCCOLUMN", static_cast<int>(building.columns.size())},
          {"IFCDOOR", openings_of(building, OpeningKind::door)},
          {"IFCOPENINGELEMENT", static_cast<int>(building.openings.size())},
          {"IFCRELSPACEBOUNDARY", boundaries},
          {"IFCSLAB", static_cast<int>(building.slabs.size()) + landings},
          {"IFCSPACE", static_cast<int>(building.rooms.size())},
          {"IFCSTAIR", static_cast<int>(building.stairs.size())},
          {"IFCSTAIRFLIGHT", flights},
          {"IFCWALL", static_cast<int>(building.walls.size())},
          {"IFCWINDOW", openings_of(building, OpeningKind::window)}};
}

/// Ids of our walls in the written file: kept where they are GlobalIds, else found by the Tag.
std::map<std::string, std::string> global_ids(const std::string& text) {
  std::map<std::string, std::string> by_tag;
  for (std::size_t at = text.find("=IFCWALL('"); at != std::string::npos; at = text.find("=IFCWALL('", at + 1)) {
    const std::string line = text.substr(at, text.find('\n', at) - at);
    const std::size_t end = line.rfind("',"), begin = line.rfind(",'", end - 1);
    by_tag[line.substr(begin + 2, end - begin - 2)] = line.substr(10, 22);
  }
  return by_tag;
}

/// Walls that web-ifc is known to measure wrongly: this one's body is not closed in the file it comes from, and web-ifc
/// makes 122.9 m3 of that.
bool is_disputed(const std::string& id) { return id == "2O2Fr$t4X7Zf8NOew3FKau"; }

class WebIfc : public testing::TestWithParam<const char*> {};

TEST_P(WebIfc, FindsTheSameCountsAndWallVolumes) {
  const std::string name = GetParam();
  const bool in_library = name.starts_with("scenarios/");
  if (const std::string why = in_library ? "" : data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const std::string path = in_library ? project_file(name) : data_path(name);
  const Building building = load_building(path);
  const std::string text = write_ifc(building);
  const std::filesystem::path written =
      std::filesystem::path(testing::TempDir()) / ("plumbline_web_ifc_" + std::filesystem::path(name).stem().string());
  std::ofstream(written, std::ios::binary) << text;
  const std::optional<Measured> found = measured(written);
  std::filesystem::remove(written);
  if (!found) GTEST_SKIP() << "no node, or no web-ifc; get it with: npm ci --prefix tests/golden/web_ifc";

  for (const auto& [type, count] : expected_counts(building)) EXPECT_EQ(found->counts.at(type), count) << type;
  const std::map<std::string, std::string> ids = global_ids(text);
  const BuildingMesh mesh = build_mesh(building);
  for (const MeshElement& element : mesh.elements) {
    if (element.kind != ElementKind::wall || is_disputed(element.id)) continue;
    ASSERT_TRUE(ids.contains(element.id)) << element.id;
    const auto volume = found->wall_volumes_m3.find(ids.at(element.id));
    ASSERT_NE(volume, found->wall_volumes_m3.end()) << element.id;
    EXPECT_NEAR(volume->second, element.volume_m3, 0.005 * element.volume_m3) << element.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, WebIfc,
                         testing::Values("ifc/duplex.ifc", "ifc/AC20-FZK-Haus.ifc", "ifc/IfcOpenHouse_IFC4.ifc",
                                         "ifc/LargeBuilding.ifc", "ifc/ManySimpleWalls.ifc",
                                         "plans/office.building.yaml", "plans/hotel.building.yaml",
                                         "scenarios/library/quickstart.plan.yaml"),
                         [](const testing::TestParamInfo<const char*>& info) {
                           return test_name(std::filesystem::path(info.param).stem());
                         });

}  // namespace
}  // namespace plumbline::bim
