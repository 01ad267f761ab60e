// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bim/config/visit.h"
#include "bim/errors.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

constexpr std::size_t shapes = EnumNames<FurnitureShape>::names.size();

FurnitureShape shape_of(std::size_t i) { return static_cast<FurnitureShape>(i); }
std::string name_of(std::size_t i) { return std::string(EnumNames<FurnitureShape>::names[i]); }

Eigen::AlignedBox3d box_of(const Solid& solid) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : solid.vertices) box.extend(p);
  return box;
}

/// Triangles that share vertices, as solids of their own.
std::vector<Solid> components(const Solid& solid) {
  std::vector<std::size_t> part(solid.vertices.size());
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Eigen::Vector3i& t : solid.triangles) {
      std::size_t least = part.size();
      for (int i = 0; i < 3; ++i) least = std::min(least, part[static_cast<std::size_t>(t[i])]);
      for (int i = 0; i < 3; ++i) {
        std::size_t& mine = part[static_cast<std::size_t>(t[i])];
        changed = changed || mine != least;
        mine = least;
      }
    }
  }
  std::vector<Solid> all;
  for (std::size_t p = 0; p < part.size(); ++p) {
    Solid one{solid.vertices, {}};
    for (const Eigen::Vector3i& t : solid.triangles)
      if (part[static_cast<std::size_t>(t[0])] == p) one.triangles.push_back(t);
    if (!one.triangles.empty()) all.push_back(std::move(one));
  }
  return all;
}

/// Inside one of the boxes that a piece is made of.
bool is_inside(const Solid& solid, const Eigen::Vector3d& p) {
  bool inside = false;
  for (const Solid& part : components(solid)) {
    const Eigen::AlignedBox3d box = [&] {
      Eigen::AlignedBox3d b;
      for (const Eigen::Vector3i& t : part.triangles)
        for (int i = 0; i < 3; ++i) b.extend(part.vertices[static_cast<std::size_t>(t[i])]);
      return b;
    }();
    inside = inside || box.contains(p);
  }
  return inside;
}

TEST(Shapes, EveryPartIsClosedAndFacesOut) {
  for (std::size_t i = 0; i < shapes; ++i) {
    const Solid solid = furniture_solid(shape_of(i), {1.3, 0.7, 0.9});
    EXPECT_TRUE(is_closed(solid)) << name_of(i);
    const std::vector<Solid> parts = components(solid);
    EXPECT_GE(parts.size(), 3U) << name_of(i);
    double sum = 0.0;
    for (const Solid& part : parts) {
      EXPECT_TRUE(is_closed(part)) << name_of(i);
      EXPECT_GT(volume(part), 0.0) << name_of(i);
      sum += volume(part);
    }
    EXPECT_NEAR(volume(solid), sum, 1e-9) << name_of(i);
  }
}

TEST(Shapes, StayClosedWhenNeighbouringVerticesAreJoined) {
  for (std::size_t i = 0; i < shapes; ++i)
    EXPECT_TRUE(is_closed(welded(furniture_solid(shape_of(i), {1.3, 0.7, 0.9}), 1e-5))) << name_of(i);
}

TEST(Shapes, FillTheAskedSizeAndNoMore) {
  for (std::size_t i = 0; i < shapes; ++i)
    for (const Eigen::Vector3d& size : {Eigen::Vector3d(1.3, 0.7, 0.9), Eigen::Vector3d(0.3, 2.5, 3.0),
                                        Eigen::Vector3d(0.01, 0.01, 0.01), Eigen::Vector3d(50.0, 0.2, 0.4)}) {
      const Eigen::AlignedBox3d box = box_of(furniture_solid(shape_of(i), size));
      EXPECT_LT((box.sizes() - size).cwiseAbs().maxCoeff(), 1e-9) << name_of(i) << " " << size.transpose();
      EXPECT_LT((box.min() + Eigen::Vector3d(0.5 * size.x(), 0.5 * size.y(), 0.0)).cwiseAbs().maxCoeff(), 1e-9)
          << name_of(i);
    }
}

TEST(Shapes, AreHollowWhereBeamsPass) {
  // Below a table, a chair's seat and a desk's top; under a bed; between the boards of a shelf, from the front.
  EXPECT_FALSE(is_inside(furniture_solid(FurnitureShape::table, {1.6, 0.8, 0.75}), {0.0, 0.0, 0.3}));
  EXPECT_TRUE(is_inside(furniture_solid(FurnitureShape::table, {1.6, 0.8, 0.75}), {0.0, 0.0, 0.74}));
  EXPECT_FALSE(is_inside(furniture_solid(FurnitureShape::chair, {0.45, 0.45, 0.9}), {0.0, 0.0, 0.2}));
  EXPECT_FALSE(is_inside(furniture_solid(FurnitureShape::chair, {0.45, 0.45, 0.9}), {0.0, -0.1, 0.7}));
  EXPECT_FALSE(is_inside(furniture_solid(FurnitureShape::desk, {1.6, 0.8, 0.75}), {0.0, -0.1, 0.3}));
  EXPECT_FALSE(is_inside(furniture_solid(FurnitureShape::bed, {1.6, 2.0, 0.9}), {0.0, 0.0, 0.1}));
  EXPECT_FALSE(is_inside(furniture_solid(FurnitureShape::shelf, {1.0, 0.4, 2.0}), {0.0, -0.1, 0.2}));
  EXPECT_TRUE(is_inside(furniture_solid(FurnitureShape::wardrobe, {1.0, 0.6, 2.0}), {0.0, 0.0, 1.0}));
}

TEST(Shapes, HaveTheirBacksAtTheirOwnPlusY) {
  // Highest vertices: back of a chair, headboard, back of a sofa.
  for (const FurnitureShape shape : {FurnitureShape::chair, FurnitureShape::bed, FurnitureShape::sofa}) {
    const Solid solid = furniture_solid(shape, {0.9, 2.0, 0.9});
    for (const Eigen::Vector3d& p : solid.vertices) EXPECT_TRUE(p.z() < 0.9 - 1e-9 || p.y() > 0.3);
  }
}

TEST(Shapes, ArePlacedByCentreYawAndFloor) {
  const Solid own = furniture_solid(FurnitureShape::chair, {0.5, 0.4, 0.9});
  const Solid placed =
      furniture_solid(FurnitureShape::chair, {0.5, 0.4, 0.9}, {3.0, -2.0}, 0.5 * std::numbers::pi, 1.5);
  ASSERT_EQ(own.vertices.size(), placed.vertices.size());
  for (std::size_t i = 0; i < own.vertices.size(); ++i) {
    const Eigen::Vector3d& p = own.vertices[i];
    EXPECT_LT((placed.vertices[i] - Eigen::Vector3d(3.0 - p.y(), -2.0 + p.x(), 1.5 + p.z())).norm(), 1e-12);
  }
}

TEST(Shapes, RefuseWhatIsTooSmall) {
  EXPECT_THROW((void)furniture_solid(FurnitureShape::table, {0.5, 0.001, 0.5}), InternalError);
}

}  // namespace
}  // namespace plumbline::bim
