// SPDX-License-Identifier: Apache-2.0
#include "bim/load/load.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bim/errors.h"
#include "bim/mesh/mesh.h"
#include "bim/plan/plan.h"
#include "tests/data.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

std::string quickstart() { return project_file("scenarios/library/quickstart.plan.yaml"); }

/// A file that goes away with the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name, const std::string& text)
      : path_(std::filesystem::path(testing::TempDir()) / ("plumbline_load_" + name)) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(Load, RefusesWhatIsNoBuilding) {
  EXPECT_THROW((void)load_building("/nowhere/at/all.yaml"), InputError);
  EXPECT_THROW((void)load_building(testing::TempDir()), InputError);
  EXPECT_THROW((void)load_building(TemporaryFile("empty.yaml", "").path()), InputError);
  const TemporaryFile empty("empty.ifc", ""), letter("letter.txt", "Dear Sir or Madam,\n"),
      blank("blank.yaml", "# nothing\n");
  EXPECT_THROW((void)load_building(empty.path()), InputError);
  EXPECT_THROW((void)load_building(letter.path()), InputError);
  EXPECT_THROW((void)load_building(blank.path()), InputError);
}

TEST(Load, RefusesAnArchiveByWhatItIs) {
  const TemporaryFile archive("house.ifczip", "PK\x03\x04 and more");
  EXPECT_NE(input_error([&] { (void)load_building(archive.path()); }).find("is a zip archive"), std::string::npos);
}

TEST(Load, EndingsOfMeshesMayBeInCapitals) {
  const TemporaryFile mesh("HALL.OBJ", "v 0 0 0\nv 9 0 0\nv 9 9 0\nf 1 2 3\n");
  EXPECT_EQ(load_building(mesh.path()).schema, "mesh");
}

TEST(Load, TellsAPlanByItsContent) {
  const TemporaryFile plan(
      "plan.txt", "# a plan\n\nplan: 1\nstoreys: [{id: g}]\nwalls: [{id: w, storey: g, a: [0, 0], b: [1, 0]}]\n");
  EXPECT_EQ(load_building(plan.path()).walls.size(), 1U);
}

TEST(Quickstart, IsARealFloor) {
  const Building building = load_building(quickstart());
  EXPECT_EQ(building.rooms.size(), 8U);
  for (const Opening& opening : building.openings) {
    if (opening.kind != OpeningKind::door || opening.leaf != Leaf::open) continue;
    EXPECT_GE(opening.rooms[0], 0) << opening.id;
    EXPECT_GE(opening.rooms[1], 0) << opening.id;
  }
  for (const Room& room : building.rooms) EXPECT_GE(room.walls.size(), 4U) << room.id;
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(mesh.warnings.empty());
  for (const MeshElement& element : mesh.elements) EXPECT_TRUE(element.closed) << element.id;
}

TEST(Quickstart, TwinsAreAlikeAndTheFloorIsConnected) {
  const Building building = load_building(quickstart());
  const Plan plan = make_plan(building);
  const auto room = [&](const std::string& name) -> const PlanRoom& {
    for (const PlanRoom& r : plan.rooms)
      if (r.name == name) return r;
    throw InternalError("no room " + name);
  };
  const Polygon2 &a = room("office_a").polygon, &b = room("office_b").polygon;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR((b[i] - a[i] - Eigen::Vector2d(4, 0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(room("corridor").neighbours.size(), 7U);
  for (const PlanRoom& r : plan.rooms) {
    EXPECT_FALSE(r.neighbours.empty()) << r.name;
    EXPECT_GE(r.faces.size(), 4U) << r.name;
    for (const int id : r.faces) {
      const PlanFace& face = plan.faces[static_cast<std::size_t>(id)];
      const Eigen::Vector2d inner = centroid(r.polygon);
      EXPECT_GT(face.plane_W.distance({inner.x(), inner.y(), 1.0}), 0.0) << r.name << " " << face.wall_id;
    }
  }
}

}  // namespace
}  // namespace plumbline::bim
