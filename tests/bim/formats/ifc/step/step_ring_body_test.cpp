// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_ring_body.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

std::string profile(Sketch& sketch, const Polygon2& outline) {
  return sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + sketch.polyline(outline) + ")");
}

StepBody half_turn_to(const Polygon2& end) {
  Sketch sketch;
  const std::string first = profile(sketch, {{0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}}), last = profile(sketch, end);
  const std::string axis =
      sketch.add("IFCAXIS1PLACEMENT(" + sketch.point(0, 0, 0) + "," + sketch.add("IFCDIRECTION((0.,1.,0.))") + ")");
  return body_of(sketch, sketch.add("IFCREVOLVEDAREASOLIDTAPERED(" + first + "," + sketch.frame(0, 0, 0) + "," + axis +
                                    ",3.14159265," + last + ")"));
}

TEST(TaperedRevolution, ChangesItsProfileOnTheWay) {
  const StepBody body = half_turn_to({{0.5, 0}, {0.8, 0}, {0.8, 0.5}, {0.5, 0.5}});
  EXPECT_TRUE(body.closed());
  // The profile's area times the radius of its middle is 0.375 - 0.3875 s + 0.12 s^2 - 0.01 s^3 after a share s.
  EXPECT_NEAR(body.volume_m3(), std::numbers::pi * 0.21875, 0.003);
  EXPECT_NEAR(body.box().max().x(), 1.0, 1e-6);
  EXPECT_NEAR(body.box().min().x(), -0.8, 0.003) << "a little before the end it is wider";
}

TEST(TaperedRevolution, OfProfilesThatDifferIsSaidToKeepItsFirst) {
  const StepBody body = half_turn_to({{0.5, 0}, {0.8, 0}, {0.5, 0.5}});
  EXPECT_TRUE(says(body, "keeps its first profile"));
}

/// A board of 0.2 by 1 m along a curve on the plane z = 0.
StepBody board_along(const std::string& parameters, const std::function<std::string(Sketch&)>& curve) {
  Sketch sketch;
  const std::string board = profile(sketch, {{-0.1, 0}, {0.1, 0}, {0.1, 1}, {-0.1, 1}});
  const std::string line = curve(sketch), plane = sketch.add("IFCPLANE(" + sketch.frame(0, 0, 0) + ")");
  return body_of(sketch, sketch.add("IFCSURFACECURVESWEPTAREASOLID(" + board + ",$," + line + "," + parameters + "," +
                                    plane + ")"));
}

std::string line_of(Sketch& sketch, int points) {
  std::string list = sketch.point(1, 1, 0) + "," + sketch.point(3, 1, 0);
  if (points > 2) list += "," + sketch.point(3, 4, 0);
  return sketch.add("IFCPOLYLINE((" + list + "))");
}

void expect_box(const StepBody& body, double volume_m3, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  ASSERT_EQ(body.solids.size(), 1u);
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), volume_m3, 1e-6);
  EXPECT_NEAR((body.box().min() - low).norm(), 0.0, 1e-6) << body.box().min().transpose();
  EXPECT_NEAR((body.box().max() - high).norm(), 0.0, 1e-6) << body.box().max().transpose();
}

TEST(SweepOnPlane, HasItsProfilesXAxisAlongTheNormal) {
  const auto straight = [](Sketch& sketch) { return line_of(sketch, 2); };
  const auto bent = [](Sketch& sketch) { return line_of(sketch, 3); };
  expect_box(board_along("$,$", straight), 0.4, {1, 0, -0.1}, {3, 1, 0.1});
  expect_box(board_along("0.,1.", straight), 0.4, {1, 0, -0.1}, {3, 1, 0.1});
  expect_box(board_along("$,$", bent), 1.2, {1, 0, -0.1}, {4, 4, 0.1});
  expect_box(board_along("0.,1.", bent), 0.4, {1, 0, -0.1}, {3, 1, 0.1});
}

TEST(SweepOnPlane, BeginsAndEndsAtParametersAndNotAtLengths) {
  const auto bent = [](Sketch& sketch) { return line_of(sketch, 3); };
  expect_box(board_along("IFCPARAMETERVALUE(0.),IFCPARAMETERVALUE(1.)", bent), 0.4, {1, 0, -0.1}, {3, 1, 0.1});
  for (const char* wrong : {"0.,3.", "1.,0.", "IFCNONNEGATIVELENGTHMEASURE(0.),IFCNONNEGATIVELENGTHMEASURE(1.)"}) {
    const StepBody body = board_along(wrong, bent);
    EXPECT_TRUE(body.solids.empty()) << wrong;
  }
}

TEST(SweepOnPlane, AlongACurveIsLeftOutByName) {
  const StepBody body =
      board_along("$,$", [](Sketch& sketch) { return sketch.add("IFCCIRCLE(" + sketch.frame(0, 0, 0) + ",3.)"); });
  EXPECT_TRUE(body.solids.empty());
  EXPECT_TRUE(says(body, "is left out"));
}

}  // namespace
}  // namespace plumbline::bim
