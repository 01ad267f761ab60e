// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"
#include "bim/symmetry/symmetry.h"

namespace plumbline::bim {
namespace {

Building one_room() {
  return read_plan_text(
      "plan: 1\nstoreys: [{id: ground, elevation_m: 0, height_m: 3}]\nwalls:\n"
      "  - {id: s, storey: ground, a: [0, 0], b: [6, 0], thickness_m: 0.2}\n"
      "  - {id: e, storey: ground, a: [6, 0], b: [6, 4], thickness_m: 0.2}\n"
      "  - {id: n, storey: ground, a: [6, 4], b: [0, 4], thickness_m: 0.2}\n"
      "  - {id: w, storey: ground, a: [0, 4], b: [0, 0], thickness_m: 0.2}\n"
      "rooms: [{id: hall, storey: ground, polygon: [[0, 0], [6, 0], [6, 4], [0, 4]]}]\n",
      "room.plan.yaml");
}

// A mesh of a whole building in one piece: of its inside nothing is known, and its convex outline is no wall.
TEST(HollowBody, OneBodyAroundTheStoreyIsNotCompared) {
  const Building flat = one_room();
  Building piece = flat;
  piece.walls.clear();
  Obstacle shell;
  shell.id = "shell";
  const auto add = [&](double x0, double y0, double x1, double y1, double z0, double z1) {
    const Solid body = extrude(unite(std::vector<Polygon2>{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}}), z0, z1);
    const auto first = static_cast<int>(shell.body.vertices.size());
    shell.body.vertices.insert(shell.body.vertices.end(), body.vertices.begin(), body.vertices.end());
    for (const Eigen::Vector3i& t : body.triangles) shell.body.triangles.emplace_back(t.array() + first);
  };
  add(0.0, 0.0, 6.0, 0.2, 0.0, 3.0);
  add(0.0, 3.8, 6.0, 4.0, 0.0, 3.0);
  add(0.0, 0.2, 0.2, 3.8, 0.0, 3.0);
  add(5.8, 0.2, 6.0, 3.8, 0.0, 3.0);
  add(0.0, 0.0, 6.0, 4.0, 2.8, 2.9);
  piece.obstacles.push_back(shell);
  ASSERT_FALSE(analyse_symmetry(flat).storeys.empty());
  const SymmetryReport report = analyse_symmetry(piece);
  EXPECT_TRUE(report.storeys.empty());
  EXPECT_TRUE(report.building.empty());
  EXPECT_EQ(report.left_out, std::vector<std::string>{"shell"});
  EXPECT_TRUE(analyse_symmetry(flat).left_out.empty());
}

}  // namespace
}  // namespace plumbline::bim
