// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/arrangement.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/random/stream.h"
#include "tests/slam/rooms/scene.h"

namespace plumbline::slam {
namespace {

/// Lines at random places and headings across a room of 8 x 6 m.
std::vector<FaceLine> random_lines(const Scene& scene, std::uint64_t trial) {
  const Stream stream(3, "bim.generate");
  std::vector<FaceLine> lines;
  for (std::uint32_t k = 0; k < 6; ++k) {
    const double a = 2.0 * std::numbers::pi * stream.uniform(trial, 3 * k);
    const Eigen::Vector2d at(8.0 * stream.uniform(trial, 3 * k + 1), 6.0 * stream.uniform(trial, 3 * k + 2));
    lines.push_back(cut_line({std::cos(a), std::sin(a)}, scene.to_M(at)));
  }
  return lines;
}

TEST(Arrangement, PiecesTileTheRoomAndLieBesideEachOther) {
  Scene scene{{{0, 0, 8, 6}}, {}, {}, 0.4};
  scene.enclose({0, 0, 8, 6});
  const FreeGrid grid = scene.grid();
  const std::vector<Cluster> found = clusters(grid, {});
  ASSERT_EQ(found.size(), 1U);
  std::vector<FaceLine> walls;
  for (const PlaneNode& wall : scene.walls()) walls.push_back(face_line(wall));
  const RoomConfig config;
  const ClusterWalls cluster_walls = make_cluster_walls(grid, found[0], walls, config);
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    std::vector<FaceLine> lines = walls;
    for (const FaceLine& line : random_lines(scene, trial)) lines.push_back(line);
    const Arrangement arrangement(cluster_walls, lines);
    double area = 0.0;
    for (const auto& [sides, piece] : arrangement.pieces()) {
      area += area_of(piece);
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (const Edge& edge : piece) middle += edge.from / static_cast<double>(piece.size());
      EXPECT_EQ(arrangement.piece_at(middle), sides);
      for (const Edge& edge : piece) {
        const auto other = arrangement.pieces().find(Arrangement::behind(sides, edge));
        if (other == arrangement.pieces().end()) continue;
        EXPECT_TRUE(std::any_of(other->second.begin(), other->second.end(), [&](const Edge& e) {
          return (e.from - edge.to).norm() < 1e-6 && (e.to - edge.from).norm() < 1e-6;
        }));
      }
    }
    EXPECT_NEAR(area, 48.0, 1.0);  // slivers narrower than a cell do not count
    EXPECT_EQ(arrangement.components([](const Edge&) { return true; }).size(), 1U);
    EXPECT_EQ(arrangement.components([](const Edge&) { return false; }).size(), arrangement.pieces().size());
  }
}

}  // namespace
}  // namespace plumbline::slam
