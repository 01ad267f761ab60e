// SPDX-License-Identifier: Apache-2.0
// What is written reads back: by our own reader exactly, as a foreign file in all that can be counted and measured.
#include "bim/formats/ifc/write/write_ifc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/roundtrip/roundtrip_reader.h"
#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"
#include "bim/formats/ifc/write/global_id.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "tests/bim/formats/ifc/random_building.h"
#include "tests/data.h"
#include "tests/input_error.h"
#include "tests/test_name.h"

namespace plumbline::bim {
namespace {

Building small_plan() {
  return read_plan_text(
      "plan: 1\nname: zwei 'Räume'\n"
      "storeys: [{id: g, elevation_m: 0, height_m: 3}]\n"
      "walls:\n"
      "  - {id: south, storey: g, a: [0, 0], b: [8, 0], thickness_m: 0.2, material: plaster}\n"
      "  - {id: east, storey: g, a: [8, 0], b: [8, 5], thickness_m: 0.2, just: left}\n"
      "  - {id: north, storey: g, a: [8, 5], b: [0, 5], thickness_m: 0.2, just: right}\n"
      "  - {id: west, storey: g, a: [0, 5], b: [0, 0], thickness_m: 0.2}\n"
      "  - {id: middle, storey: g, a: [4, 0], b: [4.5, 5], thickness_m: 0.1}\n"
      "openings:\n"
      "  - {id: d1, wall: middle, kind: door, s_m: 2.0, width_m: 0.9, height_m: 2.1, leaf: closed}\n"
      "  - {id: d2, wall: west, kind: door, s_m: 2.0, width_m: 0.9, height_m: 2.1}\n"
      "  - {id: v1, wall: north, kind: void, s_m: 2.0, width_m: 1.0, height_m: 2.0}\n"
      "  - {id: f1, wall: south, kind: window, s_m: 2.0, width_m: 1.2, height_m: 1.0, sill_m: 0.9}\n"
      "rooms:\n"
      "  - {id: küche, storey: g, polygon: [[0, 0], [4, 0], [4.5, 5], [0, 5]]}\n"
      "  - {id: bad, storey: g, polygon: [[4, 0], [8, 0], [8, 5], [4.5, 5]]}\n"
      "columns: [{id: c, storey: g, at: [2, 2], size: [0.3, 0.3], yaw_deg: 20}]\n"
      "clutter: [{id: tisch, storey: g, shape: box, at: [6, 2], size: [1, 1], height_m: 0.7}]\n"
      "materials: [{id: plaster, reflectivity: 0.7}]\n",
      "small.plan.yaml");
}

/// The same entities under another program's name, which the reader for any IFC takes.
std::string as_foreign(std::string text) {
  const std::size_t mark = text.find("'Plumbline [");
  EXPECT_NE(mark, std::string::npos);
  return text.replace(mark, 10, "'Elsewhere");
}

void expect_same_after_writing(const Building& building) {
  const std::string text = write_ifc(building);
  EXPECT_EQ(write_ifc(building), text);
  ASSERT_TRUE(has_roundtrip_signature(text));
  const Building back = read_ifc_text(text, "written.ifc");
  EXPECT_EQ(back.hash(), building.hash());
  EXPECT_EQ(back.name, building.name);
  EXPECT_EQ(back.moved_by, building.moved_by);
  EXPECT_TRUE(back.warnings.empty());
  EXPECT_EQ(write_ifc(back), text);
}

TEST(WriteIfc, PlanComesBack) { expect_same_after_writing(small_plan()); }

TEST(WriteIfc, PlaceOnTheMapComesBack) {
  Building building = small_plan();
  building.moved_by = Eigen::Vector3d(-691000.0, -5334000.0, -512.0);
  expect_same_after_writing(building);
  EXPECT_NE(write_ifc(building).find(",691000.,5334000.,512.,"), std::string::npos);
}

TEST(WriteIfc, RandomBuildingsComeBack) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    expect_same_after_writing(RandomBuilding(seed).make());
    if (HasFailure()) return;
  }
}

/// Sizes drawn by a seed, so that no number is round; every other one with glass.
TEST(WriteIfc, StressBuildingsComeBack) {
  for (const GeneratorRow& family : generators()) {
    for (int seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(std::string(family.name) + " " + std::to_string(seed));
      Tree options = Tree::map();
      options.set("seed", seed).set("glass", seed % 2 == 0);
      expect_same_after_writing(
          read_plan_text(write_plan(generate(family.name, options).plan), std::string(family.name) + ".plan.yaml"));
    }
  }
}

/// Each field that the hash sees must survive by itself: the hash of what is read has to follow it.
TEST(WriteIfc, EveryChangeIsSeenInTheText) {
  const Building building = small_plan();
  const std::string text = write_ifc(building);
  Building other = building;
  other.walls[0].slope = 1e-9;
  EXPECT_NE(write_ifc(other), text);
  other = building;
  other.rooms[1].virtual_edges.push_back({{4, 1}, {4, 2}, 0});
  EXPECT_NE(read_ifc_text(write_ifc(other), "o.ifc").hash(), building.hash());
  EXPECT_EQ(read_ifc_text(write_ifc(other), "o.ifc").hash(), other.hash());
}

TEST(WriteIfc, GlobalIdsAreValidUniqueAndKept) {
  Building building = small_plan();
  building.walls[0].id = "2O2Fr$t4X7Zf8NOew3FNbT";
  const std::string text = write_ifc(building);
  EXPECT_NE(text.find("IFCWALL('2O2Fr$t4X7Zf8NOew3FNbT'"), std::string::npos);
  std::set<std::string> seen;
  std::size_t roots = 0;
  for (std::size_t at = text.find("=IFC"); at != std::string::npos; at = text.find("=IFC", at + 1)) {
    const std::size_t bracket = text.find('(', at);
    const std::string first = text.substr(bracket + 1, 24);
    if (first.front() != '\'' || first.back() != '\'' || !global_id_bits(first.substr(1, 22))) continue;
    ++roots;
    seen.insert(first);
  }
  EXPECT_GT(roots, 40u);
  EXPECT_EQ(seen.size(), roots);
  EXPECT_NE(text.find("'1970-01-01T00:00:00'"), std::string::npos);
}

TEST(WriteIfc, ChangedFilesAreReadLikeAnyOther) {
  const std::string text = write_ifc(small_plan());
  std::string windows;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_ifc_text(windows, "crlf.ifc").hash(), small_plan().hash());
  std::string edited = text;
  const std::size_t at = edited.find("IFCMATERIALLAYER($,0.2");
  ASSERT_NE(at, std::string::npos);
  edited[at + 21] = '3';
  EXPECT_FALSE(has_roundtrip_signature(edited));
  const Building back = read_ifc_text(edited, "edited.ifc");
  EXPECT_EQ(back.walls.size(), small_plan().walls.size());
}

TEST(WriteIfc, SpoiledTextIsAnInputErrorWithItsLine) {
  const std::string text = write_ifc(small_plan());
  const auto line_of_fault = [](const std::string& spoiled) {
    return input_error([&] { (void)read_roundtrip(spoiled, "s.ifc"); });
  };
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string spoiled = text;
    const std::size_t at = spoiled.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return spoiled.replace(at, what.size(), by);
  };
  for (const auto& [what, by] :
       std::vector<std::pair<std::string, std::string>>{{"IFCTEXT('habitable')", "IFCTEXT('cellar')"},
                                                        {"IFCLENGTHMEASURE(0.9)", "IFCLENGTHMEASURE(9e300)"},
                                                        {"'Bottom'", "'Button'"},
                                                        {"'EndX'", "'EndZ'"},
                                                        {"IFCMATERIALLAYER($,0.2", "IFCMATERIALLAYER($,2.E300"},
                                                        {"IFCTRIANGULATEDFACESET(#", "IFCWALL(#"},
                                                        {"IFCRELVOIDSELEMENT", "IFCRELFILLSELEMENT"}}) {
    EXPECT_NE(line_of_fault(replaced(what, by)).find("s.ifc:"), std::string::npos) << what;
  }
}

/// Cut, flipped and shuffled bytes never do more than throw InputError.
TEST(WriteIfc, RandomDamageIsCaught) {
  const std::string text = write_ifc(small_plan());
  const Stream random(7, "bim.generate");
  const std::string_view letters = "#(),.'$*0123456789EIFCT-";
  int refused = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    std::string damaged = text;
    for (std::uint32_t k = 0; k <= i % 3; ++k)
      damaged[random.bits(i, 0, k) % damaged.size()] = letters[random.bits(i, 1, k) % letters.size()];
    try {
      (void)read_roundtrip(damaged, "d.ifc");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

/// Along, against and across the axes and aslant; layers are counted along y of a placement, whatever that is.
TEST(WriteIfc, AForeignReaderSeesLayersWhereTheyAre) {
  const Building building = small_plan();
  const Building back = read_ifc_text(as_foreign(write_ifc(building)), "foreign.ifc");
  for (const Warning& warning : back.warnings) EXPECT_NE(warning.kind, "layer_mismatch") << warning.text;
  for (const Wall& wall : building.walls) {
    const auto found =
        std::find_if(back.walls.begin(), back.walls.end(), [&](const Wall& w) { return w.name == wall.name; });
    ASSERT_NE(found, back.walls.end()) << wall.id;
    constexpr double grid_m = 1e-4;  // of the reader for any IFC
    EXPECT_NEAR((found->a - wall.a).norm() + (found->b - wall.b).norm(), 0.0, grid_m) << wall.id;
    EXPECT_NEAR(found->offset_m, wall.offset_m, grid_m) << wall.id;
    EXPECT_NEAR(found->thickness_m, wall.thickness_m, grid_m) << wall.id;
  }
}

TEST(WriteIfc, AForeignReaderSeesReflectivityAndGlass) {
  Building building = small_plan();
  building.materials.push_back({"Spiegel", 0.1, 0.2, 0.7, 0.25});
  building.walls[1].material = "Spiegel";
  const Building back = read_ifc_text(as_foreign(write_ifc(building)), "foreign.ifc");
  const auto material = [&](const std::string& id) {
    const auto found = std::find_if(back.materials.begin(), back.materials.end(),
                                    [&](const Material& candidate) { return candidate.id == id; });
    EXPECT_NE(found, back.materials.end()) << id;
    return found == back.materials.end() ? Material{} : *found;
  };
  EXPECT_EQ(material("Spiegel").reflectivity, 0.1);
  EXPECT_EQ(material("Spiegel").transmission, 0.2);
  EXPECT_EQ(material("Spiegel").specular, 0.7);
  EXPECT_EQ(material("Spiegel").retro, 0.25);
  EXPECT_EQ(material("plaster").reflectivity, 0.7);
}

class WrittenFile : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const std::string& name = GetParam();
    const bool in_library = name.starts_with("scenarios/");
    if (const std::string why = in_library ? "" : data_missing(name); !why.empty()) GTEST_SKIP() << why;
    path_ = in_library ? project_file(name) : data_path(name);
    building_ = load_building(path_);
  }
  void comes_back();
  void comes_back_as_built();
  void is_the_same_building_to_a_foreign_reader();

  std::string path_;
  Building building_;
};

void WrittenFile::comes_back() { expect_same_after_writing(building_); }

/// It has its doors and panes, and gets no second ones.
void WrittenFile::comes_back_as_built() {
  const Building as_built = load_planned_and_built(path_).as_built;
  expect_same_after_writing(as_built);
  const std::string name = "plumbline_" + std::filesystem::path(GetParam()).stem().string() + ".ifc";
  const std::filesystem::path written = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(written, std::ios::binary) << write_ifc(as_built);
  EXPECT_EQ(load_planned_and_built(written).as_built.hash(), as_built.hash());
  std::filesystem::remove(written);
}

/// Nothing of this rests on our property sets: reference lines, bodies, openings and spaces speak for themselves.
void WrittenFile::is_the_same_building_to_a_foreign_reader() {
  const Building back = read_ifc_text(as_foreign(write_ifc(building_)), "foreign.ifc");
  ASSERT_EQ(back.walls.size(), building_.walls.size());
  EXPECT_EQ(back.openings.size(), building_.openings.size());
  EXPECT_EQ(back.storeys.size(), building_.storeys.size());
  EXPECT_EQ(back.columns.size(), building_.columns.size());
  if (!building_.rooms.empty()) {
    EXPECT_EQ(back.rooms.size(), building_.rooms.size());
  }
  const auto walls_volume = [](const Building& b) {
    double sum = 0.0;
    for (const MeshElement& e : build_mesh(b).elements)
      if (e.kind == ElementKind::wall) sum += e.volume_m3;
    return sum;
  };
  // Openings of a plan become solids on the 0.01 mm grid.
  EXPECT_NEAR(walls_volume(back) / walls_volume(building_), 1.0, 1e-4);
}

TEST_P(WrittenFile, IsTheBuilding) {
  comes_back();
  comes_back_as_built();
  is_the_same_building_to_a_foreign_reader();
}

std::vector<std::string> own_files() {
  std::vector<std::string> names{"ifc/twin_flats.ifc", "ifc/gable_house.ifc", "ifc/workshop.ifc", "ifc/walls_only.ifc",
                                 "plans/guesthouse.building.yaml"};
  const std::filesystem::path library = project_file("scenarios/library");
  if (!std::filesystem::exists(library)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(library)) {
    const std::string name = entry.path().filename();
    if (name.ends_with(".plan.yaml")) names.push_back("scenarios/library/" + name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string written_name(const testing::TestParamInfo<std::string>& info) {
  return test_name(std::filesystem::path(info.param).stem());
}

INSTANTIATE_TEST_SUITE_P(Own, WrittenFile, testing::ValuesIn(own_files()), written_name);
INSTANTIATE_TEST_SUITE_P(Foreign, WrittenFile,
                         testing::Values("ifc/duplex.ifc", "ifc/AC20-FZK-Haus.ifc", "ifc/IfcOpenHouse_IFC4.ifc",
                                         "ifc/LargeBuilding.ifc", "ifc/ManySimpleWalls.ifc",
                                         "plans/office.building.yaml", "plans/hotel.building.yaml"),
                         written_name);

}  // namespace
}  // namespace plumbline::bim
