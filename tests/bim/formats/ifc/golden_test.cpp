// SPDX-License-Identifier: Apache-2.0
// Files of others against what an independent reader (web-ifc) made of them, our own against what they were made of.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/geometry/polygon.h"
#include "bim/mesh/mesh.h"
#include "tests/bim/formats/ifc/read_ifc.h"
#include "tests/bim/formats/ifc/self_intersection.h"
#include "tests/data.h"
#include "tests/test_name.h"

namespace plumbline::bim {
namespace {

struct GoldenRow {
  std::string type;
  double volume_m3 = 0.0;
  Eigen::Vector3d low, high;
  std::string status;
};

/// step_id class volume_m3 closed bbox_min_xyz bbox_max_xyz status
std::map<std::int64_t, GoldenRow> read_golden(const std::string& path) {
  std::map<std::int64_t, GoldenRow> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::int64_t step_id = 0;
    int closed = 0;
    GoldenRow row;
    words >> step_id >> row.type >> row.volume_m3 >> closed;
    for (double& v : row.low) words >> v;
    for (double& v : row.high) words >> v;
    words >> row.status;
    rows[step_id] = row;
  }
  return rows;
}

struct Case {
  std::string name;
  /// What the reader has beyond the golden rows: rooms it made of walls, windows whose parts alone have a mesh.
  std::map<std::string, int> beyond;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class GoldenTest : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const std::string name = "ifc/" + GetParam().name;
    for (const char* end : {".ifc", ".golden.tsv"})
      if (const std::string why = data_missing(name + end); !why.empty()) GTEST_SKIP() << why;
    golden_ = read_golden(data_path(name + ".golden.tsv"));
    building_ = read_ifc(data_path(name + ".ifc"));
  }

  void has_as_many_of_each_class();
  void every_stair_is_walkable();
  void cut_walls_and_slabs_have_the_golden_volume_and_box();
  void walls_and_slabs_do_not_intersect_themselves();
  void rooms_have_the_golden_box();
  void reads_the_same_again_and_after_another_file();

  [[nodiscard]] int golden_count(const std::set<std::string>& types) const {
    int count = 0;
    for (const auto& [step_id, row] : golden_) count += types.contains(row.type) ? 1 : 0;
    return count;
  }
  [[nodiscard]] int beyond(const std::string& type) const {
    const auto found = GetParam().beyond.find(type);
    return found == GetParam().beyond.end() ? 0 : found->second;
  }
  [[nodiscard]] int obstacles(const std::string& kind) const {
    return static_cast<int>(std::count_if(building_.obstacles.begin(), building_.obstacles.end(),
                                          [&](const Obstacle& o) { return o.kind == kind; }));
  }
  [[nodiscard]] int openings(OpeningKind kind) const {
    return static_cast<int>(std::count_if(building_.openings.begin(), building_.openings.end(),
                                          [&](const Opening& o) { return o.kind == kind; }));
  }

  std::map<std::int64_t, GoldenRow> golden_;
  Building building_;
};

void GoldenTest::has_as_many_of_each_class() {
  EXPECT_EQ(building_.walls.size(), golden_count({"IFCWALL", "IFCWALLSTANDARDCASE"}));
  EXPECT_EQ(building_.rooms.size(), golden_count({"IFCSPACE"}) + beyond("IFCSPACE"));
  EXPECT_EQ(building_.slabs.size(), golden_count({"IFCSLAB"}));
  EXPECT_EQ(building_.columns.size(), golden_count({"IFCCOLUMN"}));
  EXPECT_EQ(openings(OpeningKind::door), golden_count({"IFCDOOR"}));
  EXPECT_EQ(openings(OpeningKind::window) + obstacles("roof_window"),
            golden_count({"IFCWINDOW"}) + beyond("IFCWINDOW"));
  EXPECT_EQ(building_.stairs.size(), golden_count({"IFCSTAIR", "IFCSTAIRFLIGHT"}));
}

void GoldenTest::every_stair_is_walkable() {
  for (const Stair& stair : building_.stairs) {
    ASSERT_FALSE(stair.flights.empty()) << stair.id;
    EXPECT_GE(stair.to, 0) << stair.id;
    double z = stair.flights.front().z0_m;
    for (const StairFlight& flight : stair.flights) {
      EXPECT_NEAR(flight.z0_m, z, 0.01) << stair.id;
      EXPECT_GT(flight.run_m, 0.2) << stair.id;
      EXPECT_GT(flight.width_m, 0.7) << stair.id;
      z += flight.steps * flight.rise_m;
    }
  }
}

/// The golden volumes have 5 decimals, its boxes 4; the bodies are kept to 0.01 mm and the cut faces to 0.1 mm.
void GoldenTest::cut_walls_and_slabs_have_the_golden_volume_and_box() {
  const BuildingMesh mesh = build_mesh(building_);
  int compared = 0;
  for (const MeshElement& element : mesh.elements) {
    const auto index = static_cast<std::size_t>(element.index);
    if (element.kind != ElementKind::wall && element.kind != ElementKind::slab) continue;
    const std::int64_t step_id =
        element.kind == ElementKind::wall ? building_.walls[index].step_id : building_.slabs[index].step_id;
    EXPECT_TRUE(element.closed) << element.id;
    const auto row = golden_.find(step_id);
    if (row == golden_.end() || row->second.status != "ok") continue;
    EXPECT_NEAR(element.volume_m3, row->second.volume_m3, 0.005 * row->second.volume_m3) << "#" << step_id;
    Solid solid;
    for (int t = 0; t < element.triangle_count; ++t)
      for (const int corner : mesh.triangles[static_cast<std::size_t>(element.first_triangle + t)])
        solid.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : solid.vertices) box.extend(p);
    EXPECT_LT((box.min() - row->second.low).cwiseAbs().maxCoeff(), 2e-3) << "#" << step_id;
    EXPECT_LT((box.max() - row->second.high).cwiseAbs().maxCoeff(), 2e-3) << "#" << step_id;
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

/// No wall or slab mesh cuts through itself (CGAL's exact test), and no source wall here is left open.
void GoldenTest::walls_and_slabs_do_not_intersect_themselves() {
  const BuildingMesh mesh = build_mesh(building_);
  for (const MeshElement& element : mesh.elements) {
    if (element.kind != ElementKind::wall && element.kind != ElementKind::slab) continue;
    EXPECT_TRUE(element.closed) << element.id;
    EXPECT_GT(element.volume_m3, 0.0) << element.id;  // outward
    EXPECT_FALSE(intersects_itself(mesh, element)) << element.id;
  }
}

/// Where a space is a prism its volume is area times height; others (a stair's) have at most that.
void GoldenTest::rooms_have_the_golden_box() {
  for (const Room& room : building_.rooms) {
    const auto row = golden_.find(room.step_id);
    if (row == golden_.end()) continue;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
    EXPECT_LT((box.min() - row->second.low.head<2>()).cwiseAbs().maxCoeff(), 2e-3) << "#" << room.step_id;
    EXPECT_LT((box.max() - row->second.high.head<2>()).cwiseAbs().maxCoeff(), 2e-3) << "#" << room.step_id;
    EXPECT_NEAR(room.z0_m, row->second.low.z(), 2e-3);
    EXPECT_NEAR(room.z1_m, row->second.high.z(), 2e-3);
    EXPECT_TRUE(is_simple(room.polygon));
    if (row->second.status != "ok") continue;
    const double prism = signed_area(room.polygon) * (room.z1_m - room.z0_m);
    EXPECT_GE(prism, row->second.volume_m3 * 0.999) << "#" << room.step_id;
  }
}

void GoldenTest::reads_the_same_again_and_after_another_file() {
  const std::string ifc = data_path("ifc/" + GetParam().name + ".ifc");
  EXPECT_EQ(read_ifc(ifc).hash(), building_.hash());
  (void)read_ifc(data_path("ifc/walls_only.ifc"));
  EXPECT_EQ(read_ifc(ifc).hash(), building_.hash());
}

/// One test a file, since reading the large ones takes a second.
TEST_P(GoldenTest, AgreesWithItsRows) {
  has_as_many_of_each_class();
  every_stair_is_walkable();
  cut_walls_and_slabs_have_the_golden_volume_and_box();
  walls_and_slabs_do_not_intersect_themselves();
  rooms_have_the_golden_box();
  reads_the_same_again_and_after_another_file();
}

std::string golden_name(const testing::TestParamInfo<Case>& info) { return test_name(info.param.name); }

INSTANTIATE_TEST_SUITE_P(Own, GoldenTest,
                         testing::Values(Case{"twin_flats", {}}, Case{"gable_house", {}}, Case{"workshop", {}},
                                         Case{"walls_only", {{"IFCSPACE", 1}}}),
                         golden_name);
INSTANTIATE_TEST_SUITE_P(Foreign, GoldenTest,
                         testing::Values(Case{"duplex", {}}, Case{"AC20-FZK-Haus", {}}, Case{"LargeBuilding", {}},
                                         Case{"ManySimpleWalls", {}},
                                         Case{"IfcOpenHouse_IFC4", {{"IFCSPACE", 1}, {"IFCWINDOW", 5}}}),
                         golden_name);

}  // namespace
}  // namespace plumbline::bim
