// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/graph_json.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bim/errors.h"
#include "tests/slam/graph/graph_reader.h"
#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

template <int N>
Eigen::Matrix<double, N, N> random_information(RandomValues& random) {
  Eigen::Matrix<double, N, N> A;
  for (int i = 0; i < N * N; ++i) A(i) = random.gauss();
  const Eigen::Matrix<double, N, N> product = A * A.transpose() + Eigen::Matrix<double, N, N>::Identity();
  return 0.5 * (product + product.transpose());
}

/// Vertices and factors of every kind, with numbers of every size.
Graph random_graph(std::uint64_t tick) {
  RandomValues random(11, tick);
  Graph graph;
  for (int k = 0; k < 3; ++k) {
    graph.keyframes.push_back({k * 123'456'789LL, random.pose(1e3, 1.0), random.pose(1e-9, 1.0), k % 2});
    graph.planes.push_back(
        {random.wall(random.uniform(-3, 3), 1e4 * random.gauss()), static_cast<PlaneKind>(k), k, -1});
    graph.rooms.push_back({static_cast<RoomKind>(k), random.vector(9.0).head<2>(), k, k != 1});
    graph.floors.push_back({random.vector(9.0).head<2>(), k, k - 1});
  }
  graph.planes.push_back({random.wall(0.1, 0.0), PlaneKind::wall, 0, 1});
  graph.pose_factors.push_back({0, 1, random.pose(1.0, 0.1), random_information<6>(random), false});
  graph.pose_factors.push_back({0, 2, random.pose(1.0, 0.1), random_information<6>(random), true});
  graph.plane_factors.push_back({2, 3, random.wall(1.0, 2.0), random_information<3>(random)});
  graph.room_factors.push_back({0, {0, 1, 2, 3}, {0.1, 0.2}, 0.3, random_information<2>(random)});
  graph.room_factors.push_back({1, {1, 3}, {0.1, 0.2}, 0.3, random_information<2>(random)});
  graph.room_factors.push_back(
      {2, {3, 1, 0}, {0.1, 0.2}, 0.3, random_information<2>(random), {{0, 1}, {1, 2}, {2, 0}}});
  graph.floor_factors.push_back({0, 2, {1.0 / 3.0, -0.1}, random_information<2>(random)});
  graph.duplicate_factors.push_back({0, 3, random.vector(5.0), 0.011, 1e-3});
  return graph;
}

TEST(GraphJson, ReadsBackToTheLastBit) {
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    const Graph graph = random_graph(tick);
    const std::string text = write_graph_json(graph);
    const Graph again = read_graph_json(text, "graph.json");
    EXPECT_EQ(write_graph_json(again), text);
    EXPECT_EQ(digest_of(again), digest_of(graph));
    ASSERT_EQ(again.pose_factors.size(), graph.pose_factors.size());
    EXPECT_EQ(again.pose_factors[1].information, graph.pose_factors[1].information);
    EXPECT_EQ(again.keyframes[2].X_OR.t, graph.keyframes[2].X_OR.t);
    EXPECT_EQ(again.room_factors[0].planes, graph.room_factors[0].planes);
    EXPECT_EQ(again.room_factors[2].corners, graph.room_factors[2].corners);
    EXPECT_EQ(again.rooms[2].kind, RoomKind::polygon);
    EXPECT_EQ(again.rooms[1].found, graph.rooms[1].found);
    EXPECT_EQ(again.planes[3].merged_into, 1);
  }
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = write_graph_json(random_graph(1));
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(GraphJson, WhatNamesNoVertexOrIsNoValueIsRefused) {
  const std::vector<std::string> bad = {
      with("\"graph\":1", "\"graph\":2"),
      with("\"loop\":true", "\"loop\":3"),
      with("\"from\":0", "\"from\":3"),
      with("\"from\":0", "\"from\":-1"),
      with("\"keyframe\":2", "\"keyframe\":99999999999"),
      with("\"planes\":[0,1,2,3]", "\"planes\":[0,1,2]"),
      with("\"planes\":[0,1,2,3]", "\"planes\":[0,1,2,4]"),
      with("\"merged_into\":1", "\"merged_into\":4"),
      with("\"kind\":\"ceiling\"", "\"kind\":\"roof\""),
      with("\"height_M\":0.3", "\"height_M\":1e999"),
      with("\"angle_sigma\":0.011", "\"angle_sigma\":0"),
      with("\"center_M\":[", "\"center_M\":[1,"),
      with("\"X_MR\":[", "\"X_RM\":["),
      with("\"information\":[", "\"information\":[-"),
      "{}",
      "[]",
      "{\"graph\":1}",
  };
  for (const std::string& text : bad)
    EXPECT_THROW((void)read_graph_json(text, "graph.json"), InputError) << text.substr(0, 200);
}

TEST(GraphJson, DirectionsHaveLengthOne) {
  Graph graph = random_graph(2);
  graph.planes[0].plane_M.n *= 1.1;
  EXPECT_THROW((void)read_graph_json(write_graph_json(graph), "graph.json"), InputError);
  graph = random_graph(2);
  graph.keyframes[0].X_MR.q.coeffs() *= 0.9;
  EXPECT_THROW((void)read_graph_json(write_graph_json(graph), "graph.json"), InputError);
}

}  // namespace
}  // namespace plumbline::slam
