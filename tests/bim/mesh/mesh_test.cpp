// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/model/extrude.h"
#include "bim/model/wall_face.h"
#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

Polygon2 rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

Solid box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return extrude(unite(std::vector<Polygon2>{rectangle(low.x(), low.y(), high.x(), high.y())}), low.z(), high.z());
}

Wall wall_of(double length, double thickness) {
  Wall wall;
  wall.id = "w";
  wall.b = {length, 0.0};
  wall.thickness_m = thickness;
  wall.offset_m = -0.5 * thickness;
  return wall;
}

Opening hole(double s0, double s1, double z0, double z1) {
  Opening opening;
  opening.id = "o";
  opening.wall = 0;
  opening.s_m = 0.5 * (s0 + s1);
  opening.width_m = s1 - s0;
  opening.z0_m = z0;
  opening.z1_m = z1;
  return opening;
}

Solid element_solid(const BuildingMesh& mesh, std::size_t index) {
  const MeshElement& element = mesh.elements[index];
  Solid solid{mesh.vertices, {}};
  solid.triangles.assign(mesh.triangles.begin() + element.first_triangle,
                         mesh.triangles.begin() + element.first_triangle + element.triangle_count);
  return solid;
}

Solid cut(const Wall& wall, const std::vector<Opening>& openings, std::size_t warnings = 0) {
  const CutWall result = cut_wall(wall, openings, {});
  EXPECT_EQ(result.warnings.size(), warnings);
  EXPECT_TRUE(result.closed);
  return result.solid;
}

/// The body of a wall without openings, as a model would bring it: turned into W and with a body of its own.
Wall with_body(Wall wall, double angle) {
  wall.body = cut(wall, {});
  for (Eigen::Vector3d& p : wall.body->vertices) p = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * p;
  wall.a = Eigen::Rotation2Dd(angle) * wall.a;
  wall.b = Eigen::Rotation2Dd(angle) * wall.b;
  return wall;
}

TEST(WallCut, PlainWallIsABoxWhereItStands) {
  Wall wall = wall_of(4.0, 0.2);
  wall.a = {1.0, 1.0};
  wall.b = {1.0, 5.0};
  wall.offset_m = 0.0;  // to the left of a to b: towards -x
  const Solid solid = cut(wall, {});
  EXPECT_NEAR(volume(solid), 4.0 * 0.2 * 3.0, 1e-9);
  Eigen::Vector3d low = solid.vertices[0], high = solid.vertices[0];
  for (const Eigen::Vector3d& p : solid.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_NEAR((low - Eigen::Vector3d(0.8, 1.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((high - Eigen::Vector3d(1.0, 5.0, 3.0)).norm(), 0.0, 1e-9);
}

TEST(WallCut, DoorAtTheEndWindowsTouchingAndTwoPieces) {
  const Wall wall = wall_of(10.0, 0.2);
  EXPECT_NEAR(volume(cut(wall, {hole(0.0, 1.0, 0.0, 2.1)})), (30.0 - 2.1) * 0.2, 1e-9);
  EXPECT_NEAR(volume(cut(wall, {hole(1, 2, 1, 2), hole(2, 3, 1, 2)})), (30.0 - 2.0) * 0.2, 1e-9);
  EXPECT_NEAR(volume(cut(wall, {hole(1, 3, 0, 2), hole(2, 4, 1, 3)})), (30.0 - 4.0 - 4.0 + 1.0) * 0.2, 1e-9);
  EXPECT_NEAR(volume(cut(wall, {hole(4, 6, 0, 3)})), (30.0 - 6.0) * 0.2, 1e-9);
}

TEST(WallCut, OpeningsThatMeetInACornerStayManifold) {
  const Solid solid = cut(wall_of(10.0, 0.2), {hole(1, 2, 1, 2), hole(2, 3, 0, 1), hole(3, 4, 2, 3)});
  EXPECT_TRUE(is_closed(solid));
  EXPECT_NEAR(volume(solid), (30.0 - 3.0) * 0.2, 1e-9);
}

TEST(WallCut, NothingLeftIsAWarning) {
  const CutWall nothing = cut_wall(wall_of(2.0, 0.2), {hole(-1, 3, -1, 4)}, {});
  EXPECT_TRUE(nothing.solid.triangles.empty());
  ASSERT_EQ(nothing.warnings.size(), 1U);
  EXPECT_EQ(nothing.warnings[0].kind, "empty");
}

struct RandomWall {
  Wall wall;
  std::vector<Opening> openings;
  double area = 0.0;  ///< of the cut elevation, from disjoint openings
};

RandomWall random_wall(const Stream& stream, std::uint64_t tick) {
  const auto draw = [&](std::uint32_t i, double low, double high) {
    return low + (high - low) * stream.uniform(tick, 0, i);
  };
  RandomWall r;
  r.wall = wall_of(1.0, snap(draw(0, 0.05, 0.5)));
  const double angle = draw(1, -std::numbers::pi, std::numbers::pi);
  const int openings = static_cast<int>(draw(2, 0.0, 5.0));
  const double length = 2.0 * openings + snap(draw(3, 0.5, 4.0));
  r.wall.a = {draw(4, -50, 50), draw(5, -50, 50)};
  r.wall.b = r.wall.a + length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  r.wall.offset_m = draw(6, -0.5, 0.1);
  r.wall.z0_m = snap(draw(7, -5.0, 5.0));
  r.wall.z1_m = r.wall.z0_m + 3.0;
  r.area = 3.0 * length;
  for (int i = 0; i < openings; ++i) {
    const auto k = static_cast<std::uint32_t>(10 + 4 * i);
    const double s0 = 2.0 * i + snap(draw(k, 0.0, 0.5)), s1 = 2.0 * i + snap(draw(k + 1, 0.6, 1.9));
    const double z0 = draw(k + 2, 0, 1) < 0.4 ? 0.0 : 0.9, z1 = snap(draw(k + 3, 1.2, 2.9));
    r.openings.push_back(hole(s0, s1, r.wall.z0_m + z0, r.wall.z0_m + z1));
    r.area -= (s1 - s0) * (z1 - z0);
  }
  return r;
}

TEST(WallCut, VolumeIsAreaTimesThicknessAtRandom) {
  const Stream stream(6, "bim.generate");
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    const RandomWall r = random_wall(stream, tick);
    const Solid solid = cut(r.wall, r.openings);
    EXPECT_TRUE(is_closed(solid)) << tick;
    // 1 um of vertex grid on at most 60 m2 of surface.
    EXPECT_NEAR(volume(solid), r.area * r.wall.thickness_m, 3e-5) << tick;
  }
}

TEST(WallCut, ALeaningWallKeepsItsVolumeAndLiesBetweenItsTwoFaces) {
  const Stream stream(16, "bim.generate");
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    RandomWall r = random_wall(stream, tick);
    r.wall.slope = 0.4 * stream.uniform(tick, 1, 0) - 0.2;
    const Solid solid = cut(r.wall, r.openings);
    EXPECT_TRUE(is_closed(solid)) << tick;
    EXPECT_NEAR(volume(solid), r.area * r.wall.thickness_m, 3e-5) << tick;
    const Plane left = face_plane(r.wall, 0), right = face_plane(r.wall, 1);
    EXPECT_NEAR(left.n.norm(), 1.0, 1e-15);
    EXPECT_NEAR(std::abs(left.n.z()), std::abs(r.wall.slope) / std::hypot(1.0, r.wall.slope), 1e-12);
    for (const Eigen::Vector3d& p : solid.vertices)  // within the grid of the vertices
      EXPECT_NEAR(std::min(std::abs(left.distance(p)), std::abs(right.distance(p))), 0.0, 2e-6) << tick;
  }
}

TEST(WallCut, BodyAndRectangleGiveTheSameSolid) {
  const Wall plain = wall_of(6.0, 0.25);
  const std::vector<Opening> openings = {hole(1, 2, 0, 2.1), hole(3, 4.5, 0.9, 2.1)};
  const Wall bodied = with_body(plain, 0.0);
  const Solid a = cut(plain, openings), b = cut(bodied, openings);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(WallCut, OpeningSolidsInTwoTouchingPartsAreOneHole) {
  Opening opening = hole(1, 2, 0, 2);
  opening.solid = box({1, -0.2, 0}, {1.5, 0.2, 2});
  opening.parts = {box({1.5, -0.2, 0}, {2, 0.2, 2})};
  for (const double angle : {0.0, 0.7, 2.0}) {
    const Wall wall = with_body(wall_of(6.0, 0.25), angle);
    Opening turned = opening;
    for (Solid* solid : {&*turned.solid, &turned.parts[0]})
      for (Eigen::Vector3d& p : solid->vertices) p = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * p;
    const Solid solid = cut(wall, {turned});
    EXPECT_TRUE(is_closed(solid));
    EXPECT_NEAR(volume(solid), (18.0 - 2.0) * 0.25, 3e-5);
  }
}

/// Ends slanted at 45 degrees: the face at y = +t/2 is shorter by t at the start and longer by t at the end.
Wall mitred_wall(double length, double t) {
  Wall wall = wall_of(length, t);
  const Polygon2 footprint = {{0, -t / 2}, {length, -t / 2}, {length + t, t / 2}, {t, t / 2}};
  wall.body = extrude(unite(std::vector<Polygon2>{footprint}), 0.0, 3.0);
  return wall;
}

TEST(WallCut, MitredEndsStayMitred) {
  const double t = 0.3;
  const Solid solid = cut(mitred_wall(5.0, t), {hole(1, 2, 0, 2.1)});
  EXPECT_TRUE(is_closed(solid));
  EXPECT_NEAR(volume(solid), (5.0 * 3.0 - 2.1) * t, 1e-5);
  const bool has_corner = std::any_of(solid.vertices.begin(), solid.vertices.end(), [&](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(5.0 + t, t / 2, 3.0)).norm() < 1e-6;
  });
  EXPECT_TRUE(has_corner);
}

TEST(WallCut, OpeningInAMitreGoesTo3D) {
  const double t = 0.3;
  const CutWall result = cut_wall(mitred_wall(5.0, t), {hole(0.1, 1.0, 0, 2.1)}, {});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0].kind, "not_prismatic");
  EXPECT_TRUE(is_closed(result.solid));
  // The opening loses the slanted part of the wall left of it: at y the body starts at x = y + t/2.
  const double lost = (1.0 - 0.1) * t - (t - 0.1) * (t - 0.1) / 2.0;
  EXPECT_NEAR(volume(result.solid), 5.0 * 3.0 * t - lost * 2.1, 1e-4);
}

TEST(WallCut, NicheGoesTo3D) {
  const Wall wall = with_body(wall_of(4.0, 0.3), 0.0);
  Opening niche = hole(1, 2, 1, 2);
  niche.solid = box({1, 0.05, 1}, {2, 0.15, 2});  // ends exactly on the face: no film may stay
  Opening beside = hole(3, 3.5, 1, 2);
  beside.solid = box({3, 0.05, 1}, {3.5, 0.15, 2});
  EXPECT_EQ(cut_wall(wall, {niche, beside}, {}).warnings.size(), 2u);  // each is said
  const CutWall result = cut_wall(wall, {niche}, {});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0].kind, "niche");
  EXPECT_TRUE(is_closed(result.solid));
  EXPECT_NEAR(volume(result.solid), 12.0 * 0.3 - 0.1, 1e-6);
}

TEST(WallCut, AnOpeningBesideTheWallCutsNothing) {
  RandomWall r = random_wall(Stream(7, "bim.generate"), 0);
  r.wall.body = cut(r.wall, {});
  Opening beside = hole(0, 1, 0, 1);
  beside.solid = box({900, 900, 0}, {901, 901, 1});
  const CutWall result = cut_wall(r.wall, {beside}, {});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(volume(result.solid), volume(*r.wall.body), 1e-9);
}

TEST(WallCut, ThreeDAndElevationAgreeAtRandom) {
  const Stream stream(7, "bim.generate");
  for (std::uint64_t tick = 0; tick < 40; ++tick) {
    RandomWall r = random_wall(stream, tick);
    r.wall.body = cut(r.wall, {});
    // A niche of no effect (in free air behind the end of the wall) forces the whole wall through corefinement.
    Opening outside = hole(0, 1, 0, 1);
    const double t = r.wall.thickness_m, far_m = 900.0;
    const Eigen::Vector2d at = r.wall.a + far_m * r.wall.direction() + (r.wall.offset_m + 0.5 * t) * r.wall.left();
    const Eigen::Vector3d middle(at.x(), at.y(), far_m), half = Eigen::Vector3d::Constant(0.1 * t);
    outside.solid = box(middle - half, middle + half);
    std::vector<Opening> openings = r.openings;
    openings.push_back(outside);
    const CutWall result = cut_wall(r.wall, openings, {});
    ASSERT_EQ(result.warnings.size(), 1U) << result.warnings.back().text;
    EXPECT_EQ(result.warnings[0].kind, "niche");
    EXPECT_TRUE(is_closed(result.solid)) << tick;
    // 0.01 mm of corefinement grid on at most 60 m2.
    EXPECT_NEAR(volume(result.solid), r.area * r.wall.thickness_m, 3e-4) << tick;
  }
}

TEST(WallCut, TouchingPartsLeaveNoFilmIn3D) {
  const double angle = 0.7, t = 0.3;
  Wall wall = mitred_wall(5.0, t);
  Opening opening = hole(0.1, 1.0, 0, 2.1);  // reaches into the mitre
  opening.solid = box({0.1, -t / 2, 0}, {1.0, 0.0, 2.1});
  opening.parts = {box({0.1, 0.0, 0}, {1.0, t / 2, 2.1})};  // meets the other in the middle of the wall
  const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitZ());
  wall.b = Eigen::Rotation2Dd(angle) * wall.b;
  for (Solid* solid : {&*wall.body, &*opening.solid, &opening.parts[0]})
    for (Eigen::Vector3d& p : solid->vertices) p = turn * p;
  const CutWall result = cut_wall(wall, {opening}, {});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0].kind, "not_prismatic");
  EXPECT_TRUE(is_closed(result.solid));
  // No triangle has its middle in the clear opening.
  for (const Eigen::Vector3i& triangle : result.solid.triangles) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) middle += result.solid.vertices[static_cast<std::size_t>(triangle[i])] / 3.0;
    const Eigen::Vector3d p = turn.inverse() * middle;
    EXPECT_FALSE(p.x() > 0.4 && p.x() < 0.99 && p.z() > 0.01 && p.z() < 2.09 && std::abs(p.y()) < 0.14)
        << p.transpose();
  }
}

TEST(WallCut, ThreeDCutDoesNotDependOnWhatRanBefore) {
  const Stream stream(7, "bim.generate");
  const auto cut_in_space = [&](std::uint64_t tick) {
    RandomWall r = random_wall(stream, tick);
    r.wall.body = cut(r.wall, {});
    Opening outside = hole(0, 1, 0, 1);
    outside.solid = box({900, 900, 900}, {901, 901, 901});
    r.openings.push_back(outside);
    return cut_wall(r.wall, r.openings, {}).solid;
  };
  std::vector<Solid> first;
  for (std::uint64_t tick = 0; tick < 10; ++tick) first.push_back(cut_in_space(tick));
  for (std::uint64_t i = 10; i-- > 0;) {
    const Solid again = cut_in_space(i);
    EXPECT_EQ(again.vertices, first[i].vertices) << i;
    EXPECT_EQ(again.triangles, first[i].triangles) << i;
  }
}

TEST(WallCut, OpenBodyIsKeptAndReported) {
  Wall wall = with_body(wall_of(4.0, 0.3), 0.0);
  std::erase_if(wall.body->triangles, [&](const Eigen::Vector3i& t) {  // the face at y = -0.15
    const auto& v = wall.body->vertices;
    return (v[static_cast<std::size_t>(t[0])] + v[static_cast<std::size_t>(t[1])] + v[static_cast<std::size_t>(t[2])])
               .y() < -0.44;
  });
  const CutWall result = cut_wall(wall, {hole(1, 2, 0, 2)}, {});
  EXPECT_FALSE(result.closed);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_EQ(result.warnings.back().kind, "not_closed");
  EXPECT_FALSE(result.solid.triangles.empty());
}

Building small_building() {
  Building building;
  building.storeys.push_back({"ground", "ground"});
  building.walls = {wall_of(4.0, 0.2), wall_of(3.0, 0.1)};
  building.walls[1].b = {0.0, 3.0};
  Opening door = hole(1, 2, 0, 2.1);
  building.openings = {door};
  Slab slab;
  slab.polygon = {rectangle(-1, -1, 5, 5), {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
  building.slabs = {slab};
  Column column;
  column.footprint = rectangle(2, 2, 2.5, 2.5);
  building.columns = {column};
  building.obstacles = {{"crate", "box", 0, box({3, 3, 0}, {4, 4, 1})}};
  return building;
}

TEST(BuildingMesh, HoldsEveryElementOnce) {
  const BuildingMesh mesh = build_mesh(small_building());
  ASSERT_EQ(mesh.elements.size(), 5U);
  EXPECT_EQ(mesh.element.size(), mesh.triangles.size());
  const double expected[] = {(12.0 - 2.1) * 0.2, 9.0 * 0.1, 35.0 * 0.2, 0.75, 1.0};
  int next = 0;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    EXPECT_TRUE(is_closed(element_solid(mesh, i))) << i;
    EXPECT_NEAR(mesh.elements[i].volume_m3, expected[i], 1e-9) << i;
    EXPECT_EQ(mesh.elements[i].first_triangle, next);
    next += mesh.elements[i].triangle_count;
  }
  EXPECT_EQ(next, static_cast<int>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const MeshElement& element = mesh.elements[static_cast<std::size_t>(mesh.element[t])];
    EXPECT_GE(static_cast<int>(t), element.first_triangle);
    EXPECT_LT(static_cast<int>(t), element.first_triangle + element.triangle_count);
  }
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST(BuildingMesh, IsTheSameTwice) {
  const BuildingMesh a = build_mesh(small_building());
  (void)cut_wall(with_body(wall_of(9.0, 0.4), 1.0), {hole(1, 2, 0, 2)}, {});  // other work in between
  const BuildingMesh b = build_mesh(small_building());
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

}  // namespace
}  // namespace plumbline::bim
