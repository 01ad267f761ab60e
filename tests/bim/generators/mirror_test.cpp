// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/mirror.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/furniture/furnish.h"
#include "bim/generators/generators.h"
#include "bim/geometry/polygon.h"
#include "bim/mesh/mesh.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

Building furnished(const std::string& family) {
  Building building = read_plan_text(write_plan(generate(family, read_yaml("{seed: 3}", "options")).plan), "generated");
  FurnishOptions options;
  options.density = 0.15;
  for (Obstacle& piece : furnish(building, options)) building.obstacles.push_back(std::move(piece));
  return building;
}

/// Corners of all triangles, sorted, on a grid of 1 um.
std::vector<std::array<double, 3>> corners(const BuildingMesh& mesh, double side) {
  std::vector<std::array<double, 3>> points;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    points.push_back({std::round(side * vertex.x() * 1e6), std::round(vertex.y() * 1e6), std::round(vertex.z() * 1e6)});
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

class Mirror : public testing::TestWithParam<std::string> {};

TEST_P(Mirror, EveryCornerHasItsImage) {
  const Building building = furnished(GetParam());
  EXPECT_EQ(corners(build_mesh(mirrored(building)), -1.0), corners(build_mesh(building), 1.0));
}

TEST_P(Mirror, BodiesAndOutlinesKeepTheirSense) {
  const Building building = furnished(GetParam()), image = mirrored(building);
  ASSERT_FALSE(image.obstacles.empty());
  for (std::size_t i = 0; i < image.obstacles.size(); ++i)
    EXPECT_NEAR(volume(image.obstacles[i].body), volume(building.obstacles[i].body), 1e-9) << image.obstacles[i].id;
  for (std::size_t i = 0; i < image.rooms.size(); ++i)
    EXPECT_NEAR(signed_area(image.rooms[i].polygon), signed_area(building.rooms[i].polygon), 1e-9);
}

TEST_P(Mirror, TwiceIsTheSame) {
  const Building building = furnished(GetParam()), twice = mirrored(mirrored(building));
  EXPECT_EQ(corners(build_mesh(twice), 1.0), corners(build_mesh(building), 1.0));
}

TEST_P(Mirror, SurvivesIfc) {
  const Building image = mirrored(furnished(GetParam()));
  const Building read = read_ifc_text(write_ifc(image), "image.ifc");
  EXPECT_EQ(read.walls.size(), image.walls.size());
  EXPECT_EQ(read.openings.size(), image.openings.size());
  ASSERT_EQ(read.rooms.size(), image.rooms.size());
  for (std::size_t i = 0; i < read.rooms.size(); ++i)
    EXPECT_LT((centroid(read.rooms[i].polygon) - centroid(image.rooms[i].polygon)).norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Families, Mirror, testing::Values("shapes", "hall", "storeys", "ring", "rot180"),
                         [](const auto& family) { return family.param; });

}  // namespace
}  // namespace plumbline::bim
