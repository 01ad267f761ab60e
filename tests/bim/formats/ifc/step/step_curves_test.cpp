// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

/// A file with the prism of 1 m over the area that the curves enclose, each begun where the one before ends.
std::string prism_text(Sketch& sketch, const std::vector<std::string>& curves) {
  std::string segments;
  for (const std::string& curve : curves)
    segments += (segments.empty() ? "" : ",") + sketch.add("IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.," + curve + ")");
  const std::string outline = sketch.add("IFCCOMPOSITECURVE((" + segments + "),.F.)");
  const std::string profile = sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + outline + ")");
  sketch.element("IFCCOLUMN", sketch.shape(sketch.extruded(profile, 0, 1)), "$,$");
  return sketch.text();
}

StepBody prism_of(Sketch& sketch, const std::vector<std::string>& curves) {
  return body_in(prism_text(sketch, curves));
}

std::string line_through(Sketch& sketch, const std::vector<Eigen::Vector2d>& line) {
  std::string points;
  for (const Eigen::Vector2d& p : line) points += (points.empty() ? "" : ",") + sketch.point(p.x(), p.y());
  return sketch.add("IFCPOLYLINE((" + points + "))");
}

std::string at_origin(Sketch& sketch) { return sketch.add("IFCAXIS2PLACEMENT2D(" + sketch.point(0, 0) + ",$)"); }

/// The text with angles in degrees.
std::string in_degrees(std::string text) {
  const std::string old = "IFCUNITASSIGNMENT((";
  text.insert(text.find(old) + old.size(), "#9001,");
  text.insert(text.find("ENDSEC;\nEND-ISO"),
              "#9001=IFCCONVERSIONBASEDUNIT(#9004,.PLANEANGLEUNIT.,'DEGREE',#9002);\n"
              "#9002=IFCMEASUREWITHUNIT(IFCPLANEANGLEMEASURE(0.0174532925199433),#9003);\n"
              "#9003=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n#9004=IFCDIMENSIONALEXPONENTS(0,0,0,0,0,0,0);\n");
  return text;
}

TEST(TrimmedCurves, OfEllipsesByParametersAreArcs) {
  const double truth = std::numbers::pi * 2.0 * 1.0 / 4.0;
  for (const bool degrees : {false, true}) {
    Sketch sketch;
    const std::string ellipse = sketch.add("IFCELLIPSE(" + at_origin(sketch) + ",2.,1.)");
    const std::string end = degrees ? "90." : "1.5707963267948966";
    const std::string arc = sketch.add("IFCTRIMMEDCURVE(" + ellipse + ",(IFCPARAMETERVALUE(0.)),(IFCPARAMETERVALUE(" +
                                       end + ")),.T.,.PARAMETER.)");
    const std::string text = prism_text(sketch, {arc, line_through(sketch, {{0, 1}, {0, 0}, {2, 0}})});
    const StepBody body = body_in(degrees ? in_degrees(text) : text);
    EXPECT_TRUE(body.closed());
    EXPECT_NEAR(body.volume_m3() / truth, 1.0, 0.01) << degrees;
  }
}

TEST(TrimmedCurves, OfLinesByParametersCountInTheirVectors) {
  Sketch sketch;
  const std::string vector = sketch.add("IFCVECTOR(" + sketch.add("IFCDIRECTION((2.,0.))") + ",3.)");
  const std::string line = sketch.add("IFCLINE(" + sketch.point(1, 0) + "," + vector + ")");
  const std::string cut =
      sketch.add("IFCTRIMMEDCURVE(" + line + ",(IFCPARAMETERVALUE(1.)),(IFCPARAMETERVALUE(2.)),.T.,.PARAMETER.)");
  std::string text = prism_text(sketch, {cut, line_through(sketch, {{7, 2}, {4, 2}})});
  EXPECT_TRUE(body_in(text).closed());
  EXPECT_NEAR(body_in(text).volume_m3(), 6.0, 1e-6);
  const std::string metre = ".LENGTHUNIT.,$";
  text.replace(text.find(metre), metre.size(), ".LENGTHUNIT.,.DECI.");
  EXPECT_NEAR(body_in(text).volume_m3(), 6e-3, 1e-6);
}

/// Furthest that a face of a prism about the z axis lies inside the circle through its corners.
double furthest_inside(const StepBody& body, double radius_m) {
  double inside = 0.0;
  for (const Solid& solid : body.solids)
    for (const Eigen::Vector3i& t : solid.triangles)
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d& p = solid.vertices[static_cast<std::size_t>(t[k])];
        const Eigen::Vector3d& q = solid.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
        const bool rim =
            std::abs(p.head<2>().norm() - radius_m) < 1e-6 && std::abs(q.head<2>().norm() - radius_m) < 1e-6;
        const double angle = std::atan2(p.x() * q.y() - p.y() * q.x(), p.head<2>().dot(q.head<2>()));
        if (rim && std::abs(p.z() - q.z()) < 1e-6 && std::abs(angle) < 0.5)
          inside = std::max(inside, radius_m - 0.5 * (p + q).head<2>().norm());
      }
  return inside;
}

constexpr double most_inside_m = 2e-3;

TEST(Arcs, LargeOnesAreCutByTheirDepth) {
  constexpr double r = 8.0, half = 0.7071067811865476 * r;
  for (const char* kind : {"points", "parameters", "indices"}) {
    Sketch sketch;
    const std::string way = kind, circle = sketch.add("IFCCIRCLE(" + at_origin(sketch) + ",8.)");
    std::string arc;
    if (way == "indices") {
      const std::string list =
          sketch.add("IFCCARTESIANPOINTLIST2D(((8.,0.),(" + Sketch::n(half) + "," + Sketch::n(half) + "),(0.,8.)),$)");
      arc = sketch.add("IFCINDEXEDPOLYCURVE(" + list + ",(IFCARCINDEX((1,2,3))),.F.)");
    } else {
      const bool points = way == "points";
      const std::string from = points ? sketch.point(r, 0) : "IFCPARAMETERVALUE(0.)";
      const std::string to = points ? sketch.point(0, r) : "IFCPARAMETERVALUE(1.5707963267948966)";
      arc = sketch.add("IFCTRIMMEDCURVE(" + circle + ",(" + from + "),(" + to + "),.T.," +
                       (points ? ".CARTESIAN.)" : ".PARAMETER.)"));
    }
    const StepBody body = prism_of(sketch, {arc, line_through(sketch, {{0, r}, {0, 0}, {r, 0}})});
    EXPECT_TRUE(body.closed()) << kind;
    EXPECT_GT(furthest_inside(body, r), 1e-4) << kind;
    EXPECT_LT(furthest_inside(body, r), most_inside_m) << kind;
  }
}

TEST(Arcs, LargeCirclesAreCutByTheirDepthInEveryUnit) {
  for (const bool milli : {false, true}) {
    Sketch sketch;
    const double scale = milli ? 1e3 : 1.0;
    const std::string profile =
        sketch.add("IFCCIRCLEPROFILEDEF(.AREA.,$," + at_origin(sketch) + "," + Sketch::n(8.0 * scale) + ")");
    sketch.element("IFCCOLUMN", sketch.shape(sketch.extruded(profile, 0, scale)), "$,$");
    std::string text = sketch.text();
    const std::string metre = ".LENGTHUNIT.,$";
    if (milli) text.replace(text.find(metre), metre.size(), ".LENGTHUNIT.,.MILLI.");
    const StepBody body = body_in(text);
    EXPECT_TRUE(body.closed());
    EXPECT_GT(furthest_inside(body, 8.0), 1e-4);
    EXPECT_LT(furthest_inside(body, 8.0), most_inside_m);
  }
}

TEST(Arcs, RevolvedAreasAreCutByTheirDepth) {
  Sketch sketch;
  const std::string at = sketch.add("IFCAXIS2PLACEMENT2D(" + sketch.point(7.9, 0.5) + ",$)");
  const std::string profile = sketch.add("IFCRECTANGLEPROFILEDEF(.AREA.,$," + at + ",0.2,1.)");
  const std::string axis =
      sketch.add("IFCAXIS1PLACEMENT(" + sketch.point(0, 0, 0) + "," + sketch.add("IFCDIRECTION((0.,1.,0.))") + ")");
  // The profile's y axis is up.
  const std::string solid =
      sketch.add("IFCREVOLVEDAREASOLID(" + profile + "," + sketch.frame(0, 0, 0, "0.,-1.,0.", "1.,0.,0.") + "," + axis +
                 ",1.5707963267948966)");
  const StepBody body = body_of(sketch, solid);
  EXPECT_TRUE(body.closed());
  EXPECT_GT(furthest_inside(body, 8.0), 1e-4);
  EXPECT_LT(furthest_inside(body, 8.0), most_inside_m);
}

TEST(Arcs, OfAnyRadiusHaveABoundedNumberOfPieces) {
  Sketch sketch;
  const std::string profile = sketch.add("IFCCIRCLEPROFILEDEF(.AREA.,$," + at_origin(sketch) + ",4000.)");
  const StepBody body = body_of(sketch, sketch.extruded(profile, 0, 1));
  ASSERT_EQ(body.solids.size(), 1U);
  EXPECT_EQ(body.solids[0].vertices.size(), 2 * 720U);
}

/// A column of 1 m^2 in a file whose other column is bounded by the curve.
StepModel beside_a_column(Sketch& sketch, const std::string& curve) {
  sketch.element("IFCCOLUMN", sketch.shape(sketch.box(0, 0, 0, 1, 1, 1)), "$,$");
  return read_model(prism_text(sketch, {curve, line_through(sketch, {{0, 1}, {0, 0}, {1, 0}})}));
}

TEST(Arcs, WithoutFinitePointsSpoilTheirElementAlone) {
  for (const char* kind : {"indices", "ellipse", "circle", "line"}) {
    Sketch sketch;
    const std::string way = kind, trims = ",(IFCPARAMETERVALUE(0.)),(IFCPARAMETERVALUE(2.)),.T.,.PARAMETER.)";
    std::string curve;
    if (way == "indices") {
      const std::string list = sketch.add("IFCCARTESIANPOINTLIST2D(((1.E100,0.),(1.E100,1.E100),(0.,1.E100)),$)");
      curve = sketch.add("IFCINDEXEDPOLYCURVE(" + list + ",(IFCARCINDEX((1,2,3))),.F.)");
    } else if (way == "line") {
      const std::string vector = sketch.add("IFCVECTOR(" + sketch.add("IFCDIRECTION((1.,0.))") + ",1.E308)");
      curve = sketch.add("IFCTRIMMEDCURVE(" + sketch.add("IFCLINE(" + sketch.point(1, 0) + "," + vector + ")") + trims);
    } else {
      const std::string at =
          sketch.add("IFCAXIS2PLACEMENT2D(" + sketch.add("IFCCARTESIANPOINT((1.E308,1.E308))") + ",$)");
      const std::string size =
          way == "circle" ? "IFCCIRCLE(" + at + ",1.E308)" : "IFCELLIPSE(" + at + ",1.E308,1.E308)";
      curve = sketch.add("IFCTRIMMEDCURVE(" + sketch.add(size) + trims);
    }
    const StepModel model = beside_a_column(sketch, curve);
    EXPECT_EQ(model.products.size() + static_cast<std::size_t>(model.out_of_reach), 2U) << kind;
    const auto whole = [](const StepProduct& product) {
      return product.diagnostics.empty() && product.body.size() == 1;
    };
    // IFC++ closes the outline without the line.
    EXPECT_EQ(std::count_if(model.products.begin(), model.products.end(), whole), way == "line" ? 2 : 1) << kind;
  }
}

TEST(Splines, LargeOnesAreCutByTheirDepth) {
  constexpr double r = 8.0;
  Sketch sketch;
  const std::string points = sketch.point(r, 0) + "," + sketch.point(r, r) + "," + sketch.point(0, r);
  const std::string quarter = sketch.add("IFCRATIONALBSPLINECURVEWITHKNOTS(2,(" + points +
                                         "),.CIRCULAR_ARC.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.,"
                                         "(1.,0.7071067811865476,1.))");
  const StepBody body = prism_of(sketch, {quarter, line_through(sketch, {{0, r}, {0, 0}, {r, 0}})});
  EXPECT_TRUE(body.closed());
  EXPECT_GT(furthest_inside(body, r), 1e-4);
  EXPECT_LT(furthest_inside(body, r), most_inside_m);
}

TEST(Splines, WithKnotsAreAsHighAsTheirControlPointsSay) {
  // Two spans of a cubic; its area and height are integrated from the basis functions.
  Sketch sketch;
  const std::string points = sketch.point(0, 0) + "," + sketch.point(0, 2) + "," + sketch.point(2, 3) + "," +
                             sketch.point(4, 2) + "," + sketch.point(4, 0);
  const std::string spline =
      sketch.add("IFCBSPLINECURVEWITHKNOTS(3,(" + points + "),.UNSPECIFIED.,.F.,.F.,(4,1,4),(0.,1.,2.),.UNSPECIFIED.)");
  const StepBody body = prism_of(sketch, {spline, line_through(sketch, {{4, 0}, {0, 0}})});
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3() / 8.3000, 1.0, 0.01);
  EXPECT_NEAR(body.box().max().y(), 2.50, 0.01);
}

TEST(Splines, OfBezierPiecesAreRead) {
  Sketch sketch;
  sketch.schema = "IFC2X3";
  const std::string points =
      sketch.point(0, 0) + "," + sketch.point(1, 2) + "," + sketch.point(2, 2) + "," + sketch.point(3, 0);
  const std::string arch = sketch.add("IFCBEZIERCURVE(3,(" + points + "),.UNSPECIFIED.,.F.,.F.)");
  EXPECT_NEAR(prism_of(sketch, {arch, line_through(sketch, {{3, 0}, {0, 0}})}).volume_m3(), 3.0, 0.04);
}

TEST(Splines, RationalOnesAreCircles) {
  Sketch sketch;
  const std::string points = sketch.point(1, 0) + "," + sketch.point(1, 1) + "," + sketch.point(0, 1) + "," +
                             sketch.point(-1, 1) + "," + sketch.point(-1, 0);
  const std::string half = sketch.add("IFCRATIONALBSPLINECURVEWITHKNOTS(2,(" + points +
                                      "),.CIRCULAR_ARC.,.F.,.F.,(3,2,3),(0.,1.,2.),.UNSPECIFIED.,"
                                      "(1.,0.7071067811865476,1.,0.7071067811865476,1.))");
  const StepBody body = prism_of(sketch, {half, line_through(sketch, {{-1, 0}, {1, 0}})});
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3() / (std::numbers::pi / 2.0), 1.0, 0.01);
}

}  // namespace
}  // namespace plumbline::bim
