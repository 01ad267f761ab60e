// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/free_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "slam/rooms/clusters.h"

namespace plumbline::slam {
namespace {

struct Box {
  double x0, y0, x1, y1;
};

/// Free cells of 0.1 m inside any of the boxes.
FreeGrid grid_of(const std::vector<Box>& boxes) {
  FreeGrid grid{{{0.0, 0.0}, 0.1, 160, 120}, {}};
  grid.free.resize(grid.frame.size());
  for (std::size_t k = 0; k < grid.free.size(); ++k) {
    const Eigen::Vector2d p = grid.frame.center(k);
    grid.free[k] = std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) {
      return p.x() > b.x0 && p.x() < b.x1 && p.y() > b.y0 && p.y() < b.y1;
    });
  }
  return grid;
}

/// Two rooms of 4 x 4 m with a door of the given width in a wall of 0.2 m.
FreeGrid two_rooms(double door_m) {
  return grid_of({{1, 1, 5, 5}, {5, 3 - 0.5 * door_m, 5.2, 3 + 0.5 * door_m}, {5.2, 1, 9.2, 5}});
}

std::size_t count(const FreeGrid& grid, Cut cut, Removal removal = Removal::near) {
  ClusterConfig config;
  config.cut = cut;
  config.removal = removal;
  return clusters(grid, config).size();
}

TEST(FreeGraph, OwnsEveryFreeCellAndJoinsNeighbours) {
  const FreeGrid grid = two_rooms(0.9);
  const std::vector<float> distance = distance_transform(grid);
  const FreeGraph graph = free_graph(grid, distance, 0.35);
  for (std::size_t k = 0; k < grid.free.size(); ++k) EXPECT_EQ(graph.owner[k] >= 0, grid.free[k] != 0);
  for (const FreeVertex& v : graph.vertices) EXPECT_EQ(v.distance_m, static_cast<double>(distance[v.cell]));
  for (const FreeEdge& e : graph.edges) {
    EXPECT_LT(e.a, e.b);
    const FreeVertex& a = graph.vertices[static_cast<std::size_t>(e.a)];
    EXPECT_LE(e.distance_m, a.distance_m + 1e-6);  // vertices are the widest points of what they own
  }
  // Sparse: hundreds of cells a vertex in the open.
  EXPECT_LT(graph.vertices.size(), grid.frame.size() / 100);
}

TEST(FreeGraph, EveryVertexOfOnePieceOfFreeSpaceGetsACluster) {
  const FreeGrid grid = two_rooms(0.9);
  const FreeGraph graph = free_graph(grid, distance_transform(grid), 0.35);
  const std::vector<int> cluster = cluster_vertices(graph, 0.8, Removal::near);
  EXPECT_EQ(std::count(cluster.begin(), cluster.end(), -1), 0);
  EXPECT_EQ(std::set<int>(cluster.begin(), cluster.end()).size(), 2U);
}

TEST(FixedCut, PartsRoomsAtADoor) { EXPECT_EQ(count(two_rooms(0.9), Cut::fixed), 2U); }

// As the long paper prints it, the middle of a hall is taken away, its corners stay as clusters of their own, and each
// piece of the middle falls to the nearest of them.
TEST(FixedCut, OfTheLongPaperTearsAHallApart) {
  const FreeGrid hall = grid_of({{1, 1, 13, 5}});
  EXPECT_EQ(count(hall, Cut::fixed, Removal::near), 1U);
  EXPECT_GT(count(hall, Cut::fixed, Removal::far), 1U);
}

// The fixed threshold of 0.8 m does not part what a door wider than 1.6 m joins.
TEST(Cuts, DoorsWiderThanTwiceTheThresholdNeedTheRelativeCut) {
  const FreeGrid grid = two_rooms(2.0);
  EXPECT_EQ(count(grid, Cut::fixed), 1U);
  EXPECT_EQ(count(grid, Cut::watershed), 2U);
}

// A corridor of 1.2 m has no vertex that survives the threshold: it falls to the rooms it joins.
TEST(Cuts, CorridorsNarrowerThanTwiceTheThresholdNeedTheRelativeCut) {
  const FreeGrid grid = grid_of({{1, 1, 5, 5}, {5, 2.5, 5.2, 3.4}, {5.2, 1, 6.4, 11}});
  EXPECT_EQ(count(grid, Cut::fixed), 1U);
  const std::vector<Cluster> found = clusters(grid, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[1].area_m2, 12.0, 0.8);
}

TEST(Cuts, OfNothingFreeAreNone) {
  EXPECT_EQ(count(grid_of({}), Cut::fixed), 0U);
  EXPECT_EQ(count(grid_of({}), Cut::watershed), 0U);
}

}  // namespace
}  // namespace plumbline::slam
