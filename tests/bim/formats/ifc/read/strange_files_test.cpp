// SPDX-License-Identifier: Apache-2.0
// Buildings as other programs write them: bodies, openings and doors as an architect would read them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/mesh.h"
#include "bim/mesh/solid.h"
#include "bim/model/floors.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

/// Volume of the only wall, which must close.
double wall_volume(const Sketch& sketch) {
  const Building building = read(sketch);
  EXPECT_EQ(building.walls.size(), 1u);
  EXPECT_EQ(count(building, "not_clipped"), 0);
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(mesh.elements.front().closed);
  for (const Warning& warning : mesh.warnings) EXPECT_EQ(warning.kind, "not_prismatic") << warning.text;
  return mesh.elements.front().volume_m3;
}

constexpr double thickness = 0.2;

Sketch clipped_wall(const std::function<std::string(Sketch&, std::string)>& clip) {
  Sketch sketch;
  sketch.storey(0);
  const std::string body = clip(sketch, sketch.box(0, -thickness / 2, 0, 6, thickness / 2, 8));
  sketch.element("IFCWALL", sketch.wall_shape(body, 6), "$,$");
  return sketch;
}

const Polygon2 around = {{-1, -1}, {7, -1}, {7, 1}, {-1, 1}};

TEST(Clipping, ByAPlaneHoweverFarItsOriginLies) {
  for (const double far_m : {0.0, 80.0, 400.0, 5000.0})
    EXPECT_NEAR(wall_volume(clipped_wall([&](Sketch& s, const std::string& body) {
                  return s.difference(body, s.half_space(s.frame(far_m, far_m, 3)));
                })),
                6 * 3 * thickness, 1e-4)
        << far_m;
}

TEST(Clipping, AGableWhoseTwoPlanesMeetInTheRidge) {
  // 45 degrees from 3 m at the ends to 6 m in the middle.
  const Sketch gable = clipped_wall([](Sketch& s, std::string body) {
    body = s.difference(body, s.half_space(s.frame(0, 0, 3, "-1.,0.,1.", "1.,0.,1.")));
    return s.difference(body, s.half_space(s.frame(6, 0, 3, "1.,0.,1.", "1.,0.,-1.")));
  });
  EXPECT_NEAR(wall_volume(gable), (6 * 3 + 9) * thickness, 1e-4);
  // The same by prisms over each half, which share the ridge.
  const Sketch halves = clipped_wall([](Sketch& s, std::string body) {
    body = s.difference(body, s.half_space(s.frame(0, 0, 3, "-1.,0.,1.", "1.,0.,1."),
                                           {{-1, -1}, {3, -1}, {3, 1}, {-1, 1}}, s.frame(0, 0, 0)));
    return s.difference(body, s.half_space(s.frame(6, 0, 3, "1.,0.,1.", "1.,0.,-1."),
                                           {{3, -1}, {7, -1}, {7, 1}, {3, 1}}, s.frame(0, 0, 0)));
  });
  EXPECT_NEAR(wall_volume(halves), (6 * 3 + 9) * thickness, 1e-4);
}

TEST(Clipping, AgreementAndTheDirectionOfTheBoundaryMakeNoDifference) {
  for (const bool agreement : {false, true}) {
    for (const bool down : {false, true}) {
      const Sketch sketch = clipped_wall([&](Sketch& s, const std::string& body) {
        // The normal points up or, with agreement, down: above 3 m is taken away.
        const std::string plane = agreement ? s.frame(0, 0, 3, "0.,0.,-1.", "1.,0.,0.") : s.frame(0, 0, 3);
        const std::string boundary = down ? s.frame(0, 0, 9, "0.,0.,-1.", "1.,0.,0.") : s.frame(0, 0, -2);
        return s.difference(body, s.half_space(plane, around, boundary, agreement));
      });
      EXPECT_NEAR(wall_volume(sketch), 6 * 3 * thickness, 1e-4) << agreement << down;
    }
  }
}

TEST(Clipping, ByAnUprightPlaneAlongThePrism) {
  const Sketch sketch = clipped_wall([](Sketch& s, const std::string& body) {
    return s.difference(body, s.half_space(s.frame(4, 0, 0, "1.,0.,0.", "0.,1.,0."), around, s.frame(0, 0, 0)));
  });
  EXPECT_NEAR(wall_volume(sketch), 4 * 8 * thickness, 1e-4);
}

TEST(Clipping, ByManyPlanesThatTouchAndRepeat) {
  const Sketch sketch = clipped_wall([](Sketch& s, std::string body) {
    for (int i = 0; i < 6; ++i)
      body = s.difference(
          body,
          s.half_space(s.frame(i, 0, 4), {{1.0 * i, -1}, {i + 1.0, -1}, {i + 1.0, 1}, {1.0 * i, 1}}, s.frame(0, 0, 0)));
    for (int i = 0; i < 3; ++i) body = s.difference(body, s.half_space(s.frame(0, 0, 4)));
    return body;
  });
  EXPECT_NEAR(wall_volume(sketch), 6 * 4 * thickness, 1e-4);
}

TEST(Clipping, ByABodyThatLeavesTwoPiecesTouchingInAnEdge) {
  // Two boxes cut off so that what is left touches itself along an upright edge.
  const Sketch sketch = clipped_wall([](Sketch& s, std::string body) {
    body = s.difference(body, s.box(0, 0, -1, 3, 1, 9));
    return s.difference(body, s.box(3, -1, -1, 7, 0, 9));
  });
  EXPECT_NEAR(wall_volume(sketch), 6 * 8 * thickness / 2, 1e-4);
}

TEST(Openings, ThatTouchEachOtherAndTheEdgesLeaveNoFilm) {
  Sketch sketch;
  sketch.storey(0);
  const std::string wall = sketch.wall(0, 0, 6, thickness, 3);
  for (int i = 0; i < 3; ++i) sketch.door(sketch.opening(wall, sketch.box(1.0 + i, -0.1, 0, 2.0 + i, 0.1, 2)));
  sketch.opening(wall, sketch.box(1, -0.1, 2, 4, 0.1, 3));
  EXPECT_NEAR(wall_volume(sketch), (6 * 3 - 3 * 3) * thickness, 1e-4);
}

/// Faces of a box without its lid.
std::vector<std::vector<Eigen::Vector3d>> open_box(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {{{x0, y0, z0}, {x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}},
          {{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}},
          {{x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}},
          {{x1, y1, z0}, {x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1}},
          {{x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}}};
}

/// True when nothing of the mesh crosses the segment from a to b.
bool clear(const BuildingMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  return std::none_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Eigen::Vector3i& t) {
    const auto p = [&](int k) -> Eigen::Vector3d { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    Eigen::Matrix3d m;
    m << d, p(0) - p(1), p(0) - p(2);
    if (std::abs(m.determinant()) < 1e-12) return false;
    const Eigen::Vector3d x = m.inverse() * (p(0) - a);
    return x[0] >= 0 && x[0] <= 1 && x[1] >= 0 && x[2] >= 0 && x[1] + x[2] <= 1;
  });
}

TEST(Openings, AsAnOpenShellAreCutByTheirOutline) {
  Sketch sketch;
  sketch.storey(0);
  const std::string wall = sketch.wall(0, 0, 6, thickness, 3);
  sketch.door(sketch.opening(wall, sketch.shell(open_box(1, -0.15, 0, 2, 0.15, 2))));
  const Building building = read(sketch);
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(clear(mesh, {1.5, -1, 1}, {1.5, 1, 1}));
  EXPECT_FALSE(clear(mesh, {2.5, -1, 1}, {2.5, 1, 1}));
  EXPECT_NEAR(mesh.elements.front().volume_m3, (6 * 3 - 2) * thickness, 1e-4);
}

TEST(Openings, OfAWallWhoseBodyDoesNotCloseAreOpenToo) {
  Sketch sketch;
  sketch.storey(0);
  auto faces = open_box(0, -0.1, 0, 6, 0.1, 3);
  faces.erase(faces.begin() + 1);  // at y = -0.1
  const std::string wall = sketch.element("IFCWALL", sketch.wall_shape(sketch.shell(faces), 6), "$,$");
  sketch.door(sketch.opening(wall, sketch.box(1, -0.15, 0, 2, 0.15, 2)));
  const BuildingMesh mesh = build_mesh(read(sketch));
  EXPECT_FALSE(mesh.elements.front().closed);
  EXPECT_TRUE(clear(mesh, {1.5, -1, 1}, {1.5, 1, 1}));
  EXPECT_FALSE(clear(mesh, {2.5, -1, 1}, {2.5, 1, 1}));
  EXPECT_FALSE(clear(mesh, {1.5, 0, 1}, {2.5, 0, 1})) << "the doorway has no side";
}

TEST(Doors, InAWallThatAnotherCoversOpenBoth) {
  Sketch sketch;
  sketch.storey(0);
  const std::string wall = sketch.wall(0, 0, 6, 0.2, 3);
  sketch.wall(0, 0.05, 6, 0.3, 3);  // drawn again, thicker
  sketch.door(sketch.opening(wall, sketch.box(1, -0.1, 0, 2, 0.1, 2)));
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "walls_overlap"), 1);
  EXPECT_TRUE(clear(build_mesh(building), {1.5, -1, 1}, {1.5, 1, 1}));
}

TEST(Doors, WithAWallRunningIntoThemPushItBack) {
  Sketch sketch;
  sketch.storey(0);
  const std::string wall = sketch.wall(0, 0, 6, 0.2, 3);
  sketch.wall(1.9, -0.1, 3, 0.3, 3, true);  // from x 1.75 to 2.05, across the doorway's last 0.25 m
  sketch.door(sketch.opening(wall, sketch.box(1, -0.1, 0, 2, 0.1, 2)));
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "walls_overlap"), 1);
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(clear(mesh, {1.9, -1, 1}, {1.9, 0.09, 1})) << "still filled within the wall";
  EXPECT_FALSE(clear(mesh, {1.9, -1, 1}, {1.9, 1, 1})) << "the other wall stands where it stood";
}

TEST(Doors, AHandsBreadthOffTheirWallAreInIt) {
  for (const double off : {0.0, 0.1, 0.2}) {
    Sketch sketch;
    sketch.storey(0);
    sketch.wall(0, 0, 6, 0.2, 3);
    sketch.element("IFCDOOR", sketch.shape(sketch.box(1, 0.1 + off, 0, 2, 0.15 + off, 2)), "$,$,$,$,$,$");
    const Building building = read(sketch);
    ASSERT_EQ(building.openings.size(), 1u) << off;
    EXPECT_EQ(building.openings.front().kind, OpeningKind::door);
    EXPECT_TRUE(clear(build_mesh(building), {1.5, -1, 1}, {1.5, 1, 1})) << off;
  }
}

TEST(Doors, WhoseOpeningHasNoBodyOpenTheWallTheyStandIn) {
  Sketch sketch;
  sketch.storey(0);
  const std::string wall = sketch.wall(0, 0, 6, 0.2, 3);
  const std::string hole = sketch.rooted("IFCOPENINGELEMENT", "'o',$,$,$,$,$,$");
  sketch.rooted("IFCRELVOIDSELEMENT", "$,$," + wall + "," + hole);
  const std::string door = sketch.element("IFCDOOR", sketch.shape(sketch.box(1, -0.05, 0, 2, 0.05, 2)), "$,$,$,$,$,$");
  sketch.rooted("IFCRELFILLSELEMENT", "$,$," + hole + "," + door);
  const Building building = read(sketch);
  ASSERT_EQ(building.openings.size(), 1u);
  EXPECT_EQ(building.openings.front().kind, OpeningKind::door);
  EXPECT_TRUE(clear(build_mesh(building), {1.5, -1, 1}, {1.5, 1, 1}));
}

TEST(Round, ColumnsAndWallsAreWithinAHundredthOfTheirVolume) {
  Sketch sketch;
  sketch.storey(0);
  const std::string circle = sketch.add("IFCCIRCLEPROFILEDEF(.AREA.,$,$,0.25)");
  sketch.element("IFCCOLUMN", sketch.shape(sketch.extruded(circle, 0, 3)), "$,$");
  // A quarter of a ring from radius 4.8 to 5.
  const auto arc = [&](double r) {
    const std::string base = sketch.add("IFCCIRCLE(" + sketch.add("IFCAXIS2PLACEMENT2D(" + sketch.point(0, 0) + ",$)") +
                                        "," + Sketch::n(r) + ")");
    return sketch.add("IFCTRIMMEDCURVE(" + base + ",(" + sketch.point(r, 0) + "),(" + sketch.point(0, r) +
                      "),.T.,.CARTESIAN.)");
  };
  const auto line = [&](double x0, double y0, double x1, double y1) {
    return sketch.add("IFCPOLYLINE((" + sketch.point(x0, y0) + "," + sketch.point(x1, y1) + "))");
  };
  std::string segments;
  const std::vector<std::pair<std::string, bool>> parts = {
      {arc(5.0), true}, {line(0, 5, 0, 4.8), true}, {arc(4.8), false}, {line(4.8, 0, 5, 0), true}};
  for (const auto& [curve, same] : parts)
    segments += (segments.empty() ? "" : ",") + sketch.add(std::string("IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,") +
                                                           (same ? ".T.," : ".F.,") + curve + ")");
  const std::string outline = sketch.add("IFCCOMPOSITECURVE((" + segments + "),.F.)");
  const std::string ring = sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + outline + ")");
  sketch.element("IFCWALL", sketch.shape(sketch.extruded(ring, 0, 3)), "$,$");
  const BuildingMesh mesh = build_mesh(read(sketch));
  for (const MeshElement& element : mesh.elements) {
    EXPECT_TRUE(element.closed);
    const double truth = element.kind == ElementKind::column ? std::numbers::pi * 0.25 * 0.25 * 3
                                                             : std::numbers::pi / 4 * (5.0 * 5.0 - 4.8 * 4.8) * 3;
    EXPECT_NEAR(element.volume_m3 / truth, 1.0, 0.01);
  }
  EXPECT_EQ(mesh.elements.size(), 2u);
}

TEST(Round, IndexedCurvesAreRead) {
  // A box of 4 x 0.2 with a half circle of radius 0.1 at its end, as IFC4 exporters draw it.
  Sketch sketch;
  sketch.storey(0);
  const std::string points = sketch.add("IFCCARTESIANPOINTLIST2D(((0.,-0.1),(4.,-0.1),(4.1,0.),(4.,0.1),(0.,0.1)))");
  const std::string curve = sketch.add("IFCINDEXEDPOLYCURVE(" + points +
                                       ",(IFCLINEINDEX((1,2)),IFCARCINDEX((2,3,4)),IFCLINEINDEX((4,5,1))),.F.)");
  const std::string profile = sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + curve + ")");
  sketch.element("IFCWALL", sketch.wall_shape(sketch.extruded(profile, 0, 3), 4), "$,$");
  const double truth = (4 * 0.2 + std::numbers::pi / 2 * 0.1 * 0.1) * 3;
  EXPECT_NEAR(wall_volume(sketch) / truth, 1.0, 0.01);
  EXPECT_GT(wall_volume(sketch), 4 * 0.2 * 3 + 0.04);
}

/// Whether anything but windows joins the rooms.
bool joined(const Building& building) {
  return std::any_of(building.openings.begin(), building.openings.end(),
                     [](const Opening& o) { return o.rooms[0] >= 0 && o.rooms[1] >= 0; });
}

TEST(Niches, LeadNowhere) {
  for (const double depth : {0.05, 0.15, 0.22}) {
    for (const bool door : {false, true}) {
      Sketch sketch;
      const std::string wall = two_rooms(sketch);
      const std::string hole = sketch.opening(wall, sketch.box(4.15 - depth, 2, 0, 4.2, 3, 2.1));
      if (door) sketch.door(hole);
      const Building building = read(sketch);
      ASSERT_EQ(building.rooms.size(), 2u);
      EXPECT_FALSE(joined(building)) << depth << door;
      EXPECT_EQ(count(building, "niche"), door ? 1 : 0);
      EXPECT_EQ(count(building, "door_unresolved"), 0);
    }
  }
}

TEST(Niches, ADoorALittleShortOfAFaceIsCutThrough) {
  for (const double y : {4.14, 4.1}) {
    Sketch sketch;
    const std::string wall = two_rooms(sketch);
    sketch.door(sketch.opening(wall, sketch.box(3.84, 2, 0, y, 3, 2.1)));
    const Building building = read(sketch);
    EXPECT_TRUE(joined(building));
    EXPECT_EQ(count(building, "niche"), 1);
    EXPECT_TRUE(clear(build_mesh(building), {3, 2.5, 1}, {5, 2.5, 1})) << y;
  }
}

}  // namespace
}  // namespace plumbline::bim
