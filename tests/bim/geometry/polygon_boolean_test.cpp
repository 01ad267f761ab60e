// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/polygon_boolean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bim/model/triangulate.h"
#include "bim/random/stream.h"
#include "tests/bim/geometry/rectangle.h"

namespace plumbline {
namespace {

Polygon2 random_rectangle(const Stream& stream, std::uint64_t tick, std::uint32_t lane) {
  const auto draw = [&](std::uint32_t i, double low, double high) {
    return low + (high - low) * stream.uniform(tick, lane, i);
  };
  const double x = draw(0, 0, 5), y = draw(1, 0, 5);
  return rectangle(x, y, x + draw(2, 0.1, 3), y + draw(3, 0.1, 3));
}

TEST(PolygonBoolean, SnapGivesTheDoubleNearestToItsDecimals) {
  EXPECT_EQ(snap(-12.60000004), -12.6);
  EXPECT_FALSE(std::signbit(snap(-1e-9)));
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double steps = std::round(1e6 * (stream.uniform(i, 0, 0) - 0.5));
    const double off = 0.98 * (stream.uniform(i, 0, 1) - 0.5);  // of a step
    char decimals[32];
    std::snprintf(decimals, sizeof decimals, "%.0fe-4", steps);
    EXPECT_EQ(snap((steps + off) * 1e-4), std::strtod(decimals, nullptr)) << decimals;
    std::snprintf(decimals, sizeof decimals, "%.0fe-6", steps);
    EXPECT_EQ(snap((steps + off) * 1e-6, 1e-6), std::strtod(decimals, nullptr)) << decimals;
  }
}

TEST(PolygonBoolean, UniteMergesTouchingRectanglesIntoOneRing) {
  const std::vector<Polygon2> parts = {rectangle(0, 0, 1, 1), rectangle(1, 0, 2, 1)};
  const Region2 region = unite(parts);
  ASSERT_EQ(region.size(), 1U);
  EXPECT_EQ(region[0].outer, rectangle(0, 0, 2, 1));
  EXPECT_TRUE(region[0].holes.empty());
}

TEST(PolygonBoolean, UniteIgnoresOrientationAndSlivers) {
  Polygon2 clockwise = rectangle(0, 0, 1, 1);
  std::reverse(clockwise.begin(), clockwise.end());
  const std::vector<Polygon2> parts = {clockwise, {{0, 0}, {1, 1e-6}, {2, 0}}};
  const Region2 region = unite(parts);
  ASSERT_EQ(region.size(), 1U);
  EXPECT_EQ(region[0].outer, rectangle(0, 0, 1, 1));
}

TEST(PolygonBoolean, SubtractMakesHolesAndPieces) {
  const Region2 wall = unite(std::vector<Polygon2>{rectangle(0, 0, 10, 3)});
  const Region2 cut = subtract(wall, std::vector<Polygon2>{rectangle(1, 1, 2, 2), rectangle(5, -1, 6, 4)});
  ASSERT_EQ(cut.size(), 2U);
  ASSERT_EQ(cut[0].holes.size(), 1U);
  EXPECT_LT(signed_area(cut[0].holes[0]), 0.0);
  EXPECT_NEAR(area(cut), 30.0 - 1.0 - 3.0, 1e-12);
  EXPECT_FALSE(contains(cut[0], {1.5, 1.5}));
  EXPECT_TRUE(contains(cut[0], {1.0, 1.5}));
}

TEST(PolygonBoolean, RingsThatTouchInACornerComeApart) {
  const Region2 square = unite(std::vector<Polygon2>{rectangle(0, 0, 2, 2)});
  const Region2 diagonal = subtract(square, std::vector<Polygon2>{rectangle(0, 1, 1, 2), rectangle(1, 0, 2, 1)});
  ASSERT_EQ(diagonal.size(), 2U);
  EXPECT_EQ(diagonal[0].outer, rectangle(0, 0, 1, 1));
  EXPECT_EQ(diagonal[1].outer, rectangle(1, 1, 2, 2));
  const Region2 bitten = subtract(square, std::vector<Polygon2>{{{0, 0}, {1.5, 0.5}, {0.5, 1.5}}});
  ASSERT_EQ(bitten.size(), 1U);
  EXPECT_NEAR(area(bitten), 4.0 - 1.0, 1e-9);
  for (const Polygon2& hole : bitten[0].holes) EXPECT_TRUE(is_simple(hole));
  EXPECT_TRUE(is_simple(bitten[0].outer));
}

TEST(PolygonBoolean, IslandInAHoleSurvives) {
  const Region2 ring =
      subtract(unite(std::vector<Polygon2>{rectangle(0, 0, 5, 5)}), std::vector<Polygon2>{rectangle(1, 1, 4, 4)});
  Region2 both = ring;
  both.push_back({rectangle(2, 2, 3, 3), {}});
  const Region2 cut = subtract(both, std::vector<Polygon2>{rectangle(-1, -1, 0.5, 6)});
  ASSERT_EQ(cut.size(), 2U);
  EXPECT_NEAR(area(cut), 25.0 - 9.0 + 1.0 - 2.5, 1e-9);
  EXPECT_NEAR(area(intersect(both, unite(std::vector<Polygon2>{rectangle(1, 1, 4, 4)}))), 1.0, 1e-9);
}

TEST(PolygonBoolean, InclusionExclusionAtRandom) {
  const Stream stream(4, "bim.generate");
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const Polygon2 a = random_rectangle(stream, tick, 0), b = random_rectangle(stream, tick, 1);
    const Region2 only_a = unite(std::vector<Polygon2>{a}), only_b = unite(std::vector<Polygon2>{b});
    const double both = area(intersect(only_a, only_b));
    // Axis-parallel edges on the grid make no new coordinates: sums agree to rounding.
    EXPECT_NEAR(area(unite(std::vector<Polygon2>{a, b})), area(only_a) + area(only_b) - both, 1e-9);
    EXPECT_NEAR(area(subtract(only_a, std::vector<Polygon2>{b})), area(only_a) - both, 1e-9);
  }
}

TEST(PolygonBoolean, RingsStaySimpleWhenTheirCornersAreRounded) {
  const Stream stream(6, "bim.generate");
  for (std::uint64_t tick = 0; tick < 400; ++tick) {
    // A polygon, and boxes along its sides as walls are: wedges thinner than the grid remain between them.
    constexpr int corners = 24;
    Polygon2 outline;
    std::vector<Polygon2> sides;
    const double radius = 5.0 + 5.0 * stream.uniform(tick, 0, 0), turn = stream.uniform(tick, 0, 1);
    const auto corner = [&](int i) -> Eigen::Vector2d {
      const double angle = turn + 2.0 * 3.14159265358979 * (i % corners) / corners;
      return radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    };
    for (int i = 0; i < corners; ++i) {
      const Eigen::Vector2d a = corner(i), b = corner(i + 1), e = (b - a).normalized(), left(-e.y(), e.x());
      outline.push_back(a);
      sides.push_back({a - 0.15 * left, b - 0.15 * left, b + 0.15 * left, a + 0.15 * left});
    }
    const Region2 rest = subtract(unite(std::vector<Polygon2>{outline}), sides);
    ASSERT_FALSE(rest.empty());
    for (const PolygonWithHoles2& piece : rest) {
      EXPECT_TRUE(is_simple(piece.outer)) << tick;
      for (const Polygon2& hole : piece.holes) EXPECT_TRUE(is_simple(hole)) << tick;
    }
  }
}

double perimeter(const Region2& region) {
  double sum = 0.0;
  const auto add = [&](const Polygon2& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) sum += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  };
  for (const PolygonWithHoles2& piece : region) {
    add(piece.outer);
    for (const Polygon2& hole : piece.holes) add(hole);
  }
  return sum;
}

/// Triangles of any shape in a square of the given size, or thin strips across it.
std::vector<Polygon2> random_parts(const Stream& stream, std::uint64_t tick, double size_m, bool strips) {
  std::uint32_t draws = 0;
  const auto draw = [&](double low, double high) { return low + (high - low) * stream.uniform(tick, 0, draws++); };
  std::vector<Polygon2> parts;
  const int count = static_cast<int>(draw(5, 25));
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d middle(draw(0, size_m), draw(0, size_m));
    if (strips) {
      const double angle = draw(0, 3.14159265358979), half = draw(0.3, 2.5) * size_m, width = draw(5e-4, 1e-2);
      const Eigen::Vector2d e(std::cos(angle), std::sin(angle)), left(-e.y(), e.x());
      parts.push_back({middle - half * e - width * left, middle + half * e - width * left,
                       middle + half * e + width * left, middle - half * e + width * left});
      continue;
    }
    Polygon2& triangle = parts.emplace_back();
    for (int k = 0; k < 3; ++k)
      triangle.emplace_back(middle + size_m * Eigen::Vector2d(draw(-0.33, 0.33), draw(-0.33, 0.33)));
  }
  return parts;
}

/// Areas agree within what rounding may move the rings, and regions can be used again and triangulated.
void expect_consistent(const std::vector<Polygon2>& parts, const std::string& name) {
  const std::vector<Polygon2> half(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(parts.size() / 2));
  const Region2 all = unite(parts), some = unite(half), rest = subtract(all, half), common = intersect(all, some);
  const double slack = 2e-4 * (perimeter(all) + perimeter(some) + perimeter(rest) + perimeter(common)) + 1e-12;
  EXPECT_NEAR(area(some) + area(rest), area(all), slack) << name;
  EXPECT_NEAR(area(common), area(some), slack) << name;
  for (const Region2& region : {all, some, rest, common}) {
    double sum = 0.0;
    const bim::FlatMesh mesh = bim::triangulate(region);
    for (const bim::FlatTriangle& t : mesh.triangles) {
      const auto p = [&](std::size_t k) { return mesh.points[static_cast<std::size_t>(t.points[k])]; };
      sum += signed_area({p(0), p(1), p(2)});
    }
    EXPECT_NEAR(sum, area(region), 1e-9) << name;
  }
}

TEST(PolygonBoolean, RegionsStayValidWhenTheirCornersAreRounded) {
  const Stream stream(8, "bim.generate");
  for (const double size_m : {3.0, 0.01, 0.003})
    for (std::uint64_t tick = 0; tick < 60; ++tick)
      expect_consistent(random_parts(stream, tick, size_m, false), std::to_string(size_m) + " " + std::to_string(tick));
  for (std::uint64_t tick = 100; tick < 140; ++tick)
    expect_consistent(random_parts(stream, tick, 3.0, true), "strips " + std::to_string(tick));
}

TEST(PolygonBoolean, AHoleThatRoundsOntoItsOutlineStaysAHole) {
  const Region2 gable = unite(std::vector<Polygon2>{{{0, 0}, {8, 0}, {8, 2.7}, {4, 5.137}, {0, 2.7}}});
  const auto roof = [](double x) { return 2.7 + std::min(x, 8.0 - x) * 2.437 / 4.0; };
  const Stream stream(9, "bim.generate");
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    // Windows up to the roof, which overlap and leave wedges of the wall between them.
    std::vector<Polygon2> windows;
    std::uint32_t draws = 0;
    const auto draw = [&](double low, double high) { return low + (high - low) * stream.uniform(tick, 0, draws++); };
    for (int i = 0; i < 6; ++i) {
      const double x = draw(0.3, 6.5), w = draw(0.5, 1.5), z = draw(0.1, 2.0);
      const bool square = draw(0, 1) < 0.5;
      windows.push_back({{x, z}, {x + w, z}, {x + w, square ? z + 1.0 : roof(x + w)}, {x, square ? z + 1.0 : roof(x)}});
    }
    const double left = area(gable) - area(intersect(gable, unite(windows)));
    EXPECT_NEAR(area(subtract(gable, windows)), left, 0.01) << tick;
  }
}

TEST(PolygonBoolean, ResultDoesNotDependOnTheOrderOfTheParts) {
  const Stream stream(5, "bim.generate");
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    std::vector<Polygon2> parts;
    for (std::uint32_t i = 0; i < 8; ++i) parts.push_back(random_rectangle(stream, tick, i));
    const Region2 forward = unite(parts);
    std::reverse(parts.begin(), parts.end());
    const Region2 backward = unite(parts);
    ASSERT_EQ(forward.size(), backward.size());
    for (std::size_t i = 0; i < forward.size(); ++i) {
      EXPECT_EQ(forward[i].outer, backward[i].outer);
      EXPECT_EQ(forward[i].holes, backward[i].holes);
    }
  }
}

}  // namespace
}  // namespace plumbline
