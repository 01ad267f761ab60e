// SPDX-License-Identifier: Apache-2.0
#include "bim/model/upward_faces.h"

#include <gtest/gtest.h>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"

namespace plumbline::bim {
namespace {

double plan_m2(const UpwardFace& face) { return area(unite(face.triangles)); }

TEST(UpwardFaces, ABoxHasOne) {
  const Solid box = extrude({{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}}}, -0.2, 0.5);
  const std::vector<UpwardFace> faces = upward_faces(box);
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_EQ(faces[0].z0_m, 0.5);
  EXPECT_EQ(faces[0].top_m, 0.5);
  EXPECT_TRUE(faces[0].slope.isZero(0.0));
  EXPECT_NEAR(plan_m2(faces[0]), 12.0, 1e-9);
}

/// A surface over n x n squares of this size.
template <class Height>
Solid surface(int n, double cell, Height&& height) {
  Solid body;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) body.vertices.emplace_back(cell * i, cell * j, height(i, j));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      body.triangles.emplace_back(a, b, b + 1);
      body.triangles.emplace_back(a, b + 1, a + 1);
    }
  return body;
}

/// However finely it is cut.
TEST(UpwardFaces, ARampIsOne) {
  const std::vector<UpwardFace> faces = upward_faces(surface(40, 0.05, [](int i, int) { return 0.01 * i; }));
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_NEAR(faces[0].slope.x(), 0.2, 1e-9);
  EXPECT_NEAR(faces[0].top_m, 0.4, 1e-9);
  EXPECT_NEAR(plan_m2(faces[0]), 4.0, 1e-9);
}

/// A bowl of 2 m: its planes follow it.
TEST(UpwardFaces, SmallTrianglesOfAnUnevenSurfaceAreJoined) {
  const auto bowl = [](double x, double y) { return 0.1 * ((x - 1.0) * (x - 1.0) + (y - 1.0) * (y - 1.0)); };
  const Solid body = surface(40, 0.05, [&](int i, int j) { return bowl(0.05 * i, 0.05 * j); });
  double sum = 0.0;
  const std::vector<UpwardFace> faces = upward_faces(body);
  EXPECT_LT(faces.size(), 40u);
  for (const UpwardFace& face : faces) {
    sum += plan_m2(face);
    for (const Polygon2& triangle : face.triangles) {
      const Eigen::Vector2d p = triangle.front();
      EXPECT_NEAR(face.z0_m + face.slope.dot(p), bowl(p.x(), p.y()), 0.02);
    }
  }
  EXPECT_NEAR(sum, 4.0, 1e-3);
}

/// Slivers beside a level face are no surface of their own.
TEST(UpwardFaces, AChamferIsNotJoined) {
  Solid body = surface(1, 2.0, [](int, int) { return 0.0; });
  body.vertices.emplace_back(2.002, 0.0, -0.0006);
  body.vertices.emplace_back(2.002, 2.0, -0.0006);
  body.triangles.emplace_back(2, 4, 5);
  body.triangles.emplace_back(2, 5, 3);
  const std::vector<UpwardFace> faces = upward_faces(body);
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_NEAR(plan_m2(faces[0]) + plan_m2(faces[1]), 4.004, 1e-6);
}

}  // namespace
}  // namespace plumbline::bim
