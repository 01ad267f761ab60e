// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_parse.h"

#include <gtest/gtest.h>

#include "bim/formats/ifc/read/ifc.h"
#include "tests/bim/formats/ifc/fixture.h"

namespace plumbline::bim {
namespace {

TEST(SchemaForReader, IsTheNearestThatIsRead) {
  for (const char* schema : {"IFC2X3", "IFC2X2_FINAL", "IFC2X"}) EXPECT_EQ(schema_for_reader(schema), "IFC2X3");
  for (const char* schema : {"IFC4", "IFC4X1", "IFC4X3", "IFC4X3_ADD2"}) EXPECT_EQ(schema_for_reader(schema), "IFC4");
}

TEST(SchemaForReader, OtherSchemasAreReadWithAWarning) {
  const std::string text = small_ifc({});
  const Building plain = read_ifc_text(text, "small.ifc");
  for (const char* schema : {"IFC4X1", "IFC4X3", "IFC4X3_ADD2"}) {
    std::string other = text;
    other.replace(other.find("'IFC4'"), 6, std::string("'") + schema + "'");
    const Building building = read_ifc_text(other, "small.ifc");
    EXPECT_EQ(building.hash(), plain.hash()) << schema;
    EXPECT_EQ(building.schema, schema);
    int said = 0;
    for (const Warning& warning : building.warnings)
      said += warning.kind == "other_schema" && warning.text == std::string(schema) + " read as IFC4" ? 1 : 0;
    EXPECT_EQ(said, 1) << schema;
  }
  for (const Warning& warning : plain.warnings) EXPECT_NE(warning.kind, "other_schema");
}

TEST(Semicolons, MayStandApartFromWhatTheyEnd) {
  const std::string text = small_ifc({});
  const Building plain = read_ifc_text(text, "small.ifc");
  for (const char* gap : {" ", "\n", " /* ; */ "}) {
    std::string spaced = text;
    const std::string put = gap;
    for (std::size_t at = 0; (at = spaced.find(";\n", at)) != std::string::npos; at += put.size() + 1)
      spaced.insert(at, put);
    const Building building = read_ifc_text(spaced, "small.ifc");
    EXPECT_EQ(building.hash(), plain.hash()) << gap;
    EXPECT_EQ(building.warnings.size(), plain.warnings.size());
  }
}

TEST(Names, AreReadInEveryEncodingThatProgramsWrite) {
  const auto storey_named = [](const std::string& written) {
    std::string text = small_ifc({});
    text.replace(text.find("'ground'"), 8, "'" + written + "'");
    return read_ifc_text(text, "small.ifc").storeys.at(0).name;
  };
  EXPECT_EQ(storey_named("Erdgeschoß"), "Erdgeschoß");
  EXPECT_EQ(storey_named("Erdgescho\xDF"), "Erdgeschoß");
  EXPECT_EQ(storey_named("Erdgescho\\X2\\00DF\\X0\\"), "Erdgeschoß");
  EXPECT_EQ(storey_named("\\X2\\D83CDFE0\\X0\\"), "🏠");
}

TEST(Names, MayHoldWhatIsACommentOrAnEndElsewhere) {
  const std::string plain = small_ifc({});
  const Building expected = read_ifc_text(plain, "small.ifc");
  for (const char* name : {"North /* brick", "/*", "*/ x", "/**/", "//*/", "it''s /* so", "''", "''''/*", "a;b",
                           "#7=IFCWALL();", "(,", "ENDSEC;", "Mur /*ä"}) {
    std::string text = plain;
    text.replace(text.find("'ground'"), 8, std::string("'") + name + "'");
    // A real comment behind the name would end a false one in it.
    text.insert(text.find("#50="), "/* it's a 'comment'\n*/");
    const Building building = read_ifc_text(text, "small.ifc");
    EXPECT_EQ(building.walls.size(), expected.walls.size()) << name;
    EXPECT_EQ(building.openings.size(), expected.openings.size()) << name;
    std::string meant = name;
    for (std::size_t at = 0; (at = meant.find("''", at)) != std::string::npos; ++at) meant.erase(at, 1);
    EXPECT_EQ(building.storeys.at(0).name, meant);
  }
}

TEST(GlobalIds, MayHoldWhatIsACommentElsewhere) {
  std::string text = small_ifc({});
  text.replace(text.find("'0000000000000000000006'"), 24, "'8S->gp2th5t|/*qOAt0@'");
  const Building building = read_ifc_text(text, "small.ifc");
  ASSERT_EQ(building.walls.size(), 1u);
  EXPECT_EQ(building.walls.front().id, "8S->gp2th5t|/*qOAt0@");
}

TEST(Names, WithEscapesBehindEachOtherAreDecoded) {
  const auto storey_named = [](const std::string& written) {
    std::string text = small_ifc({});
    text.replace(text.find("'ground'"), 8, "'" + written + "'");
    return read_ifc_text(text, "small.ifc").storeys.at(0).name;
  };
  EXPECT_EQ(storey_named("P\\S\\D\\S\\DPISTE"), "PÄÄPISTE");
  EXPECT_EQ(storey_named("\\X\\C4\\S\\D\\X\\D6\\S\\*"), "ÄÄÖª");
  EXPECT_EQ(storey_named("\\S\\d\\X2\\00DF\\X0\\x"), "äßx");
  EXPECT_EQ(storey_named("\\S\\''4"), "§4");
  EXPECT_EQ(storey_named("\\S\\\\\\S\\a"), "Üá");
  EXPECT_EQ(storey_named("C:\\\\Users\\\\x.ifc"), "C:\\Users\\x.ifc");
  EXPECT_EQ(storey_named("C:\\\\S\\\\D\\\\X\\\\41"), "C:\\S\\D\\X\\41");
  EXPECT_EQ(storey_named("\\\\X2\\\\00DF"), "\\X2\\00DF");
}

TEST(Names, MayBePathsWithSingleBackslashes) {
  const auto storey_named = [](const std::string& written) {
    std::string text = small_ifc({});
    text.replace(text.find("'ground'"), 8, "'" + written + "'");
    return read_ifc_text(text, "small.ifc").storeys.at(0).name;
  };
  for (const char* path : {"C:\\Users\\Sam\\x.ifc", "D:\\Plan\\Xaver\\Site.ifc", "a\\", "C:\\S"})
    EXPECT_EQ(storey_named(path), path);
}

}  // namespace
}  // namespace plumbline::bim
