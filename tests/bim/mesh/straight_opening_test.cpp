// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/straight_opening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bim/mesh/solid.h"
#include "bim/model/extrude.h"
#include "bim/random/stream.h"
#include "tests/bim/model/thick_wall.h"

namespace plumbline::bim {
namespace {

/// 6.4 m long, 0.4 m thick and 3 m high: 7.68 m3.
Wall wall_with_body() {
  Wall wall = thick_wall();
  wall.b = {6.4, 0.0};
  wall.offset_m = -0.2;
  wall.thickness_m = 0.4;
  wall.body = box_solid({0.0, -0.2, 0.0}, {6.4, 0.2, 3.0});
  return wall;
}

Opening opening_of(const std::vector<Solid>& parts) {
  Opening opening;
  opening.id = "o";
  opening.wall = 0;
  opening.solid = parts.front();
  opening.parts.assign(parts.begin() + 1, parts.end());
  return opening;
}

Solid upright(const Polygon2& outline, double z0, double z1) { return extrude({{outline, {}}}, z0, z1); }

/// A prism across the wall with the given outline in its elevation.
Solid across(Polygon2 outline, double y0, double y1) {
  if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
  const auto at = [](double y) { return [y](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), y, p.y()); }; };
  return extrude_between({{outline, {}}}, at(y1), at(y0));
}

bool straight(const std::vector<Solid>& parts) {
  return goes_straight_through(parts, WallFrame(wall_with_body()), {-0.2, 0.2}, {});
}

void expect_cut(const std::vector<Solid>& parts, double rest_m3) {
  const CutWall cut = cut_wall(wall_with_body(), {opening_of(parts)}, {});
  EXPECT_TRUE(cut.closed);
  EXPECT_TRUE(is_closed(cut.solid));
  EXPECT_NEAR(volume(cut.solid), rest_m3, 1e-4);
  ASSERT_EQ(cut.warnings.size(), 1U);
  EXPECT_EQ(cut.warnings[0].kind, "not_prismatic");
}

TEST(StraightOpening, PrismsAreStraightAloneAndTogether) {
  EXPECT_TRUE(straight({box_solid({1, -0.3, 0}, {2, 0.3, 2})}));
  EXPECT_TRUE(straight({box_solid({1, -0.3, 0}, {2, 0.3, 2}), box_solid({2, -0.2, 0}, {3, 0.2, 1})}));
  EXPECT_TRUE(
      straight({box_solid({1, -0.2, 0}, {2, 0, 2}), box_solid({1, 0, 0}, {2, 0.2, 2})}));  // one behind the other
  EXPECT_FALSE(straight({box_solid({1, -0.2, 0}, {2, 0.1, 2})}));
  EXPECT_FALSE(straight({box_solid({1, -0.2, 0}, {2, -0.1, 2}), box_solid({1, 0.1, 0}, {2, 0.2, 2})}));
}

TEST(StraightOpening, SplayedRevealsStaySplayed) {
  const Solid splayed = upright({{2, -0.2}, {4, -0.2}, {3.5, 0.2}, {2.5, 0.2}}, 1.0, 2.2);
  EXPECT_FALSE(straight({splayed}));
  expect_cut({splayed}, 7.68 - 1.5 * 0.4 * 1.2);
  const CutWall cut = cut_wall(wall_with_body(), {opening_of({splayed})}, {});
  const bool corner = std::any_of(cut.solid.vertices.begin(), cut.solid.vertices.end(), [](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(4.0, -0.2, 1.0)).norm() < 1e-4;
  });
  EXPECT_TRUE(corner);
}

TEST(StraightOpening, ADoorWithANicheAboveIsCutAsDeepAsItIs) {
  expect_cut({box_solid({2.5, -0.2, 0}, {3.4, 0.2, 2.1}), box_solid({2, -0.2, 2.1}, {4, -0.05, 2.4})},
             7.68 - 0.9 * 2.1 * 0.4 - 2.0 * 0.3 * 0.15);
}

TEST(StraightOpening, SkewPassagesStaySkew) {
  expect_cut({upright({{2, -0.2}, {3, -0.2}, {3.4, 0.2}, {2.4, 0.2}}, 0.0, 2.0)}, 7.68 - 0.8);
  expect_cut({upright({{1, -1}, {2, -1}, {4, 1}, {3, 1}}, 0.0, 2.0)}, 7.68 - 0.8);
}

TEST(StraightOpening, OutlinesThatRoundAcrossEachOtherEndNoCut) {
  const std::vector<Polygon2> outlines = {{{1.21138, 3.40002}, {1.54552, 3.27887}, {1.28553, 1.70344}},
                                          {{0.11055, 1.12670}, {1.50431, 0.48515}, {0.67098, 0.18036}},
                                          {{2.26080, 1.50418}, {1.30353, 0.28470}, {1.95531, 1.11514}},
                                          {{-0.49362, 1.95289}, {0.76201, 0.94177}, {-0.33380, 1.08734}},
                                          {{2.57059, 1.31541}, {1.84680, 0.65647}, {0.97725, 2.06890}}};
  Wall wall = wall_with_body();
  wall.b = {3.0, 0.0};
  wall.body = box_solid({0.0, -0.2, 0.0}, {3.0, 0.2, 3.0});
  std::vector<Opening> openings;
  for (const Polygon2& outline : outlines) openings.push_back(opening_of({across(outline, -0.3, 0.3)}));
  const Region2 face = unite(std::vector<Polygon2>{{{0, 0}, {3, 0}, {3, 3}, {0, 3}}});
  const CutWall cut = cut_wall(wall, openings, {});
  EXPECT_TRUE(cut.closed);
  EXPECT_NEAR(volume(cut.solid), 0.4 * (area(face) - area(intersect(face, unite(outlines)))), 1e-3);
}

TEST(StraightOpening, TriangularOpeningsAtRandomEndNoCut) {
  const Stream stream(12, "bim.generate");
  for (std::uint64_t tick = 0; tick < 60; ++tick) {
    std::uint32_t draws = 0;
    const auto draw = [&](double low, double high) { return low + (high - low) * stream.uniform(tick, 0, draws++); };
    std::vector<Opening> openings;
    std::vector<Polygon2> outlines;
    for (int i = 0; i < 15; ++i) {
      const Eigen::Vector2d middle(draw(0, 6.4), draw(0, 3));
      Polygon2& outline = outlines.emplace_back();
      for (int k = 0; k < 3; ++k) outline.emplace_back(middle + Eigen::Vector2d(draw(-1, 1), draw(-1, 1)));
      openings.push_back(opening_of({across(outline, -0.3, 0.3)}));
    }
    const Region2 face = unite(std::vector<Polygon2>{{{0, 0}, {6.4, 0}, {6.4, 3}, {0, 3}}});
    const double rest = area(face) - area(intersect(face, unite(outlines)));
    const CutWall cut = cut_wall(wall_with_body(), openings, {});
    EXPECT_TRUE(cut.closed) << tick;
    EXPECT_NEAR(volume(cut.solid), 0.4 * rest, 0.01) << tick;
  }
}

}  // namespace
}  // namespace plumbline::bim
