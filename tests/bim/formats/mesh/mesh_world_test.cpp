// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/export.h"
#include "bim/mesh/mesh.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

Building room() {
  return read_plan_text(
      "plan: 1\nstoreys: [{id: g, elevation_m: 1, height_m: 3}]\n"
      "walls:\n"
      "  - {id: south, storey: g, a: [0, 0], b: [6, 0], thickness_m: 0.2}\n"
      "  - {id: east, storey: g, a: [6, 0], b: [6, 4], thickness_m: 0.2}\n"
      "  - {id: north, storey: g, a: [6, 4], b: [0, 4], thickness_m: 0.2}\n"
      "  - {id: west, storey: g, a: [0, 4], b: [0, 0], thickness_m: 0.2}\n"
      "openings: [{id: d, wall: south, kind: door, s_m: 3, width_m: 1, height_m: 2}]\n",
      "room.plan.yaml");
}

std::string written(const std::string& name) {
  const Building building = room();
  return write_mesh(building, build_mesh(building), mesh_format(name));
}

class MeshWorld : public testing::TestWithParam<const char*> {};

/// What is written comes back: same solids, the floor where it was, a slab under it that a robot stands on.
TEST_P(MeshWorld, ComesBackFromWhatWasWritten) {
  const std::string name = std::string("room.") + GetParam();
  const Building world = read_mesh_world(written(name), name);
  const Building source = room();
  EXPECT_EQ(world.schema, "mesh");
  ASSERT_EQ(world.storeys.size(), 1u);
  EXPECT_NEAR(world.storeys[0].elevation_m, 1.0, 1e-5);
  EXPECT_TRUE(world.rooms.empty());
  const auto volume = [](const BuildingMesh& mesh, ElementKind kind) {
    double sum = 0.0;
    for (const MeshElement& e : mesh.elements)
      if (kind == ElementKind::obstacle ? e.kind == kind : e.kind != ElementKind::obstacle) sum += e.volume_m3;
    return sum;
  };
  ASSERT_EQ(world.slabs.size(), 1u);
  // 6.2 m x 4.2 m of floor, in cells of 0.1 m.
  EXPECT_NEAR(signed_area(world.slabs[0].polygon.outer), 6.2 * 4.2, 0.1 * 2 * (6.2 + 4.2));
  EXPECT_LT(world.slabs[0].z1_m, world.storeys[0].elevation_m);
  if (name.ends_with("ply")) return;  // holds no nodes
  const BuildingMesh mine = build_mesh(world), theirs = build_mesh(source);
  EXPECT_EQ(world.obstacles.size(), theirs.elements.size());
  EXPECT_EQ(world.obstacles[0].id, "south");
  // Single precision in the file.
  EXPECT_NEAR(volume(mine, ElementKind::obstacle), volume(theirs, ElementKind::wall), 1e-4);
  for (const MeshElement& e : mine.elements) EXPECT_TRUE(e.closed) << e.id;
}

TEST_P(MeshWorld, CutAnywhereIsReadOrRefused) {
  const std::string name = std::string("room.") + GetParam();
  const std::string whole = written(name);
  const std::size_t points = name.ends_with("glb") ? 200 : 20;  // a process each
  for (std::size_t i = 0; i < points; ++i) {
    try {
      (void)build_mesh(read_mesh_world(whole.substr(0, i * whole.size() / points), name));
    } catch (const InputError&) {
    }
  }
}

TEST_P(MeshWorld, FlippedBytesAreReadOrRefused) {
  const std::string name = std::string("room.") + GetParam();
  const std::string whole = written(name);
  for (std::size_t i = 0; i < 40; ++i) {
    std::string bytes = whole;
    char& c = bytes[i * whole.size() / 40];
    c = static_cast<char>(c ^ (1 << (i % 8)));
    try {
      (void)build_mesh(read_mesh_world(bytes, name));
    } catch (const InputError&) {
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshWorld, testing::Values("glb", "obj", "ply"),
                         [](const auto& test) { return std::string(test.param); });

TEST(MeshFile, DeclaredCountsBeyondMemoryAreRefused) {
  std::string stl(84, '\0');
  for (std::size_t i = 80; i < 84; ++i) stl[i] = '\xff';
  EXPECT_THROW((void)read_mesh_parts(stl, "huge.stl"), InputError);
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4294967295\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_THROW((void)read_mesh_parts(ply + std::string(100, '\1'), "huge.ply"), InputError);
  const std::string glb = std::string("glTF\x02\0\0\0\xff\xff\xff\xff\xff\xff\xff\xffJSON{}", 22);
  EXPECT_THROW((void)read_mesh_parts(glb, "huge.glb"), InputError);
}

TEST(MeshFile, AbsurdCoordinatesAreRefused) {
  for (const char* bad : {"1e30", "nan", "-inf", "1e7"})
    EXPECT_THROW((void)read_mesh_world(std::string("v 0 0 0\nv 1 0 0\nv 1 1 ") + bad + "\nf 1 2 3\n", "a.obj"),
                 InputError)
        << bad;
  EXPECT_THROW((void)read_mesh_world("v 0 0 0\nv 1000 0 0\nv 1000 1000 0\nf 1 2 3\n", "a.obj"), InputError);
}

/// A box seen from inside and outside, as obj; `point` changes its corners.
template <class Point>
std::string hall(double x, double y, double z, Point&& point) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p = point(Eigen::Vector3d((i & 1) * x, (i >> 1 & 1) * y, (i >> 2) * z));
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  }
  for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"}) {
    const std::string f = face;
    text += "f " + f + "\nf " + std::string(f.rbegin(), f.rend()) + "\n";
  }
  return text;
}

std::vector<std::string> kinds_of(const Building& building) {
  std::vector<std::string> kinds;
  for (const Warning& warning : building.warnings) kinds.push_back(warning.kind);
  return kinds;
}

using Kinds = std::vector<std::string>;

TEST(MeshAxes, YUpIsTurned) {
  const auto y_up = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.z(), -p.y()); };
  const Building world = read_mesh_world(hall(12, 8, 3, y_up), "a.obj");
  EXPECT_EQ(kinds_of(world), Kinds({"no_plan", "assumed_up"}));
  EXPECT_NEAR(world.storeys.front().elevation_m, 0.0, 1e-6);
  EXPECT_NEAR(world.storeys.front().height_m, 3.0, 1e-6);
  ASSERT_EQ(world.slabs.size(), 1u);
  EXPECT_NEAR(signed_area(world.slabs.front().polygon.outer), 96.0, 2.5);
}

/// Narrow and high buildings look alike when turned; what may be z up stays.
TEST(MeshAxes, WhatMayBeZUpStays) {
  const auto as_it_is = [](const Eigen::Vector3d& p) { return p; };
  for (const auto& size : {Eigen::Vector3d(12, 8, 3), Eigen::Vector3d(50, 2.4, 3), Eigen::Vector3d(2.4, 50, 3),
                           Eigen::Vector3d(5, 5, 9), Eigen::Vector3d(30, 1.5, 3)})
    EXPECT_EQ(kinds_of(read_mesh_world(hall(size.x(), size.y(), size.z(), as_it_is), "a.obj")), Kinds({"no_plan"}))
        << size.transpose();
}

TEST(MeshAxes, AMeshTooLargeForMetresIsInASmallerUnit) {
  for (const double scale : {1000.0, 100.0, 1.0 / 0.0254}) {
    const auto scaled = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(scale * p); };
    const Building world = read_mesh_world(hall(12, 8, 3, scaled), "a.obj");
    EXPECT_EQ(kinds_of(world), Kinds({"no_plan", "assumed_unit"}));
    EXPECT_NEAR(world.storeys.front().height_m, 3.0, scale > 50.0 ? 1e-4 : 0.1) << scale;
  }
}

TEST(MeshAxes, FeetAreToldWhereNoSmallerUnitFits) {
  const auto in_feet = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p / 0.3048); };
  const Building world = read_mesh_world(hall(200, 100, 8, in_feet), "a.obj");
  EXPECT_EQ(kinds_of(world), Kinds({"no_plan", "assumed_unit"}));
  EXPECT_NEAR(world.storeys.front().height_m, 8.0, 1e-3);
}

TEST(MeshAxes, AMeshTooHighForMetresIsInASmallerUnit) {
  for (const auto& [per_m, x, y] : {std::tuple(100.0, 3.8, 3.5), {1.0 / 0.0254, 9.5, 7.0}}) {
    const auto scaled = [per = per_m](const Eigen::Vector3d& p) { return Eigen::Vector3d(per * p); };
    const Building small = read_mesh_world(hall(x, y, 2.7, scaled), "a.obj");
    EXPECT_EQ(kinds_of(small), Kinds({"no_plan", "assumed_unit"})) << per_m;
    EXPECT_NEAR(small.storeys.front().height_m, 2.7, 0.01) << per_m;
  }
}

/// Neither a house nor anything else: what it says stays.
TEST(MeshAxes, AMeshTooHighForAnyUnitStaysInMetres) {
  const auto as_it_is = [](const Eigen::Vector3d& p) { return p; };
  const Building mast = read_mesh_world(hall(4, 4, 130, as_it_is), "a.obj");
  EXPECT_EQ(kinds_of(mast), Kinds({"no_plan", "assumed_unit"}));
  EXPECT_NEAR(mast.storeys.front().height_m, 130.0, 1e-3);
}

/// Floors and outer walls as boxes, in units of which one is `per_m` of a metre.
std::string storeys_of(double x, double y, double storey, int storeys, double per_m) {
  std::string text;
  int corners = 0;
  const auto box = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d p(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
      text += "v " + std::to_string(per_m * p.x()) + " " + std::to_string(per_m * p.y()) + " " +
              std::to_string(per_m * p.z()) + "\n";
    }
    for (const auto& f :
         {std::array{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}) {
      text += "f";
      for (const int k : f) text += " " + std::to_string(corners + k);
      text += "\n";
    }
    corners += 8;
  };
  const double top = storey * storeys;
  for (int i = 0; i <= storeys; ++i) box({0, 0, storey * i - 0.2}, {x, y, storey * i});
  box({0, 0, 0}, {0.2, y, top});
  box({x - 0.2, 0, 0}, {x, y, top});
  box({0, 0, 0}, {x, 0.2, top});
  box({0, y - 0.2, 0}, {x, y, top});
  return text;
}

/// In millimetres it would be a building, too, of storeys of 0.3 m.
TEST(MeshAxes, StoreysTellTheUnitWhereSeveralFit) {
  for (const double per_m : {100.0, 1000.0}) {
    const Building world = read_mesh_world(storeys_of(60, 40, 3, 8, per_m), "a.obj");
    double height = 0.0;
    for (const Eigen::Vector3d& p : build_mesh(world).vertices) height = std::max(height, p.z());
    EXPECT_NEAR(height, 24.0, 0.01) << per_m;
  }
}

/// Its walls speak for centimetres, its height for millimetres.
TEST(MeshAxes, WallsTellTheUnitOfAHighHallAndTheOthersAreNamed) {
  const Building world = read_mesh_world(storeys_of(60, 40, 24, 1, 100.0), "a.obj");
  const auto said = std::find_if(world.warnings.begin(), world.warnings.end(),
                                 [](const Warning& w) { return w.kind == "assumed_unit"; });
  ASSERT_NE(said, world.warnings.end());
  EXPECT_NE(said->text.find("in the unit centimetre; in the unit inch or millimetre it "), std::string::npos)
      << said->text;
  EXPECT_NE(said->text.find("would be a building as well"), std::string::npos) << said->text;
}

TEST(MeshAxes, ATowerOfUsualStoreysStaysInMetres) {
  const Building tower = read_mesh_world(storeys_of(40, 40, 3, 50, 1.0), "a.obj");
  EXPECT_EQ(kinds_of(tower), Kinds({"no_plan"}));
}

TEST(MeshFile, NoTrianglesOrNoFloorIsSaid) {
  EXPECT_THROW((void)read_mesh_world("", "a.obj"), InputError);
  EXPECT_THROW((void)read_mesh_world("v 0 0 0\nv 1 0 0\nl 1 2\n", "a.obj"), InputError);
  EXPECT_THROW((void)read_mesh_world("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 3 2 1\n", "a.obj"), InputError);
}

constexpr const char* dae_node =
    R"(<node name="a"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node>)";

/// A triangle with these nodes and indices of corners.
std::string dae(const std::string& nodes, const std::string& corners) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)"
         R"(<unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p">)"
         R"(<float_array id="f" count="9">0 0 0 4 0 0 4 4 0</float_array><technique_common>)"
         R"(<accessor source="#f" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>)"
         R"(<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">)"
         R"(<input semantic="POSITION" source="#p"/></vertices><triangles count="1">)"
         R"(<input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         corners +
         R"(</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">)" +
         nodes + R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST(MeshFile, NoNameOfAnExceptionLeaks) {
  EXPECT_EQ(read_mesh_parts(dae(dae_node, "0 1 2"), "a.dae").size(), 1U);
  for (const char* corners : {"0 1 *", "0 * 2", "0 1 99999999999999999999"}) {
    const std::string text = input_error([&] { static_cast<void>(read_mesh_parts(dae(dae_node, corners), "a.dae")); });
    EXPECT_EQ(text.rfind("a.dae: ", 0), 0U) << corners << ": " << text;
    EXPECT_EQ(text.find("::"), std::string::npos) << corners << ": " << text;
    EXPECT_EQ(text.find("bad_alloc"), std::string::npos) << corners << ": " << text;
  }
}

TEST(MeshFile, EqualNamesAreToldApart) {
  const std::string two = dae(std::string(dae_node) + dae_node, "0 1 2");
  const std::vector<MeshPart> parts = read_mesh_parts(two, "a.dae");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NE(parts[0].name, parts[1].name);
  // Z_UP in the file is up in W.
  for (const Eigen::Vector3d& p : parts[0].solid.vertices) EXPECT_NEAR(p.z(), 0.0, 1e-9);
}

}  // namespace
}  // namespace plumbline::bim
