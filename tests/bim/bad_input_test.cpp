// SPDX-License-Identifier: Apache-2.0
// What no reader may fall over: each input is read, with a warning or not, or refused as an InputError.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/mesh/mesh_world.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/formats/traffic_editor/traffic_editor.h"
#include "bim/mesh/mesh.h"
#include "tests/bim/formats/ifc/fixture.h"

namespace plumbline::bim {
namespace {

constexpr std::size_t deep = 1'000'000;

const std::string small_plan =
    "plan: 1\nname: small\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\n"
    "walls:\n  - {id: a, storey: g, a: [0, 0], b: [4, 0], thickness_m: 0.2}\n"
    "  - {id: b, storey: g, a: [4, 0], b: [4, 4], thickness_m: 0.2}\n"
    "openings: [{id: d, wall: a, kind: door, s_m: 2, width_m: 0.9, height_m: 2, leaf: open}]\n"
    "columns: [{id: c, storey: g, at: [2, 2], size: [0.3, 0.3]}]\n"
    "clutter: [{id: e, storey: g, shape: cylinder, at: [1, 1], size: [0.5, 0.5], height_m: 1}]\n"
    "materials: [{id: m, reflectivity: 0.5}]\n"
    "deviations: [{op: move_wall, wall: b, by: [0.1, 0]}]\n";
const std::string small_traffic =
    "name: small\nlevels:\n  L1:\n    elevation: 0\n    vertices: [[0, 0, 0, a], [90, 0, 0, \"\"], [90, 90, 0, \"\"]]\n"
    "    measurements: [[0, 1, {distance: [3, 9]}]]\n    walls: [[0, 1, {}], [1, 2, {}], [2, 0, {}]]\n"
    "    doors: [[0, 1, {name: [1, d]}]]\n    floors: [{vertices: [0, 1, 2]}]\n";

struct Reader {
  const char* name;
  std::string sound;
  std::function<void(const std::string&)> read;
};

std::vector<Reader> readers() {
  return {{"ifc", small_ifc({}), [](const std::string& t) { (void)build_mesh(read_ifc_text(t, "bad.ifc")); }},
          {"plan", small_plan,
           [](const std::string& t) { (void)build_mesh(read_plan_with_deviations(t, "bad.yaml").as_built.building); }},
          {"traffic", small_traffic,
           [](const std::string& t) { (void)build_mesh(read_traffic_editor_text(t, "bad.building.yaml")); }}};
}

/// True when it was refused.
bool refused(const Reader& reader, const std::string& text) {
  try {
    reader.read(text);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

TEST(BadInput, TheSoundTextsAreRead) {
  for (const Reader& reader : readers()) EXPECT_NO_THROW(reader.read(reader.sound)) << reader.name;
}

TEST(BadInput, CutAt200Points) {
  for (const Reader& reader : readers()) {
    int count = 0;
    for (std::size_t i = 0; i < 200; ++i)
      count += refused(reader, reader.sound.substr(0, i * reader.sound.size() / 200));
    EXPECT_GT(count, 100) << reader.name;
  }
}

TEST(BadInput, FlippedBits) {
  for (const Reader& reader : readers())
    for (std::size_t i = 0; i < 400; ++i) {
      std::string text = reader.sound;
      char& c = text[i * text.size() / 400];
      c = static_cast<char>(c ^ (1 << (i % 8)));
      (void)refused(reader, text);
    }
}

/// Each number of the text in turn.
TEST(BadInput, AbsurdNumbers) {
  for (const Reader& reader : readers())
    for (const char* value : {"nan", ".nan", ".inf", "1e30", "-1e30", "1e308", "-1", "99999999999999999999"}) {
      const std::string digits = "0123456789.";
      for (std::size_t begin = reader.sound.find_first_of(digits); begin != std::string::npos;) {
        const std::size_t end = reader.sound.find_first_not_of(digits, begin);
        std::string text = reader.sound;
        text.replace(begin, end - begin, value);
        (void)refused(reader, text);
        begin = end == std::string::npos ? end : reader.sound.find_first_of(digits, end);
      }
    }
}

TEST(BadInput, NestedAMillionDeep) {
  for (const Reader& reader : readers()) {
    const std::string open = reader.name == std::string("ifc") ? "(" : "[";
    std::string nested;
    for (std::size_t i = 0; i < deep; ++i) nested += open;
    std::string text = reader.sound;
    const std::size_t at = text.find(open);
    EXPECT_TRUE(refused(reader, text.insert(at, nested))) << reader.name;
    EXPECT_TRUE(refused(reader, nested)) << reader.name;
  }
  std::string maps;
  for (std::size_t i = 0; i < deep; ++i) maps += "{a: ";
  EXPECT_TRUE(refused(readers()[1], "plan: " + maps));
  EXPECT_TRUE(refused(readers()[2], "levels: " + maps));
}

TEST(BadInput, MeshesNestedAMillionDeep) {
  std::string json(deep, '[');
  json.resize(json.size() + (4 - json.size() % 4) % 4, ' ');
  const auto word = [](std::size_t v) {
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>((v >> (8 * k)) & 0xff);
    return bytes;
  };
  const std::string glb = "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
  EXPECT_THROW((void)read_mesh_world(glb, "deep.glb"), InputError);
  std::string dae = "<COLLADA version=\"1.4.1\"><library_visual_scenes><visual_scene id=\"s\">";
  for (std::size_t i = 0; i < deep / 10; ++i) dae += "<node>";
  EXPECT_THROW((void)read_mesh_world(dae, "deep.dae"), InputError);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(BadInput, DuplicatesAndNegativeThickness) {
  const Reader plan = readers()[1], traffic = readers()[2];
  EXPECT_TRUE(refused(plan, replaced(small_plan, "id: b", "id: a")));
  EXPECT_TRUE(refused(plan, replaced(small_plan, "thickness_m: 0.2", "thickness_m: -0.2")));
  EXPECT_TRUE(refused(plan, replaced(small_plan, "name: small\n", "name: small\nname: small\n")));
  EXPECT_TRUE(refused(traffic, replaced(small_traffic, "elevation: 0\n", "elevation: 0\n    elevation: 0\n")));
}

/// Every reference of the file, turned into one to the entity it stands in.
TEST(BadInput, IfcCycles) {
  const Reader ifc = readers()[0];
  const std::string& whole = ifc.sound;
  for (std::size_t line = whole.find("\n#"); line != std::string::npos; line = whole.find("\n#", line + 1)) {
    const std::string self = whole.substr(line + 1, whole.find('=', line) - line - 1);
    const std::size_t end = whole.find(';', line);
    for (std::size_t at = whole.find('#', line + 2); at < end; at = whole.find('#', at + 1)) {
      const std::size_t stop = whole.find_first_not_of("0123456789", at + 1);
      (void)refused(ifc, whole.substr(0, at) + self + whole.substr(stop));
    }
  }
}

TEST(BadInput, IfcPartsOfThemselves) {
  const Reader ifc = readers()[0];
  const auto with_wholes = [&](const std::string& relations) {
    return replaced(ifc.sound, "ENDSEC;\nEND-ISO", relations + "ENDSEC;\nEND-ISO");
  };
  const std::string again = "#901=IFCWALL('0000000000000000000091',$,'again',$,$,#41,#50,$,$);\n";
  const auto part_of = [](const std::string& id, const std::string& whole, const std::string& part) {
    return "#9" + id + "=IFCRELAGGREGATES('00000000000000000000" + id + "',$,$,$," + whole + ",(" + part + "));\n";
  };
  EXPECT_FALSE(refused(ifc, with_wholes(again + part_of("92", "#40", "#901"))));
  EXPECT_TRUE(refused(ifc, with_wholes(part_of("92", "#40", "#40"))));
  EXPECT_TRUE(refused(ifc, with_wholes(again + part_of("92", "#40", "#901") + part_of("93", "#901", "#40"))));
}

}  // namespace
}  // namespace plumbline::bim
