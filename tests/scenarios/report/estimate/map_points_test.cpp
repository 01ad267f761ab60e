// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/map_points.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/occurrences.h"

namespace plumbline::scenarios {
namespace {

MapBox square_box(double side) {
  MapBox box;
  box.add({0.0, 0.0});
  box.add({side, side});
  return box;
}

/// The strokes of the cells of one kind.
std::string strokes_with(const std::string& drawn, const std::string& ink) {
  const std::size_t path = drawn.find(ink);
  if (path == std::string::npos) return "";
  const std::size_t from = drawn.find(" d=\"", path) + 4;
  return drawn.substr(from, drawn.find('"', from) - from);
}

TEST(MapPoints, TellAWallFromAFloorUnderACeiling) {
  std::vector<Eigen::Vector3f> points;
  for (const float z : {0.0F, 2.6F}) points.emplace_back(1.0F, 1.02F, z);           // floor, ceiling
  for (const float z : {0.1F, 0.6F, 1.1F}) points.emplace_back(5.02F, 5.02F, z);    // a wall
  for (const float x : {7.02F, 7.07F, 7.12F}) points.emplace_back(x, 7.02F, 0.0F);  // three cells of floor
  const std::string drawn = draw_map_points(points, square_box(10.0), false);
  EXPECT_EQ(strokes_with(drawn, "var(--wall)"), "M100 -100h1");
  EXPECT_EQ(strokes_with(drawn, "var(--thing)"), "M20 -20h1M140 -140h3");
  EXPECT_NE(drawn.find("scale(0.05)"), std::string::npos);
}

TEST(MapPoints, OverAPlanAreWhatIsUpright) {
  std::vector<Eigen::Vector3f> points = {{1.0F, 1.0F, 0.0F}};
  for (const float z : {0.1F, 0.6F, 1.1F}) points.emplace_back(5.0F, 5.0F, z);
  const std::string drawn = draw_map_points(points, square_box(10.0), true);
  EXPECT_EQ(occurrences(drawn, "<path"), 1U);
  EXPECT_NE(drawn.find("var(--m0)"), std::string::npos);
  EXPECT_EQ(draw_map_points({}, square_box(10.0), true), "");
}

TEST(MapPoints, KeepTheirWallsBesideAGhostFarBelow) {
  std::vector<Eigen::Vector3f> points = {{5.02F, 5.02F, -20.0F}, {1.0F, 1.02F, -20.0F}};
  for (const float z : {0.1F, 0.6F, 1.1F}) points.emplace_back(5.02F, 5.02F, z);
  EXPECT_EQ(strokes_with(draw_map_points(points, square_box(10.0), false), "var(--wall)"), "M100 -100h1");
  // None of these is a height.
  points.emplace_back(5.02F, 5.02F, std::numeric_limits<float>::quiet_NaN());
  points.emplace_back(5.02F, 5.02F, std::numeric_limits<float>::infinity());
  EXPECT_EQ(strokes_with(draw_map_points(points, square_box(10.0), false), "var(--wall)"), "M100 -100h1");
}

TEST(MapPoints, TellWallsFromFloorsOnEachOfFiveStoreys) {
  std::vector<Eigen::Vector3f> points;
  for (int storey = 0; storey < 5; ++storey) {
    const float floor = 4.0F * static_cast<float>(storey), x = 1.02F + static_cast<float>(storey);
    // Floor and ceiling, each with its noise, above those of the storey below.
    for (const float z : {-0.03F, 0.03F, 3.67F, 3.73F}) points.emplace_back(8.02F, 8.02F, floor + z);
    for (const float z : {0.1F, 0.6F, 1.1F}) points.emplace_back(x, 5.02F, floor + z);
  }
  const std::string drawn = draw_map_points(points, square_box(10.0), false);
  EXPECT_EQ(strokes_with(drawn, "var(--wall)"), "M20 -100h1M40 -100h1M60 -100h1M80 -100h1M100 -100h1");
  EXPECT_EQ(strokes_with(drawn, "var(--thing)"), "M160 -160h1");
}

TEST(MapPoints, GrowTheirCellsWithTheMap) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 200; ++i)
    for (int k = 0; k < 200; ++k)
      points.emplace_back(10.0F * static_cast<float>(i), 10.0F * static_cast<float>(k), 0.0F);
  const std::string drawn = draw_map_points(points, square_box(2000.0), false);
  EXPECT_NE(drawn.find("scale(8)"), std::string::npos) << drawn.substr(0, 100);
  EXPECT_LT(drawn.size(), 1'000'000U);
  // What lies outside of the box is left out.
  EXPECT_EQ(occurrences(draw_map_points({{-5.0F, 1.0F, 0.0F}, {1.0F, 1e9F, 0.0F}}, square_box(10.0), false), "<path"),
            0U);
}

TEST(MapPoints, HaveABoxThatAFewFarOnesDoNotStretch) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i <= 1000; ++i) points.emplace_back(0.01F * static_cast<float>(i), 1.0F, 0.0F);
  points.emplace_back(5000.0F, -9000.0F, 0.0F);
  const MapBox box = box_of_points(points);
  EXPECT_LT(box.max.x(), 10.1);
  EXPECT_GT(box.max.x(), 9.8);
  EXPECT_EQ(box.min.y(), 1.0);
}

}  // namespace
}  // namespace plumbline::scenarios
