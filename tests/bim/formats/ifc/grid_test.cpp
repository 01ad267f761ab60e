// SPDX-License-Identifier: Apache-2.0
// Placements on grids and alignments: read where they can be, left out with a warning where not.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "bim/formats/ifc/read/ifc.h"
#include "tests/bim/formats/ifc/fixture.h"

namespace plumbline::bim {
namespace {

/// The fixture with a column of 0.4 x 0.4 x 3 on #300; the grid stands at (10, 20, 1), turned by 90 degrees. Its axes
/// are 1 (along its x, through y = 2), A (against its y, through x = 3) and one parallel to the first.
std::string with_column(const std::string& placement, const std::string& schema = "IFC4") {
  std::string text = small_ifc({});
  const std::string more =
      "#220=IFCGRID('0000000000000000000030',$,'grid',$,$,#221,$,(#230,#232),(#231),$,$);\n"
      "#221=IFCLOCALPLACEMENT(#31,#222);\n#222=IFCAXIS2PLACEMENT3D(#223,$,#224);\n"
      "#223=IFCCARTESIANPOINT((10.,20.,1.));\n#224=IFCDIRECTION((0.,1.,0.));\n"
      "#230=IFCGRIDAXIS('1',#240,.T.);\n#231=IFCGRIDAXIS('A',#243,.F.);\n#232=IFCGRIDAXIS('2',#246,.T.);\n"
      "#233=IFCGRIDAXIS('round',#252,.T.);\n"
      "#240=IFCPOLYLINE((#241,#242));\n#241=IFCCARTESIANPOINT((0.,2.));\n#242=IFCCARTESIANPOINT((9.,2.));\n"
      "#243=IFCLINE(#244,#245);\n#244=IFCCARTESIANPOINT((3.,0.));\n#245=IFCVECTOR(#249,1.);\n"
      "#249=IFCDIRECTION((0.,1.));\n"
      "#246=IFCPOLYLINE((#247,#248));\n#247=IFCCARTESIANPOINT((0.,5.));\n#248=IFCCARTESIANPOINT((9.,5.));\n"
      "#252=IFCCIRCLE(#253,4.);\n#253=IFCAXIS2PLACEMENT2D(#241,$);\n"
      "#260=IFCCOLUMN('0000000000000000000031',$,'column',$,$,#300,#261,$,$);\n"
      "#261=IFCPRODUCTDEFINITIONSHAPE($,$,(#262));\n"
      "#262=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#263));\n#263=IFCEXTRUDEDAREASOLID(#264,#11,#66,3.);\n"
      "#264=IFCRECTANGLEPROFILEDEF(.AREA.,$,#265,0.6,0.4);\n#265=IFCAXIS2PLACEMENT2D(#266,$);\n"
      "#266=IFCCARTESIANPOINT((0.,0.));\n"
      "#267=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000032',$,$,$,(#260,#220),#30);\n" +
      placement;
  text.insert(text.rfind("ENDSEC;"), more);
  return text.replace(text.find("'IFC4'"), 6, "'" + schema + "'");
}

/// Centre of the column's footprint, its lower end, and the direction of its long side.
struct Stand {
  Eigen::Vector3d at;
  Eigen::Vector2d size;
};
Stand stand(const std::string& text) {
  const Building building = read_ifc_text(text, "grid.ifc");
  EXPECT_EQ(building.columns.size(), 1u);
  Eigen::AlignedBox2d box;
  for (const Column& column : building.columns)
    for (const Eigen::Vector2d& p : column.footprint) box.extend(p);
  for (const Warning& warning : building.warnings) EXPECT_NE(warning.kind, "skipped_placement") << warning.text;
  const double z0_m = building.columns.empty() ? 0.0 : building.columns.front().z0_m;
  return {{box.center().x(), box.center().y(), z0_m}, box.sizes()};
}

void expect_at(const Stand& stand, double x, double y, double z) {
  EXPECT_NEAR((stand.at - Eigen::Vector3d(x, y, z)).norm(), 0.0, 1e-6) << stand.at.transpose();
}

/// (3, 2) of the grid is (10 - 2, 20 + 3) of W.
TEST(GridPlacement, IsWhereTheAxesMeet) {
  const Stand plain =
      stand(with_column("#300=IFCGRIDPLACEMENT(#301,$);\n#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.,0.,0.));\n"));
  expect_at(plain, 8.0, 23.0, 1.0);
  EXPECT_NEAR(plain.size.x(), 0.4, 1e-6);  // x along the first axis, which is y of W
  EXPECT_NEAR(plain.size.y(), 0.6, 1e-6);
}

/// Left of axis 1 is +y of the grid; axis A runs against its line, so left of it is +x.
TEST(GridPlacement, OffsetsAreToTheLeftAndUp) {
  expect_at(stand(with_column("#300=IFCGRIDPLACEMENT(#301,$);\n"
                              "#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.5,0.25,0.75));\n")),
            10.0 - 2.5, 20.0 + 3.25, 1.75);
  expect_at(stand(with_column("#300=IFCGRIDPLACEMENT(#301,$);\n"
                              "#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.5,0.25));\n")),
            10.0 - 2.5, 20.0 + 3.25, 1.0);
}

TEST(GridPlacement, SecondIntersectionOrDirectionTurnsIt) {
  const std::string here = "#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.,0.,0.));\n";
  const Stand towards = stand(with_column("#300=IFCGRIDPLACEMENT(#301,#302);\n" + here +
                                          "#302=IFCVIRTUALGRIDINTERSECTION((#232,#231),(0.,0.,0.));\n"));
  expect_at(towards, 8.0, 23.0, 1.0);
  EXPECT_NEAR(towards.size.x(), 0.6, 1e-6);  // along y of the grid, which is -x of W
  const Stand along =
      stand(with_column("#300=IFCGRIDPLACEMENT(#301,#302);\n" + here + "#302=IFCDIRECTION((0.,2.,0.));\n"));
  EXPECT_NEAR(along.size.x(), 0.6, 1e-6);
}

TEST(GridPlacement, OthersMayStandOnIt) {
  expect_at(stand(with_column("#300=IFCLOCALPLACEMENT(#303,#304);\n#303=IFCGRIDPLACEMENT(#301,$);\n"
                              "#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.,0.,0.));\n"
                              "#304=IFCAXIS2PLACEMENT3D(#305,$,$);\n#305=IFCCARTESIANPOINT((1.,0.,0.));\n")),
            8.0, 24.0, 1.0);
}

TEST(GridPlacement, OfIfc4X3HasOneAttributeMore) {
  expect_at(stand(with_column("#300=IFCGRIDPLACEMENT(#221,#301,$);\n"
                              "#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.,0.,0.));\n",
                              "IFC4X3")),
            8.0, 23.0, 1.0);
}

TEST(LinearPlacement, StandsAtItsFallback) {
  const std::string fallback = "#304=IFCAXIS2PLACEMENT3D(#305,$,$);\n#305=IFCCARTESIANPOINT((1.,0.,0.));\n";
  expect_at(stand(with_column("#300=IFCLINEARPLACEMENT($,#305,#304);\n" + fallback, "IFC4X3")), 1.0, 0.0, 0.0);
  expect_at(stand(with_column("#300=IFCLINEARPLACEMENT(#221,#305,#304);\n" + fallback, "IFC4X3")), 10.0, 21.0, 1.0);
}

/// Everything but the column is read, and the warning names it.
void expect_skipped(const std::string& placement, const std::string& schema = "IFC4") {
  const Building building = read_ifc_text(with_column(placement, schema), "grid.ifc");
  EXPECT_EQ(building.walls.size(), 1u);
  EXPECT_EQ(building.openings.size(), 1u);
  EXPECT_TRUE(building.columns.empty());
  int said = 0;
  for (const Warning& warning : building.warnings)
    said += warning.kind == "skipped_placement" && warning.element == "0000000000000000000031" ? 1 : 0;
  EXPECT_EQ(said, 1) << placement;
}

TEST(GridPlacement, WithoutACrossingLeavesTheElementOut) {
  for (const char* crossing : {"#301=IFCVIRTUALGRIDINTERSECTION((#230,#232),(0.,0.,0.));\n",  // parallel
                               "#301=IFCVIRTUALGRIDINTERSECTION((#230,#233),(0.,0.,0.));\n",  // round
                               "#301=IFCVIRTUALGRIDINTERSECTION((#230),(0.,0.,0.));\n"})      // one axis
    expect_skipped(std::string("#300=IFCGRIDPLACEMENT(#301,$);\n") + crossing);
}

TEST(GridPlacement, OnItselfLeavesTheElementOut) {
  std::string text = with_column(
      "#300=IFCGRIDPLACEMENT(#301,$);\n"
      "#301=IFCVIRTUALGRIDINTERSECTION((#230,#231),(0.,0.,0.));\n");
  const std::string place = "'grid',$,$,#221";
  text.replace(text.find(place), place.size(), "'grid',$,$,#300");
  const Building building = read_ifc_text(text, "grid.ifc");
  EXPECT_EQ(building.walls.size(), 1u);
  EXPECT_TRUE(building.columns.empty());
}

TEST(LinearPlacement, WithoutFallbackLeavesTheElementOut) {
  expect_skipped("#300=IFCLINEARPLACEMENT($,#305,$);\n#305=IFCCARTESIANPOINT((1.,0.,0.));\n", "IFC4X3");
  expect_skipped(
      "#300=IFCLOCALPLACEMENT(#303,#304);\n#303=IFCLINEARPLACEMENT($,#305,$);\n"
      "#304=IFCAXIS2PLACEMENT3D(#305,$,$);\n#305=IFCCARTESIANPOINT((1.,0.,0.));\n",
      "IFC4X3_ADD2");
}

}  // namespace
}  // namespace plumbline::bim
