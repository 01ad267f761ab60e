// SPDX-License-Identifier: Apache-2.0
#include "bim/model/body_section.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/bim/model/thick_wall.h"

namespace plumbline::bim {
namespace {

/// The sides of an upright prism over an outline, counter-clockwise; a section needs no more.
Solid sides_over(const Polygon2& outline) {
  Solid solid;
  const int n = static_cast<int>(outline.size());
  for (const double z : {0.0, 3.0})
    for (const Eigen::Vector2d& p : outline) solid.vertices.emplace_back(p.x(), p.y(), z);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    solid.triangles.emplace_back(i, j, n + j);
    solid.triangles.emplace_back(i, n + j, n + i);
  }
  return solid;
}

TEST(BodySection, OfARingWithASeamHasItsHole) {
  const Polygon2 slit = {{0, 0},     {4, 0},     {4, 3},     {0, 3},     {0, 0.2},
                         {0.2, 0.2}, {0.2, 2.8}, {3.8, 2.8}, {3.8, 0.2}, {0, 0.2}};
  for (std::size_t first = 0; first < slit.size(); ++first) {
    Polygon2 outline = slit;
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
    const Region2 section = body_section(sides_over(outline), 1.0);
    ASSERT_EQ(section.size(), 1u) << first;
    ASSERT_EQ(section.front().holes.size(), 1u) << first;
    EXPECT_NEAR(area(section), 4.0 * 3.0 - 3.6 * 2.6, 1e-9) << first;
  }
}

TEST(BodySection, OfPartsThatMeetInACornerHasBoth) {
  const Polygon2 bow = {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}};
  EXPECT_NEAR(area(body_section(sides_over(bow), 1.0)), 2.0, 1e-9);
}

TEST(BodySection, OfABoxIsItsOutline) {
  EXPECT_NEAR(area(body_section(box_solid({0, 0, 0}, {4, 0.2, 3}), 1.0)), 0.8, 1e-9);
  EXPECT_TRUE(body_section(box_solid({0, 0, 0}, {4, 0.2, 3}), 4.0).empty());
}

}  // namespace
}  // namespace plumbline::bim
