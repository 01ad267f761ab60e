// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/optimize.h"

#include <ceres/ceres.h>

#include <algorithm>

#include "bim/errors.h"
#include "slam/graph/cost_functions.h"
#include "slam/graph/terms.h"

namespace plumbline::slam {

namespace {

/// Which vertices may move.
struct Scope {
  std::vector<bool> keyframes, planes, rooms, floors;
};

Scope make_scope(const Graph& graph, int first_free) {
  Scope scope{std::vector<bool>(graph.keyframes.size()), std::vector<bool>(graph.planes.size()),
              std::vector<bool>(graph.rooms.size()), std::vector<bool>(graph.floors.size())};
  const auto mark = [](std::vector<bool>& set, int id) { set[static_cast<std::size_t>(id)] = true; };
  const auto marked = [](const std::vector<bool>& set, int id) { return set[static_cast<std::size_t>(id)]; };
  for (std::size_t k = static_cast<std::size_t>(std::max(first_free, 1)); k < graph.keyframes.size(); ++k)
    scope.keyframes[k] = true;
  for (const PlaneFactor& f : graph.plane_factors)
    if (marked(scope.keyframes, f.keyframe) && !graph.planes[static_cast<std::size_t>(f.plane)].fixed)
      mark(scope.planes, f.plane);
  for (const RoomFactor& f : graph.room_factors)
    if (std::any_of(f.planes.begin(), f.planes.end(), [&](int p) { return marked(scope.planes, p); }))
      mark(scope.rooms, f.room);
  for (const FloorFactor& f : graph.floor_factors)
    if (marked(scope.rooms, f.room)) mark(scope.floors, f.floor);
  return scope;
}

/// The factors that bear on what may move.
FactorSelection select(const Graph& graph, const Scope& scope) {
  const auto in = [](const std::vector<bool>& set, int id) { return set[static_cast<std::size_t>(id)]; };
  const auto indices = [](const auto& factors, const auto& wanted) {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < factors.size(); ++i)
      if (wanted(factors[i])) list.push_back(i);
    return list;
  };
  return {
      .pose = indices(graph.pose_factors,
                      [&](const PoseFactor& f) { return in(scope.keyframes, f.from) || in(scope.keyframes, f.to); }),
      .plane =
          indices(graph.plane_factors,
                  [&](const PlaneFactor& f) { return in(scope.planes, f.plane) || in(scope.keyframes, f.keyframe); }),
      .room = indices(graph.room_factors, [&](const RoomFactor& f) { return in(scope.rooms, f.room); }),
      .floor = indices(graph.floor_factors, [&](const FloorFactor& f) { return in(scope.floors, f.floor); }),
      .duplicate = indices(graph.duplicate_factors,
                           [&](const DuplicateFactor& f) { return in(scope.planes, f.a) || in(scope.planes, f.b); })};
}

bool free(const Scope& scope, VertexId vertex) {
  const auto id = static_cast<std::size_t>(vertex.id);
  switch (vertex.layer) {
    case Layer::keyframe:
      return scope.keyframes[id];
    case Layer::plane:
      return scope.planes[id];
    case Layer::room:
      return scope.rooms[id];
    case Layer::floor:
      return scope.floors[id];
  }
  return false;
}

/// Terms and values as a Ceres problem, which refers to them.
class CeresProblem {
 public:
  CeresProblem(const std::vector<Term>& terms, Values& values, const Scope& scope, const OptimizerConfig& config)
      : loss_(config.huber), loop_loss_(config.loop_huber) {
    // Layer by layer in order of ids, so that the elimination order does not depend on the factors.
    for (auto& [vertex, block] : values) {
      problem_.AddParameterBlock(block.data(), block_size(vertex.layer), manifold(vertex.layer));
      if (!free(scope, vertex)) problem_.SetParameterBlockConstant(block.data());
    }
    for (const Term& term : terms) {
      std::vector<double*> blocks;
      for (const VertexId vertex : term.vertices) blocks.push_back(values.at(vertex).data());
      const bool loop = term.vertices.back().layer == Layer::keyframe;
      problem_.AddResidualBlock(term.cost.get(), term.huber > 0.0 ? (loop ? &loop_loss_ : &loss_) : nullptr, blocks);
    }
  }
  [[nodiscard]] ceres::Problem& problem() { return problem_; }

 private:
  static int block_size(Layer layer) { return layer == Layer::keyframe ? 7 : layer == Layer::plane ? 4 : 2; }
  ceres::Manifold* manifold(Layer layer) {
    if (layer == Layer::keyframe) return &pose_manifold_;
    return layer == Layer::plane ? &plane_manifold_ : nullptr;
  }
  static ceres::Problem::Options options() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  PoseManifold pose_manifold_;
  PlaneManifold plane_manifold_;
  ceres::HuberLoss loss_, loop_loss_;
  ceres::Problem problem_{options()};
};

ceres::Solver::Options solver_options(const OptimizerConfig& config) {
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.dense_linear_algebra_library_type = ceres::EIGEN;
  options.max_num_iterations = config.max_iterations;
  options.function_tolerance = config.relative_decrease;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

OptimizeReport optimize(Graph& graph, int first_free, const OptimizerConfig& config) {
  const Scope scope = make_scope(graph, first_free);
  const std::vector<Term> terms = make_terms(graph, select(graph, scope), config);
  Values values;
  add_values(graph, terms, values);
  CeresProblem problem(terms, values, scope, config);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(config), &problem.problem(), &summary);
  if (!summary.IsSolutionUsable()) throw InternalError("graph optimisation failed: " + summary.message);
  for (const auto& [vertex, block] : values)
    if (free(scope, vertex)) write_back(vertex, block, graph);
  return {static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost,
          static_cast<int>(std::count(scope.keyframes.begin(), scope.keyframes.end(), true)),
          static_cast<int>(terms.size())};
}

}  // namespace plumbline::slam
