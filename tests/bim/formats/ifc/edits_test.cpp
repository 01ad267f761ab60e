// SPDX-License-Identifier: Apache-2.0
// Twelve things that happen to files on their way, done to each of the five files of others: what is read then follows
// from what was read before.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/mesh/mesh.h"
#include "bim/model/floors.h"
#include "tests/bim/formats/ifc/read_ifc.h"
#include "tests/data.h"
#include "tests/test_name.h"

namespace plumbline::bim {
namespace {

/// A STEP file as its statements.
class Statements {
 public:
  explicit Statements(const std::string& text) {
    bool in_string = false;
    std::size_t begin = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
      if (text[at] == '\'') in_string = !in_string;
      if (text[at] != ';' || in_string) continue;
      all_.push_back(text.substr(begin, at + 1 - begin));
      begin = at + 1;
    }
    rest_ = text.substr(begin);
  }

  /// IFCWALL of #1=IFCWALL(...); empty for what is no entity.
  static std::string type(const std::string& statement) {
    std::size_t at = statement.find_first_not_of(" \r\n\t");
    if (at == std::string::npos || statement[at] != '#') return {};
    at = statement.find_first_not_of(" ", statement.find('=', at) + 1);
    return statement.substr(at, statement.find_first_of("( ", at) - at);
  }

  /// Leaves out every n-th entity of these classes; how many there were.
  int remove(const std::set<std::string>& types, int every = 1) {
    int count = 0;
    for (std::string& statement : all_)
      if (types.contains(type(statement)) && count++ % every == 0) statement.clear();
    return count;
  }

  void replace(const std::string& from, const std::string& to) {
    for (std::string& statement : all_)
      if (const std::size_t at = statement.find(from); at != std::string::npos) statement.replace(at, from.size(), to);
  }

  [[nodiscard]] std::string text() const {
    std::string result;
    for (const std::string& statement : all_) result += statement;
    return result + rest_;
  }

 private:
  std::vector<std::string> all_;
  std::string rest_;
};

/// What was read, or why not.
struct Outcome {
  std::optional<Building> building;
  std::string refused;
  double walls_m3 = 0.0;

  [[nodiscard]] int warned(const std::string& kind, const std::string& about = {}) const {
    return static_cast<int>(std::count_if(
        building->warnings.begin(), building->warnings.end(),
        [&](const Warning& warning) { return warning.kind == kind && warning.text.find(about) != std::string::npos; }));
  }
  [[nodiscard]] int doors() const {
    return static_cast<int>(std::count_if(building->openings.begin(), building->openings.end(),
                                          [](const Opening& o) { return o.kind == OpeningKind::door; }));
  }
};

Outcome outcome_of(const std::string& text) {
  Outcome outcome;
  try {
    outcome.building = read_ifc_text(text, "edited.ifc");
    for (const MeshElement& element : build_mesh(*outcome.building).elements)
      if (element.kind == ElementKind::wall) outcome.walls_m3 += element.volume_m3;
  } catch (const InputError& error) {
    outcome.refused = error.what();
  }
  return outcome;
}

struct Edit {
  std::string name;
  std::function<std::string(Statements)> change;
  std::function<void(const Outcome& before, const Outcome& after)> expect;
};

void same_walls(const Outcome& before, const Outcome& after, double cubed = 1.0) {
  ASSERT_TRUE(after.building) << after.refused;
  EXPECT_EQ(after.building->walls.size(), before.building->walls.size());
  EXPECT_NEAR(after.walls_m3 / (cubed * before.walls_m3), 1.0, cubed == 1.0 ? 1e-6 : 0.02);
}

/// Every habitable storey with walls has something to stand on, or it is said that there is nothing.
void floors_everywhere(const Outcome& after) {
  std::set<int> with_floor;
  for (const FloorPiece& piece : floor_pieces(*after.building)) with_floor.insert(piece.storey);
  for (std::size_t i = 0; i < after.building->storeys.size(); ++i) {
    if (after.building->storeys[i].kind != StoreyKind::habitable) continue;
    const bool walls = std::any_of(after.building->walls.begin(), after.building->walls.end(),
                                   [&](const Wall& wall) { return wall.storey == static_cast<int>(i); });
    EXPECT_TRUE(!walls || with_floor.contains(static_cast<int>(i))) << i;
  }
}

const std::set<std::string> walls = {"IFCWALL", "IFCWALLSTANDARDCASE", "IFCWALLELEMENTEDCASE"};

std::vector<Edit> edits() {
  return {
      {"NoSlabs",
       [](Statements s) {
         s.remove({"IFCSLAB", "IFCSLABSTANDARDCASE"});
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         floors_everywhere(after);
       }},
      {"NoSpaces",
       [](Statements s) {
         s.remove({"IFCSPACE"});
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         const bool had = !before.building->rooms.empty() && before.warned("inferred_room") == 0;
         EXPECT_EQ(after.warned("dangling") > before.warned("dangling"), had);
         EXPECT_EQ(after.warned("inferred_room"), static_cast<int>(after.building->rooms.size()));
         floors_everywhere(after);
       }},
      {"NoWalls",
       [](Statements s) {
         s.remove(walls);
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         if (before.building->slabs.empty() && before.building->rooms.empty()) {
           EXPECT_NE(after.refused.find("no IfcSlab, no IfcSpace and no IfcWall"), std::string::npos) << after.refused;
           return;
         }
         ASSERT_TRUE(after.building) << after.refused;
         // Proxies and plates may stand in for walls; else it is said that there are none.
         EXPECT_EQ(after.warned("no_walls"), after.building->walls.empty() ? 1 : 0);
         EXPECT_EQ(after.warned("taken_as_wall"), static_cast<int>(after.building->walls.size()));
       }},
      {"NoStoreys",
       [](Statements s) {
         s.remove({"IFCBUILDINGSTOREY"});
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         EXPECT_EQ(after.warned("assumed_storey"), static_cast<int>(after.building->storeys.size()));
         EXPECT_FALSE(after.building->storeys.empty());
         floors_everywhere(after);
       }},
      {"AsIfc4x3",
       [](Statements s) {
         s.replace("FILE_SCHEMA(('IFC4'))", "FILE_SCHEMA(('IFC4X3_ADD2'))");
         s.replace("FILE_SCHEMA (('IFC4'))", "FILE_SCHEMA(('IFC4X3_ADD2'))");
         s.replace("FILE_SCHEMA(('IFC2X3'))", "FILE_SCHEMA(('IFC4X3_ADD2'))");
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         EXPECT_EQ(after.warned("other_schema"), 1);
         EXPECT_EQ(after.building->rooms.size(), before.building->rooms.size());
       }},
      {"AsTheOtherSchema",
       [](Statements s) {
         s.replace("'IFC4'", "'IFC-'");
         s.replace("'IFC2X3'", "'IFC4'");
         s.replace("'IFC-'", "'IFC2X3'");
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         EXPECT_EQ(after.warned("other_schema"), 1);
         EXPECT_EQ(after.building->openings.size(), before.building->openings.size());
       }},
      {"InAnotherUnit",
       [](Statements s) {
         s.replace(".LENGTHUNIT.,.MILLI.,.METRE.", ".LENGTHUNIT.,.CENTI.,.METRE.");
         s.replace(".LENGTHUNIT.,$,.METRE.", ".LENGTHUNIT.,.DECI.,.METRE.");
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         ASSERT_TRUE(after.building) << after.refused;
         const bool larger = before.building->unit == "mm";
         EXPECT_EQ(after.building->walls.size(), before.building->walls.size());
         if (larger) same_walls(before, after, 1000.0);
       }},
      {"EveryThirdOpeningLost",
       [](Statements s) {
         s.remove({"IFCOPENINGELEMENT"}, 3);
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         ASSERT_TRUE(after.building) << after.refused;
         EXPECT_EQ(after.building->walls.size(), before.building->walls.size());
         EXPECT_GT(after.warned("dangling"), before.warned("dangling"));
         // Every door that is no longer one is named.
         const int named = after.warned("door_without_wall") + after.warned("no_body", "IfcDoor");
         EXPECT_GE(after.doors() + named, before.doors());
       }},
      {"PointsLost",
       [](Statements s) {
         s.remove({"IFCCARTESIANPOINT"}, 97);
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         if (!after.building) {  // a lost point may be the one that all placements share
           EXPECT_NE(after.refused.find("which is not in the file"), std::string::npos) << after.refused;
           return;
         }
         EXPECT_GE(static_cast<int>(after.building->walls.size()) + after.warned("dangling", "IfcWall"),
                   static_cast<int>(before.building->walls.size()));
       }},
      {"FillingsUnlinked",
       [](Statements s) {
         s.remove({"IFCRELFILLSELEMENT"});
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         const int named = after.warned("door_without_wall") + after.warned("no_body", "IfcDoor");
         EXPECT_GE(after.doors() + named, before.doors());
       }},
      {"OpeningsUnlinked",
       [](Statements s) {
         s.remove({"IFCRELVOIDSELEMENT"});
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         ASSERT_TRUE(after.building) << after.refused;
         EXPECT_EQ(after.building->walls.size(), before.building->walls.size());
         const int named = after.warned("door_without_wall") + after.warned("no_body", "IfcDoor");
         EXPECT_GE(after.doors() + named, before.doors());
       }},
      {"NobodyOwnsIt",
       [](Statements s) {
         s.remove({"IFCOWNERHISTORY", "IFCPERSON", "IFCORGANIZATION"});
         return s.text();
       },
       [](const Outcome& before, const Outcome& after) {
         same_walls(before, after);
         EXPECT_EQ(after.building->hash(), before.building->hash());
       }},
  };
}

constexpr std::array<const char*, 5> files = {"duplex", "AC20-FZK-Haus", "IfcOpenHouse_IFC4", "LargeBuilding",
                                              "ManySimpleWalls"};

class Edited : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string name = std::string("ifc/") + GetParam() + ".ifc";
    if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
    text_ = read_text_file(data_path(name));
  }
  std::string text_;
};

TEST_P(Edited, ReadsWhatIsLeft) {
  const Outcome before = outcome_of(text_);
  ASSERT_TRUE(before.building) << before.refused;
  for (const Edit& edit : edits()) {
    SCOPED_TRACE(edit.name);
    edit.expect(before, outcome_of(edit.change(Statements(text_))));
  }
}

INSTANTIATE_TEST_SUITE_P(Foreign, Edited, testing::ValuesIn(files),
                         [](const testing::TestParamInfo<const char*>& info) { return test_name(info.param); });

}  // namespace
}  // namespace plumbline::bim
