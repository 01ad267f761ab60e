// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/mesh/mesh.h"
#include "bim/mesh/solid.h"
#include "tests/bim/formats/ifc/fixture.h"

namespace plumbline::bim {
namespace {

Facets box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Facets facets;
  for (int i = 0; i < 8; ++i)
    facets.points.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  facets.loops = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return facets;
}

double volume_of(const Shape& shape, std::size_t problems = 0) {
  std::vector<std::string> said;
  const Solid solid = solid_of(shape, said);
  EXPECT_EQ(said.size(), problems);
  EXPECT_TRUE(is_closed(solid));
  return volume(solid);
}

TEST(Triangulated, TurnsFacesAlike) {
  for (std::size_t turned = 0; turned < 6; ++turned) {
    Facets facets = box({0, 0, 0}, {1, 2, 3});
    std::reverse(facets.loops[turned].begin(), facets.loops[turned].end());
    std::reverse(facets.loops[2].begin(), facets.loops[2].end());
    const Solid solid = triangulated(facets);
    EXPECT_TRUE(is_closed(solid)) << turned;
    EXPECT_NEAR(volume(solid), 6.0, 1e-9) << turned;
  }
}

TEST(Shape, IsWhatItHasInCommonWithTheOthersLessTheCuts) {
  Shape shape{box({0, 0, 0}, {2, 2, 2}), {}};
  EXPECT_NEAR(volume_of(shape), 8.0, 1e-9);
  shape.within = {box({1, 1, 1}, {3, 3, 3})};
  EXPECT_NEAR(volume_of(shape), 1.0, 1e-9);
  shape.minus = {box({1.5, 0, 0}, {4, 4, 4})};
  EXPECT_NEAR(volume_of(shape), 0.5, 1e-9);
  shape.within.push_back(box({0, 0, 0}, {9, 1.25, 9}));
  EXPECT_NEAR(volume_of(shape), 0.125, 1e-9);
}

TEST(Shape, OpenOtherLeavesTheWholeAndSaysSo) {
  Shape shape{box({0, 0, 0}, {2, 2, 2}), {}};
  shape.within = {box({1, 1, 1}, {3, 3, 3})};
  shape.within.front().loops.pop_back();
  EXPECT_NEAR(volume_of(shape, 1), 8.0, 1e-9);
}

/// A square tube whose end faces run into their hole and back along one bridge.
TEST(Shape, BridgedFacesAreCutIntoEars) {
  for (const double shift : {0.0, 0.3, 0.7}) {
    Facets tube;
    for (const double z : {0.0, 2.0}) {
      for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(4.0, 0.0), std::pair(4.0, 4.0), std::pair(0.0, 4.0)})
        tube.points.emplace_back(x, y, z);
      for (const auto& [x, y] : {std::pair(1.0, 1.0), std::pair(3.0, 1.0), std::pair(3.0, 3.0), std::pair(1.0, 3.0)})
        tube.points.emplace_back(x + shift, y - shift / 2.0, z);
    }
    tube.loops = {{8, 9, 10, 11, 8, 12, 15, 14, 13, 12}, {0, 4, 5, 6, 7, 4, 0, 3, 2, 1}};
    for (int k = 0; k < 4; ++k) {
      const int n = (k + 1) % 4;
      tube.loops.push_back({k, n, n + 8, k + 8});
      tube.loops.push_back({n + 4, k + 4, k + 12, n + 12});
    }
    const Solid solid = triangulated(tube);
    EXPECT_TRUE(is_closed(solid)) << shift;
    EXPECT_NEAR(volume(solid), (16.0 - 4.0) * 2.0, 1e-6) << shift;
    EXPECT_EQ(solid.triangles.size(), 2u * 8u + 8u * 2u) << shift;
  }
}

TEST(Shape, FacesThatRunAcrossThemselvesAreCounted) {
  Facets facets = box({0, 0, 0}, {1, 2, 3});
  int crossed = 0;
  (void)triangulated(facets, crossed);
  EXPECT_EQ(crossed, 0);
  facets.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {1, -1, 0}};
  facets.loops = {{0, 1, 2, 3}};
  (void)triangulated(facets, crossed);
  EXPECT_EQ(crossed, 1);
}

TEST(Shape, HolesThatCrossTheOutlineAreNotCut) {
  Facets facets;
  facets.points = {{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}, {3, 1, 1}, {5, 1, 1}, {5, 2, 1}, {3, 2, 1}, {1, 1, 1}};
  EXPECT_FALSE(add_triangles(facets, {{0, 1, 2, 3}, {4, 7, 6, 5}}));
  EXPECT_TRUE(facets.loops.empty());
  EXPECT_TRUE(add_triangles(facets, {{0, 1, 2, 3}, {8, 4, 7}}));
  EXPECT_EQ(facets.loops.size(), 7u);
}

TEST(Shape, OrderOfPointsAndLoopsDoesNotShow) {
  const Facets straight = box({0, 0, 0}, {1, 2, 3});
  Facets turned = straight;
  std::reverse(turned.points.begin(), turned.points.end());
  for (std::vector<int>& loop : turned.loops) {
    for (int& i : loop) i = 7 - i;
    std::rotate(loop.begin(), loop.begin() + 1, loop.end());
  }
  std::reverse(turned.loops.begin(), turned.loops.end());
  const Solid a = triangulated(straight), b = triangulated(turned);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// The wall of the fixture as what it has in common with a box of 2.5 m.
TEST(Shape, BooleanIntersectionIsReadFromAFile) {
  std::string text = small_ifc({});
  const std::string items = "'SweptSolid',(#61));";
  text.replace(text.find(items), items.size(),
               "'CSG',(#65));\n#65=IFCBOOLEANRESULT(.INTERSECTION.,#61,#68);\n"
               "#68=IFCEXTRUDEDAREASOLID(#69,#11,#66,2.5);\n#69=IFCRECTANGLEPROFILEDEF(.AREA.,$,#63,6.,1.);");
  const Building building = read_ifc_text(text, "common.ifc");
  ASSERT_EQ(building.walls.size(), 1u);
  EXPECT_NEAR(building.walls.front().z1_m, 2.5, 1e-9);
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(mesh.elements.front().closed);
  EXPECT_NEAR(mesh.elements.front().volume_m3, (4.0 * 2.5 - 1.0 * 2.0) * 0.2, 1e-6);
}

}  // namespace
}  // namespace plumbline::bim
