// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/optimize.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <memory>

#include "bim/errors.h"
#include "slam/graph/cost_functions.h"

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
    if (marked(scope.keyframes, f.keyframe)) mark(scope.planes, f.plane);
  for (const RoomFactor& f : graph.room_factors)
    if (std::any_of(f.planes.begin(), f.planes.end(), [&](int p) { return marked(scope.planes, p); }))
      mark(scope.rooms, f.room);
  for (const FloorFactor& f : graph.floor_factors)
    if (marked(scope.rooms, f.room)) mark(scope.floors, f.floor);
  return scope;
}

/// The graph's values as flat parameter blocks, and the problem over them.
class Builder {
 public:
  Builder(const Graph& graph, const Scope& scope, const OptimizerConfig& config)
      : graph_(graph), scope_(scope), config_(config) {
    for (const KeyframeVertex& k : graph.keyframes) keyframes_.push_back(to_block(k.X_MR));
    for (const PlaneVertex& p : graph.planes) planes_.push_back(to_block(p.plane_M));
    for (const RoomVertex& r : graph.rooms) rooms_.push_back({r.center_M.x(), r.center_M.y()});
    for (const FloorVertex& f : graph.floors) floors_.push_back({f.center_M.x(), f.center_M.y()});
  }

  void build() {
    add_blocks();
    add_pose_factors();
    add_plane_factors();
    add_room_factors();
    add_floor_factors();
    add_duplicate_factors();
  }

  [[nodiscard]] ceres::Problem& problem() { return problem_; }

  void write_back(Graph& graph) const {
    for (std::size_t k = 0; k < keyframes_.size(); ++k)
      if (scope_.keyframes[k]) graph.keyframes[k].X_MR = to_pose(keyframes_[k].data());
    for (std::size_t p = 0; p < planes_.size(); ++p)
      if (scope_.planes[p]) graph.planes[p].plane_M = to_plane(planes_[p].data());
    for (std::size_t r = 0; r < rooms_.size(); ++r)
      if (scope_.rooms[r]) graph.rooms[r].center_M = Eigen::Vector2d(rooms_[r][0], rooms_[r][1]);
    for (std::size_t f = 0; f < floors_.size(); ++f)
      if (scope_.floors[f]) graph.floors[f].center_M = Eigen::Vector2d(floors_[f][0], floors_[f][1]);
  }

 private:
  template <class Blocks>
  double* block(Blocks& blocks, int id) {
    return blocks[static_cast<std::size_t>(id)].data();
  }
  [[nodiscard]] static bool in(const std::vector<bool>& set, int id) { return set[static_cast<std::size_t>(id)]; }

  // Blocks are added layer by layer in order of ids, so that the elimination order does not depend on the factors.
  void add_blocks() {
    for (PoseBlock& b : keyframes_) problem_.AddParameterBlock(b.data(), 7, &pose_manifold_);
    for (PlaneBlock& b : planes_) problem_.AddParameterBlock(b.data(), 4, &plane_manifold_);
    for (CenterBlock& b : rooms_) problem_.AddParameterBlock(b.data(), 2);
    for (CenterBlock& b : floors_) problem_.AddParameterBlock(b.data(), 2);
    fix(keyframes_, scope_.keyframes);
    fix(planes_, scope_.planes);
    fix(rooms_, scope_.rooms);
    fix(floors_, scope_.floors);
  }
  template <class Blocks>
  void fix(Blocks& blocks, const std::vector<bool>& free) {
    for (std::size_t i = 0; i < blocks.size(); ++i)
      if (!free[i]) problem_.SetParameterBlockConstant(blocks[i].data());
  }

  void add_pose_factors() {
    for (const PoseFactor& f : graph_.pose_factors) {
      if (!in(scope_.keyframes, f.from) && !in(scope_.keyframes, f.to)) continue;
      problem_.AddResidualBlock(pose_cost(f), f.loop ? &loop_loss_ : nullptr, block(keyframes_, f.from),
                                block(keyframes_, f.to));
    }
  }
  void add_plane_factors() {
    for (const PlaneFactor& f : graph_.plane_factors)
      if (in(scope_.planes, f.plane))
        problem_.AddResidualBlock(plane_cost(f), &loss_, block(keyframes_, f.keyframe), block(planes_, f.plane));
  }
  void add_room_factors() {
    for (const RoomFactor& f : graph_.room_factors) {
      if (!in(scope_.rooms, f.room)) continue;
      std::vector<double*> blocks = {block(rooms_, f.room)};
      for (const int p : f.planes) blocks.push_back(block(planes_, p));
      problem_.AddResidualBlock(room_cost(f), &loss_, blocks);
    }
  }
  void add_floor_factors() {
    for (const FloorFactor& f : graph_.floor_factors)
      if (in(scope_.floors, f.floor))
        problem_.AddResidualBlock(floor_cost(f), nullptr, block(floors_, f.floor), block(rooms_, f.room));
  }
  void add_duplicate_factors() {
    for (const DuplicateFactor& f : graph_.duplicate_factors)
      if (in(scope_.planes, f.a) || in(scope_.planes, f.b))
        problem_.AddResidualBlock(duplicate_cost(f), &loss_, block(planes_, f.a), block(planes_, f.b));
  }

  static ceres::Problem::Options options() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  const Graph& graph_;
  const Scope& scope_;
  const OptimizerConfig config_;
  PoseManifold pose_manifold_;
  PlaneManifold plane_manifold_;
  ceres::HuberLoss loss_{config_.huber};
  ceres::HuberLoss loop_loss_{config_.loop_huber};
  std::vector<PoseBlock> keyframes_;
  std::vector<PlaneBlock> planes_;
  std::vector<CenterBlock> rooms_, floors_;
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
  Builder builder(graph, scope, config);
  builder.build();
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(config), &builder.problem(), &summary);
  if (!summary.IsSolutionUsable()) throw InternalError("graph optimisation failed: " + summary.message);
  builder.write_back(graph);
  return {static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost,
          static_cast<int>(std::count(scope.keyframes.begin(), scope.keyframes.end(), true))};
}

}  // namespace plumbline::slam
