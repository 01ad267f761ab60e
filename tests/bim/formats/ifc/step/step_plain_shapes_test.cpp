// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_plain_shapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

std::string direction(Sketch& sketch, const std::string& ratios) {
  return ratios == "$" ? ratios : sketch.add("IFCDIRECTION((" + ratios + "))");
}

/// Middle of a box from (1, 0, 0) to (3, 1, 0.5), mapped by an operator with the axes given.
Eigen::Vector3d mapped(const std::string& axis1, const std::string& axis2, const std::string& axis3,
                       const std::string& scale = "$") {
  Sketch sketch;
  const std::string box = sketch.box(1, 0, 0, 3, 1, 0.5);
  const std::string context = sketch.add("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,$,$)");
  const std::string shape = sketch.add("IFCSHAPEREPRESENTATION(" + context + ",'Body','SweptSolid',(" + box + "))");
  const std::string map = sketch.add("IFCREPRESENTATIONMAP(" + sketch.frame(0, 0, 0) + "," + shape + ")");
  const std::string axes = direction(sketch, axis1) + "," + direction(sketch, axis2) + ",";
  const std::string target = sketch.add("IFCCARTESIANTRANSFORMATIONOPERATOR3D(" + axes + sketch.point(10, 0, 0) + "," +
                                        scale + "," + direction(sketch, axis3) + ")");
  const StepBody body = body_of(sketch, sketch.add("IFCMAPPEDITEM(" + map + "," + target + ")"));
  EXPECT_TRUE(body.closed());
  return body.middle();
}

TEST(MappedItems, AreTurnedThoughAnAxisIsLeftOut) {
  using V = Eigen::Vector3d;
  EXPECT_NEAR((mapped("$", "$", "$") - V(12, 0.5, 0.25)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mapped("0.,1.,0.", "-1.,0.,0.", "$") - V(9.5, 2, 0.25)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mapped("0.,1.,0.", "$", "$") - V(9.5, 2, 0.25)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mapped("0.,2.,0.", "1.,0.,0.", "$") - V(10.5, 2, 0.25)).norm(), 0.0, 1e-6) << "mirrored";
  EXPECT_NEAR((mapped("$", "$", "0.,1.,0.") - V(12, 0.25, -0.5)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mapped("1.,0.,0.", "$", "0.,0.,-1.") - V(12, -0.5, -0.25)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mapped("0.,1.,0.", "$", "$", "2.") - V(9, 4, 0.5)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((mapped("0.,1.,0.", "-1.,0.,0.", "0.,0.,1.") - V(9.5, 2, 0.25)).norm(), 0.0, 1e-6) << "all given";
}

TEST(Extrusions, AreAsDeepAsTheySayWhateverTheirDirectionsLength) {
  for (const char* ratios : {"0.,0.,1.", "0.,0.,2.", "0.,0.,0.001"}) {
    Sketch sketch;
    const std::string profile = sketch.add("IFCRECTANGLEPROFILEDEF(.AREA.,$,$,2.,1.)");
    const StepBody body = body_of(sketch, sketch.add("IFCEXTRUDEDAREASOLID(" + profile + "," + sketch.frame(0, 0, 0) +
                                                     "," + direction(sketch, ratios) + ",3.)"));
    EXPECT_NEAR(body.volume_m3(), 6.0, 1e-6) << ratios;
  }
  Sketch sketch;
  const std::string profile = sketch.add("IFCRECTANGLEPROFILEDEF(.AREA.,$,$,2.,1.)");
  const StepBody body = body_of(sketch, sketch.add("IFCEXTRUDEDAREASOLID(" + profile + "," + sketch.frame(0, 0, 0) +
                                                   "," + direction(sketch, "0.,3.,4.") + ",5.)"));
  EXPECT_NEAR(body.box().max().z(), 4.0, 1e-6);
  EXPECT_NEAR(body.box().max().y(), 3.5, 1e-6);
}

/// Volume between two similar outlines, whose sides are scaled by a share from start to end.
double frustum(double area, double share, double height) { return area * height * (1.0 + share + share * share) / 3.0; }

/// Tapered to half its size over 3 m along x from (5, 0, 1).
StepBody tapered(const std::function<std::string(Sketch&, double scale)>& profile, const std::string& along) {
  Sketch sketch;
  const std::string start = profile(sketch, 1.0), end = profile(sketch, 0.5);
  return body_of(
      sketch, sketch.add("IFCEXTRUDEDAREASOLIDTAPERED(" + start + "," + sketch.frame(5, 0, 1, "1.,0.,0.", "0.,1.,0.") +
                         "," + direction(sketch, along) + ",3.," + end + ")"));
}

TEST(Extrusions, TaperedOnesAreAsThickAtTheirEndAsTheySay) {
  const auto rectangle = [](Sketch& sketch, double scale) {
    return sketch.add("IFCRECTANGLEPROFILEDEF(.AREA.,$,$," + Sketch::n(2 * scale) + "," + Sketch::n(scale) + ")");
  };
  const auto derived = [&](Sketch& sketch, double scale) {
    const std::string whole = rectangle(sketch, 1.0);
    if (scale == 1.0) return whole;
    const std::string mapped =
        sketch.add("IFCCARTESIANTRANSFORMATIONOPERATOR2D($,$," + sketch.point(0, 0) + "," + Sketch::n(scale) + ")");
    return sketch.add("IFCDERIVEDPROFILEDEF(.AREA.,$," + whole + "," + mapped + ",$)");
  };
  const auto drawn = [](Sketch& sketch, double scale) {
    return sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," +
                      sketch.polyline({{0, 0}, {0, scale}, {2 * scale, scale}, {2 * scale, 0}}) + ")");
  };
  const auto i_shape = [](Sketch& sketch, double scale) {
    return sketch.add("IFCISHAPEPROFILEDEF(.AREA.,$,$," + Sketch::n(0.4 * scale) + "," + Sketch::n(0.6 * scale) + "," +
                      Sketch::n(0.02 * scale) + "," + Sketch::n(0.03 * scale) + ",$,$,$)");
  };
  for (const char* along : {"0.,0.,1.", "0.,0.,2."})
    for (const auto& profile :
         {std::function<std::string(Sketch&, double)>(rectangle), std::function<std::string(Sketch&, double)>(derived),
          std::function<std::string(Sketch&, double)>(drawn)}) {
      const StepBody body = tapered(profile, along);
      EXPECT_TRUE(body.closed());
      EXPECT_NEAR(body.volume_m3(), frustum(2.0, 0.5, 3.0), 1e-5);
      EXPECT_NEAR(body.box().min().x(), 5.0, 1e-6);
      EXPECT_NEAR(body.box().max().x(), 8.0, 1e-6);
    }
  EXPECT_NEAR(tapered(i_shape, "0.,0.,1.").volume_m3(), frustum(2 * 0.4 * 0.03 + 0.54 * 0.02, 0.5, 3.0), 1e-5);
  EXPECT_NEAR(tapered(rectangle, "0.,0.,-1.").box().min().x(), 2.0, 1e-6);
  EXPECT_NEAR(tapered(rectangle, "0.,0.,-1.").volume_m3(), frustum(2.0, 0.5, 3.0), 1e-5);
}

TEST(Primitives, BlocksAndPyramidsStandWithACornerAtTheirPlace) {
  for (const char* schema : {"IFC4", "IFC2X3"}) {
    Sketch sketch;
    sketch.schema = schema;
    const StepBody block = body_of(sketch, sketch.add("IFCBLOCK(" + sketch.frame(1, 2, 3) + ",2.,1.,4.)"));
    EXPECT_NEAR((block.box().min() - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-6) << schema;
    EXPECT_NEAR((block.box().max() - Eigen::Vector3d(3, 3, 7)).norm(), 0.0, 1e-6) << schema;
    Sketch other;
    other.schema = schema;
    const StepBody pyramid = body_of(other, other.add("IFCRECTANGULARPYRAMID(" + other.frame(1, 2, 3) + ",2.,1.,3.)"));
    EXPECT_NEAR((pyramid.box().min() - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-6) << schema;
    EXPECT_NEAR((pyramid.box().max() - Eigen::Vector3d(3, 3, 6)).norm(), 0.0, 1e-6) << schema;
    EXPECT_NEAR(pyramid.volume_m3(), 2.0, 1e-6);
  }
  Sketch turned;
  const std::string place = turned.add("IFCAXIS2PLACEMENT3D(" + turned.point(1, 0, 0) + "," +
                                       direction(turned, "0.,0.,2.") + "," + direction(turned, "0.,1.,0.") + ")");
  const std::string block = turned.add("IFCBLOCK(" + place + ",2.,1.,4.)");
  const StepBody body = body_of(turned, turned.add("IFCCSGSOLID(" + block + ")"));
  EXPECT_NEAR((body.middle() - Eigen::Vector3d(0.5, 1, 2)).norm(), 0.0, 1e-6);
  EXPECT_NEAR(body.volume_m3(), 8.0, 1e-6);
}

TEST(Primitives, SpheresAreInTheUnitOfTheFile) {
  Sketch sketch;
  sketch.element("IFCCOLUMN", sketch.shape(sketch.add("IFCSPHERE(" + sketch.frame(0, 0, 0) + ",300.)")), "$,$");
  std::string text = sketch.text();
  const std::string metres = ".LENGTHUNIT.,$,";
  text.replace(text.find(metres), metres.size(), ".LENGTHUNIT.,.MILLI.,");
  const StepBody body = body_in(text);
  EXPECT_NEAR(body.box().sizes().z(), 0.6, 1e-6);
}

TEST(Profiles, MirroredOnesAreMirrored) {
  Sketch sketch;
  const std::string outline = sketch.polyline({{1, 0}, {4, 0}, {4, 2}});
  const std::string profile = sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + outline + ")");
  const StepBody body =
      body_of(sketch, sketch.extruded(sketch.add("IFCMIRROREDPROFILEDEF(.AREA.,$," + profile + ",*,$)"), 0, 2));
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), 6.0, 1e-6);
  EXPECT_NEAR((body.middle() - Eigen::Vector3d(-3, 2.0 / 3.0, 1)).norm(), 0.0, 1e-6);
}

TEST(Profiles, DerivedOnesAreTurnedThoughAnAxisIsLeftOut) {
  Sketch sketch;
  const std::string profile =
      sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + sketch.polyline({{1, 0}, {4, 0}, {4, 2}}) + ")");
  const std::string turn = sketch.add("IFCCARTESIANTRANSFORMATIONOPERATOR2D(" + direction(sketch, "0.,1.") + ",$," +
                                      sketch.point(0, 0) + ",$)");
  const StepBody body = body_of(
      sketch, sketch.extruded(sketch.add("IFCDERIVEDPROFILEDEF(.AREA.,$," + profile + "," + turn + ",$)"), 0, 2));
  EXPECT_NEAR((body.middle() - Eigen::Vector3d(-2.0 / 3.0, 3, 1)).norm(), 0.0, 1e-6);
}

TEST(Profiles, GirdersWithUnequalFlangesNeedNoRadii) {
  // 0.4 x 0.05 below, 0.2 wide above, a web of 0.02 between, 0.5 high.
  for (const auto& [top, thickness] : {std::pair("$", 0.05), std::pair("0.04", 0.04)}) {
    Sketch sketch;
    const std::string profile = sketch.add("IFCASYMMETRICISHAPEPROFILEDEF(.AREA.,$,$,0.4,0.5,0.02,0.05,$,0.2," +
                                           std::string(top) + ",$,$,$,$,$)");
    const StepBody body = body_of(sketch, sketch.extruded(profile, 0, 3));
    EXPECT_TRUE(body.closed());
    EXPECT_NEAR(body.volume_m3(), (0.4 * 0.05 + 0.2 * thickness + 0.02 * (0.45 - thickness)) * 3, 1e-6);
    EXPECT_NEAR(body.box().min().y(), -0.25, 1e-6);
  }
  Sketch old;
  old.schema = "IFC2X3";
  const std::string place = old.add("IFCAXIS2PLACEMENT2D(" + old.point(1, 0) + ",$)");
  const std::string profile =
      old.add("IFCASYMMETRICISHAPEPROFILEDEF(.AREA.,$," + place + ",0.4,0.5,0.02,0.05,$,0.2,0.05,$,$)");
  const StepBody body = body_of(old, old.extruded(profile, 0, 3));
  EXPECT_NEAR(body.volume_m3(), (0.6 * 0.05 + 0.02 * 0.4) * 3, 1e-6);
  EXPECT_NEAR(body.middle().x(), 1.0, 1e-6);
}

TEST(Profiles, PartsOfACompositeStandBesideEachOther) {
  Sketch sketch;
  const auto rectangle = [&](double x, double width) {
    const std::string place = sketch.add("IFCAXIS2PLACEMENT2D(" + sketch.point(x, 0) + ",$)");
    return sketch.add("IFCRECTANGLEPROFILEDEF(.AREA.,$," + place + "," + Sketch::n(width) + ",1.)");
  };
  const std::string inner =
      sketch.add("IFCCOMPOSITEPROFILEDEF(.AREA.,$,(" + rectangle(5, 1) + "," + rectangle(10, 3) + "),$)");
  const std::string profile = sketch.add("IFCCOMPOSITEPROFILEDEF(.AREA.,$,(" + rectangle(0, 2) + "," + inner + "),$)");
  const StepBody body = body_of(sketch, sketch.extruded(profile, 0, 2));
  EXPECT_EQ(body.solids.size(), 3u);
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), 12.0, 1e-6);
  EXPECT_NEAR(body.box().max().x(), 11.5, 1e-6);
}

TEST(Blocks, ThatReachBeyondAllNumbersAreLeftOutAlone) {
  Sketch sketch;
  sketch.element("IFCCOLUMN", sketch.shape(sketch.box(0, 0, 0, 1, 1, 1)), "$,$");
  const std::string at =
      sketch.add("IFCAXIS2PLACEMENT3D(" + sketch.add("IFCCARTESIANPOINT((1.7E308,0.,0.))") + ",$,$)");
  sketch.element("IFCCOLUMN", sketch.shape(sketch.add("IFCBLOCK(" + at + ",1.7E308,1.,1.)")), "$,$");
  const StepModel model = read_model(sketch.text());
  EXPECT_EQ(model.products.size() + static_cast<std::size_t>(model.out_of_reach), 2U);
  ASSERT_FALSE(model.products.empty());
  EXPECT_EQ(model.products[0].body.size(), 1U);
  EXPECT_TRUE(model.products[0].diagnostics.empty());
}

}  // namespace
}  // namespace plumbline::bim
