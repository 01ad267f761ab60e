// SPDX-License-Identifier: Apache-2.0
#include "bim/model/wall_section.h"

#include <gtest/gtest.h>

#include <chrono>

#include "bim/mesh/solid.h"
#include "tests/bim/model/thick_wall.h"
#include "tests/sanitized.h"

namespace plumbline::bim {
namespace {

double outline_of(const std::vector<WallCut>& cuts) {
  double sum = 0.0;
  for (const WallCut& cut : cuts) sum += (cut.b - cut.a).norm();
  return sum;
}

TEST(WallSection, JoinsWhatIsInLine) {
  const std::vector<WallCut> cuts = section(thick_wall(), 1.3);
  EXPECT_EQ(cuts.size(), 4U);
  EXPECT_NEAR(outline_of(cuts), 2.0 * (4.0 + 0.2), 1e-9);
}

TEST(WallSection, ABodyGivenTwiceIsFull) {
  Wall wall = thick_wall();
  ASSERT_TRUE(is_straight(wall, {}, {0.0, 3.0}));
  const Solid once = *wall.body;
  add_solid(once, *wall.body);
  EXPECT_TRUE(is_straight(wall, {}, {0.0, 3.0}));
  // Two parts that overlap, and leave a gap.
  Solid gap = box_solid({0.0, -0.1, 0.0}, {1.5, 0.1, 3.0});
  add_solid(box_solid({1.0, -0.1, 0.0}, {2.0, 0.1, 3.0}), gap);
  add_solid(box_solid({3.0, -0.1, 0.0}, {4.0, 0.1, 3.0}), gap);
  wall.body = gap;
  EXPECT_FALSE(is_straight(wall, {}, {0.0, 3.0}));
}

TEST(WallSection, FacesThatAreTurnedOverAreCountedAlone) {
  Wall wall = thick_wall();
  Solid parts = box_solid({0.0, -0.1, 0.0}, {4.0, 0.0, 3.0});
  add_solid(box_solid({0.0, 0.0, 0.0}, {4.0, 0.1, 3.0}), parts);
  for (std::size_t i = 0; i < 4; ++i) std::swap(parts.triangles[i].x(), parts.triangles[i].y());
  wall.body = parts;
  EXPECT_TRUE(is_straight(wall, {}, {0.0, 3.0}));
}

// Strips of a zigzag, none in line with the next.
TEST(WallSection, ManyTrianglesTakeLittleTime) {
  Wall wall = thick_wall();
  Solid body;
  constexpr int strips = 100000;
  for (int i = 0; i <= strips; ++i) {
    const double s = 2000.0 * i / strips, y = i % 2 == 0 ? 0.0 : 0.05;
    body.vertices.emplace_back(s, y, 0.0);
    body.vertices.emplace_back(s, y, 3.0);
    if (i == 0) continue;
    const int a = 2 * (i - 1);
    body.triangles.emplace_back(a, a + 2, a + 3);
    body.triangles.emplace_back(a, a + 3, a + 1);
  }
  wall.body = body;
  const auto before = std::chrono::steady_clock::now();
  const std::vector<WallCut> cuts = section(wall, 1.3);
  EXPECT_EQ(cuts.size(), static_cast<std::size_t>(strips));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count(), 5.0 * slower);
}

}  // namespace
}  // namespace plumbline::bim
