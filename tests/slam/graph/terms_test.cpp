// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/terms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "slam/graph/factors.h"
#include "slam/graph/marginal_prior.h"

namespace plumbline::slam {
namespace {

Plane wall(double x, double y, double d) { return {Eigen::Vector3d(x, y, 0.0).normalized(), d}; }

/// A room whose first two walls meet at `angle`.
Graph room_with_corner(double angle) {
  Graph graph;
  for (const Plane& plane :
       {wall(1.0, 0.0, -1.0), wall(std::cos(angle), std::sin(angle), -1.0), wall(0.0, 1.0, -3.0)}) {
    PlaneVertex vertex;
    vertex.plane_M = plane;
    graph.planes.push_back(vertex);
  }
  graph.rooms.emplace_back();
  RoomFactor factor;
  factor.planes = {0, 1, 2};
  factor.corners = {{0, 1}, {1, 2}};
  graph.room_factors.push_back(factor);
  return graph;
}

Values values_of(const Graph& graph) {
  Values values;
  for (int i = 0; i < 3; ++i) {
    const VertexId plane{Layer::plane, i};
    values[plane] = block_of(graph, plane);
  }
  values[{Layer::room, 0}] = block_of(graph, {Layer::room, 0});
  return values;
}

// A trial step may turn a short wall into the direction of its neighbour, where they have no corner.
TEST(Terms, AStepToWhereAFactorHasNoValueCostsTooMuch) {
  FactorSelection all;
  all.room = {0};
  const Graph meets = room_with_corner(0.2), parallel = room_with_corner(0.0);
  const std::vector<Term> terms = make_terms(meets, all, {});
  Ordering ordering;
  for (int i = 0; i < 3; ++i) ordering.add({Layer::plane, i});
  EXPECT_TRUE(std::isfinite(linearize(terms, values_of(meets), ordering, nullptr, {})));
  EXPECT_EQ(linearize(terms, values_of(parallel), ordering, nullptr, {}), std::numeric_limits<double>::infinity());
  Eigen::VectorXd g = Eigen::VectorXd::Zero(ordering.size);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(ordering.size, ordering.size);
  EXPECT_THROW((void)linearize(terms, values_of(parallel), ordering, &g, dense_sink(H)), InternalError);
}

}  // namespace
}  // namespace plumbline::slam
