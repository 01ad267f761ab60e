// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_disk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

using Line = std::vector<Eigen::Vector3d>;

/// Of a regular polygon in a circle.
double area(double radius_m, int corners) {
  return 0.5 * corners * radius_m * radius_m * std::sin(2.0 * std::numbers::pi / corners);
}

std::string points(Sketch& sketch, const Line& line) {
  std::string list;
  for (const Eigen::Vector3d& p : line) list += (list.empty() ? "" : ",") + sketch.point(p.x(), p.y(), p.z());
  return sketch.add("IFCPOLYLINE((" + list + "))");
}

std::string disk(Sketch& sketch, const Line& line, const std::string& rest) {
  return sketch.add("IFCSWEPTDISKSOLID(" + points(sketch, line) + "," + rest + ")");
}

StepBody disk_along(const Line& line, const std::string& rest) {
  Sketch sketch;
  return body_of(sketch, disk(sketch, line, rest));
}

TEST(SweptDisk, StandsUpright) {
  const double full_m3 = 2.0 * area(0.2, 36);
  for (const char* parameters : {"0.2,$,$,$", "0.2,$,0.,1."}) {
    const StepBody body = disk_along({{1, 0, 0}, {1, 0, 2}}, parameters);
    EXPECT_TRUE(body.closed());
    EXPECT_NEAR(body.volume_m3(), full_m3, 1e-3 * full_m3);
    EXPECT_NEAR(body.volume_m3(), 2.0 * std::numbers::pi * 0.04, 0.01 * full_m3);
    EXPECT_NEAR(body.box().max().z(), 2.0, 1e-4);
    EXPECT_TRUE(body.problems.empty());
  }
  EXPECT_NEAR(disk_along({{1, 0, 0}, {1, 0, 0.5}, {1, 0, 2}}, "0.2,$,0.,2.").volume_m3(), full_m3, 1e-3 * full_m3);
  EXPECT_NEAR(disk_along({{1, 0, 2}, {1, 0, 0}}, "0.2,$,$,$").volume_m3(), full_m3, 1e-3 * full_m3) << "downward";
  const double short_m3 = 0.1 * area(0.2, 36);
  EXPECT_NEAR(disk_along({{1, 0, 0.1}, {1, 0, 0}}, "0.2,$,$,$").volume_m3(), short_m3, 1e-3 * short_m3);
}

TEST(SweptDisk, IsAPipeWithAnInnerRadius) {
  const StepBody body = disk_along({{0, 0, 0}, {0, 0, 2}}, "0.2,0.1,$,$");
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), 2.0 * (area(0.2, 36) - area(0.1, 36)), 1e-3);
}

TEST(SweptDisk, BendsAtTheTopOfAPost) {
  const StepBody body = disk_along({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}, "0.2,$,$,$");
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), 2.0 * area(0.2, 36), 1e-3) << "a mitre takes off inside what it adds outside";
  EXPECT_NEAR(body.box().max().z(), 1.2, 0.005);
}

TEST(SweptDisk, FollowsACompositeCurveUpward) {
  Sketch sketch;
  std::string segments;
  for (const Line& line : {Line{{0, 0, 0}, {0, 0, 1}}, Line{{0, 0, 1}, {0, 0, 3}}})
    segments += (segments.empty() ? "" : ",") +
                sketch.add("IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.," + points(sketch, line) + ")");
  const std::string curve = sketch.add("IFCCOMPOSITECURVE((" + segments + "),.F.)");
  const StepBody body = body_of(sketch, sketch.add("IFCSWEPTDISKSOLID(" + curve + ",0.2,$,$,$)"));
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), 3.0 * area(0.2, 36), 1e-3);
}

TEST(SweptDisk, ThatTurnsBackIsLeftOutOfWhatElseThereIs) {
  Sketch sketch;
  const std::string post = disk(sketch, {{0, 0, 0}, {0, 0, 1}}, "0.2,$,$,$"),
                    back = disk(sketch, {{0, 0, 0}, {0, 0, 1}, {0, 0, 0.5}}, "0.2,$,$,$");
  const StepBody body = body_of(sketch, post + "," + back);
  EXPECT_NEAR(body.volume_m3(), area(0.2, 36), 1e-3);
  EXPECT_TRUE(says(body, "IfcSweptDiskSolid gives no surface"));
}

TEST(SweptDisk, NeedsASizeAndALength) {
  const SweptDisk usual{0.1, 0.0, 12};
  EXPECT_FALSE(swept_disk({{0, 0, 0}, {0, 0, 1}}, usual).loops.empty());
  EXPECT_TRUE(swept_disk({{0, 0, 0}, {0, 0, 0}}, usual).loops.empty());
  EXPECT_TRUE(swept_disk({{0, 0, 0}, {0, 0, 1}}, {0.0, 0.0, 12}).loops.empty());
  EXPECT_TRUE(swept_disk({{0, 0, 0}, {0, 0, 1}}, {0.1, 0.2, 12}).loops.empty());
  Line fine;
  for (int i = 0; i < 30'000; ++i) fine.emplace_back(0.0, 0.0, 0.01 * i);
  EXPECT_TRUE(swept_disk(fine, {0.1, 0.0, 36}).loops.empty()) << "more than a million corners";
}

}  // namespace
}  // namespace plumbline::bim
