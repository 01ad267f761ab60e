// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/incremental.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "bim/geometry/symmetric.h"
#include "tests/slam/graph/long_walk.h"

namespace plumbline::slam {
namespace {

constexpr VertexId gauge{Layer::keyframe, 0};

OptimizerConfig to_the_end() {
  OptimizerConfig config;
  config.max_iterations = 50;
  config.relative_decrease = 1e-14;
  return config;
}

IncrementalConfig small_window() {
  IncrementalConfig config;
  config.window = 6;
  config.boundary_planes = 5;
  return config;
}

FactorSelection batch(const Graph& graph) {
  const auto all = [](std::size_t n) {
    std::vector<std::size_t> list(n);
    for (std::size_t i = 0; i < n; ++i) list[i] = i;
    return list;
  };
  return {all(graph.pose_factors.size()), all(graph.plane_factors.size()), all(graph.room_factors.size()),
          all(graph.floor_factors.size()), all(graph.duplicate_factors.size())};
}

/// Covariance of `vertices` from a dense information matrix over `ordering`: the wanted blocks of its inverse.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& lower, const Ordering& ordering,
                              const std::vector<VertexId>& vertices) {
  const Eigen::MatrixXd H = lower.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd inverse = H.llt().solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()));
  std::vector<int> rows;
  for (const VertexId v : vertices)
    for (int i = 0; i < tangent_size(v.layer); ++i) rows.push_back(ordering.row.at(v) + i);
  EXPECT_TRUE(inverse.allFinite());
  return inverse(rows, rows);
}

/// Normal equations of all factors of a graph, keyframe 0 held.
struct Whole {
  Ordering ordering;
  Eigen::MatrixXd H;
  explicit Whole(const Graph& graph, const FactorSelection& factors, const MarginalPrior& prior = {}) {
    const std::vector<Term> terms = make_terms(graph, factors, {});
    Values values;
    add_values(graph, terms, values);
    for (const VertexId v : prior.vertices) values.try_emplace(v, block_of(graph, v));
    for (const auto& [vertex, block] : values)
      if (vertex != gauge) ordering.add(vertex);
    H = Eigen::MatrixXd::Zero(ordering.size, ordering.size);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(ordering.size);
    linearize(terms, values, ordering, &g, dense_sink(H));
    add_prior(prior, values, ordering, &g, &H);
  }
};

/// The factors of poses and planes that only a window from keyframe `first` on has; rooms constrain neither, since
/// their centres are free.
FactorSelection since(const Graph& graph, int first) {
  FactorSelection all = batch(graph);
  all.room.clear();
  std::erase_if(all.pose, [&](std::size_t i) { return graph.pose_factors[i].from < first; });
  std::erase_if(all.plane, [&](std::size_t i) { return graph.plane_factors[i].keyframe < first; });
  return all;
}

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).norm() / b.norm(); }

TEST(Incremental, PriorIsTheSchurComplementOfAllThatLeft) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    LongWalkGraph walk(seed, {.keyframes = 30, .noise = 0.01});
    while (!walk.done()) walk.grow();
    IncrementalOptimizer optimizer(small_window(), {});
    optimizer.relinearize(walk.graph);
    const MarginalPrior& prior = optimizer.prior();
    FactorSelection old = batch(walk.graph);
    old.room.clear();
    std::erase_if(old.pose,
                  [&](std::size_t i) { return walk.graph.pose_factors[i].from >= optimizer.first_keyframe(); });
    std::erase_if(old.plane,
                  [&](std::size_t i) { return walk.graph.plane_factors[i].keyframe >= optimizer.first_keyframe(); });
    const Whole whole(walk.graph, old);
    const Eigen::MatrixXd covariance = covariance_of(whole.H, whole.ordering, prior.vertices);
    // Rounding of two inversions of matrices with condition below 1e7 [measured: 1e-12].
    EXPECT_LT(relative_difference(prior.information, covariance.inverse()), 1e-9) << "seed " << seed;
    EXPECT_GE(prior.vertices.size(), 6U);
  }
}

// Where every factor is nearly linear, what a window finds is what all keyframes together find: estimates and
// covariances. Noise of 1e-6 adds up to 1e-5 rad over the walk, which leaves 1e-10 of second order at arms of 1 to 30
// m.
TEST(Incremental, WindowWithItsPriorFindsWhatTheWholeGraphFinds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    LongWalkGraph walk(seed, {.keyframes = 40});
    IncrementalOptimizer optimizer(small_window(), to_the_end());
    while (!walk.done()) {
      walk.grow();
      optimizer.update(walk.graph);
    }
    Graph whole = walk.graph;
    optimize(whole, 1, to_the_end());
    const int first = optimizer.first_keyframe();
    for (std::size_t k = static_cast<std::size_t>(first); k < 40; ++k) {
      const Pose error = whole.keyframes[k].X_MR.inverse() * walk.graph.keyframes[k].X_MR;
      EXPECT_LT(error.t.norm(), 1e-8) << "seed " << seed << " keyframe " << k;
      EXPECT_LT(log_so3(error.q).norm(), 1e-8) << "seed " << seed << " keyframe " << k;
    }
    std::vector<VertexId> newest = {{Layer::keyframe, 39}, {Layer::plane, 0}};
    const Whole all(whole, batch(whole));
    const Whole window(walk.graph, since(walk.graph, first), optimizer.prior());
    EXPECT_LT(relative_difference(covariance_of(window.H, window.ordering, newest),
                                  covariance_of(all.H, all.ordering, newest)),
              1e-3)
        << "seed " << seed;
  }
}

TEST(Incremental, ANewLinearisationChangesNothingWhereAllIsLinear) {
  LongWalkGraph walk(7, {.keyframes = 30});
  IncrementalOptimizer optimizer(small_window(), to_the_end());
  while (!walk.done()) {
    walk.grow();
    optimizer.update(walk.graph);
  }
  Graph again = walk.graph;
  optimizer.solve(again, 1);
  optimizer.relinearize(again);
  optimizer.update(again);
  for (std::size_t k = static_cast<std::size_t>(optimizer.first_keyframe()); k < 30; ++k)
    EXPECT_LT((again.keyframes[k].X_MR.t - walk.graph.keyframes[k].X_MR.t).norm(), 1e-8) << "keyframe " << k;
}

// Five laps past the same walls, which the prior forgets in between.
TEST(Incremental, TheWindowsProblemDoesNotGrow) {
  LongWalkGraph walk(2, {.keyframes = 400, .lap = 80, .walls_a_lap = 40, .noise = 0.002});
  IncrementalOptimizer optimizer(small_window(), {});
  int most_terms = 0, most_rows = 0, revisited_marginalized_plane = 0;
  int early_terms = 0, early_rows = 0;
  while (!walk.done()) {
    walk.grow();
    const OptimizeReport report = optimizer.update(walk.graph);
    revisited_marginalized_plane += optimizer.revisited_marginalized_plane() ? 1 : 0;
    most_terms = std::max(most_terms, report.terms);
    most_rows = std::max(most_rows, static_cast<int>(optimizer.prior().gradient.size()));
    if (walk.graph.keyframes.size() != 60) continue;
    early_terms = most_terms;
    early_rows = most_rows;
  }
  EXPECT_LE(most_terms, early_terms + 1);  // the room's factor comes and goes with its walls
  EXPECT_LE(most_rows, early_rows + 3);
  EXPECT_GT(revisited_marginalized_plane, 100);
}

// A wall that comes back after it was marginalised counts as unknown until the next solve: never better known than all
// measurements together allow, and after the solve exactly as well.
TEST(Incremental, WhatComesBackIsNotCountedTwice) {
  LongWalkGraph walk(3, {.keyframes = 100, .lap = 80, .walls_a_lap = 40});
  IncrementalOptimizer optimizer(small_window(), to_the_end());
  while (!walk.done()) {
    walk.grow();
    optimizer.update(walk.graph);
  }
  const std::vector<VertexId> newest = {{Layer::keyframe, 99}};
  const Whole all(walk.graph, batch(walk.graph));
  const Eigen::MatrixXd best = covariance_of(all.H, all.ordering, newest);
  const auto now = [&] {
    const Whole window(walk.graph, since(walk.graph, optimizer.first_keyframe()), optimizer.prior());
    return covariance_of(window.H, window.ordering, newest);
  };
  const Eigen::MatrixXd late = now();
  EXPECT_GT(symmetric_eigen(Eigen::MatrixXd(late - best)).values(0), -1e-9 * late.norm());
  EXPECT_GT(late.trace(), 1.05 * best.trace());
  optimizer.solve(walk.graph, 1);
  optimizer.relinearize(walk.graph);
  EXPECT_LT(relative_difference(now(), best), 1e-4);
}

TEST(Incremental, SolvesAreSpacedByWhatTheyCost) {
  IncrementalConfig config;
  config.global_solve_share = 0.1;
  config.global_solve_spacing = 4;
  IncrementalOptimizer optimizer(config, {});
  Graph graph;
  for (int k = 0; k < 4; ++k) {
    EXPECT_FALSE(optimizer.solve_is_due(graph));
    graph.keyframes.push_back({});
  }
  EXPECT_TRUE(optimizer.solve_is_due(graph));
  LongWalkGraph walk(1, {.keyframes = 100});
  while (!walk.done()) walk.grow();
  optimizer.solve(walk.graph, 1);
  for (int k = 0; k < 10; ++k) walk.graph.keyframes.push_back(walk.graph.keyframes.back());
  EXPECT_FALSE(optimizer.solve_is_due(walk.graph));  // 10 % of 110
  walk.graph.keyframes.push_back(walk.graph.keyframes.back());
  EXPECT_TRUE(optimizer.solve_is_due(walk.graph));
}

// Along a corridor a face may be seen so weakly that its offset drowns in the information of all else.
TEST(Incremental, WhatNothingDeterminesCanStillBeEliminated) {
  Graph graph;
  graph.keyframes.resize(2);
  graph.keyframes[1].X_MR.t.x() = 0.6;
  graph.pose_factors.push_back({0, 1, graph.keyframes[1].X_MR, Matrix6d::Identity() * 1e6, false});
  for (const int k : {0, 1}) {
    graph.planes.push_back({{Eigen::Vector3d::UnitY(), 1.0}});
    PlaneFactor factor{k, k, {Eigen::Vector3d::UnitY(), 1.0}};
    factor.information = Eigen::Vector3d(1e6, 1e6, 1e-12).asDiagonal();
    graph.plane_factors.push_back(factor);
  }
  graph.duplicate_factors.push_back({.a = 0, .b = 1, .angle_sigma = 1e-3, .offset_sigma = 1e-4});
  const std::vector<Term> terms = make_terms(graph, batch(graph), {});
  const std::vector<VertexId> kept = {{Layer::keyframe, 1}};
  for (const MarginalPrior& prior :
       {marginalize(graph, {}, terms, kept, {gauge}), marginalize_sparse(graph, terms, kept, {gauge})}) {
    ASSERT_EQ(prior.information.rows(), 6);
    EXPECT_TRUE(prior.information.allFinite());
    EXPECT_GE(symmetric_eigen(prior.information).values(0), 0.99e6);  // the step alone gives 1e6
  }
}

}  // namespace
}  // namespace plumbline::slam
