// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/incremental.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr VertexId gauge{Layer::keyframe, 0};

/// Index of the first factor whose newest keyframe is not before `keyframe`.
std::size_t first_pose_factor(const Graph& graph, int keyframe) {
  const auto& f = graph.pose_factors;
  return static_cast<std::size_t>(
      std::partition_point(f.begin(), f.end(), [&](const PoseFactor& p) { return p.to < keyframe; }) - f.begin());
}

std::size_t first_plane_factor(const Graph& graph, int keyframe) {
  const auto& f = graph.plane_factors;
  return static_cast<std::size_t>(
      std::partition_point(f.begin(), f.end(), [&](const PlaneFactor& p) { return p.keyframe < keyframe; }) -
      f.begin());
}

template <class Factors, class Wanted>
std::vector<std::size_t> indices(const Factors& factors, std::size_t from, const Wanted& wanted) {
  std::vector<std::size_t> list;
  for (std::size_t i = from; i < factors.size(); ++i)
    if (wanted(factors[i])) list.push_back(i);
  return list;
}

/// Levenberg-Marquardt on a small dense problem with a prior.
class WindowSolver {
 public:
  WindowSolver(const std::vector<Term>& terms, const MarginalPrior& prior, const Ordering& ordering, Values& values,
               const OptimizerConfig& config)
      : terms_(terms), prior_(prior), ordering_(ordering), values_(values), config_(config) {}

  OptimizeReport solve() {
    OptimizeReport report;
    double cost = linearize_all();
    report.initial_cost = cost;
    while (report.iterations < config_.max_iterations) {
      ++report.iterations;
      const double before = cost;
      if (!step(cost)) break;
      if (before - cost <= config_.relative_decrease * terms_cost_) break;
      cost = linearize_all();
    }
    report.final_cost = cost;
    return report;
  }

 private:
  double linearize_all() {
    H_.setZero(ordering_.size, ordering_.size);
    g_.setZero(ordering_.size);
    terms_cost_ = linearize(terms_, values_, ordering_, &g_, dense_sink(H_));
    return terms_cost_ + add_prior(prior_, values_, ordering_, &g_, &H_);
  }

  /// Takes the first step that does not raise the cost; false when none is found.
  bool step(double& cost) {
    constexpr int trials = 8;
    for (int trial = 0; trial < trials; ++trial) {
      damped_ = H_;
      damped_.diagonal() *= 1.0 + damping_;
      const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(damped_);  // in place
      if (llt.info() == Eigen::Success) {
        const Eigen::VectorXd delta = -llt.solve(g_);
        Values moved = values_;
        for (const auto& [vertex, row] : ordering_.row) move(vertex.layer, moved.at(vertex), delta.data() + row);
        const double after =
            linearize(terms_, moved, ordering_, nullptr, {}) + add_prior(prior_, moved, ordering_, nullptr, nullptr);
        if (after <= cost) {
          values_ = std::move(moved);
          cost = after;
          damping_ = std::max(0.1 * damping_, least_damping);
          return true;
        }
      }
      damping_ = 10.0 * damping_;
    }
    return false;
  }

  static constexpr double least_damping = 1e-12;

  const std::vector<Term>& terms_;
  const MarginalPrior& prior_;
  const Ordering& ordering_;
  Values& values_;
  const OptimizerConfig& config_;
  Eigen::MatrixXd H_, damped_;
  Eigen::VectorXd g_;
  double terms_cost_ = 0.0;
  double damping_ = 1e-9;
};

}  // namespace

bool IncrementalOptimizer::solve_is_due(const Graph& graph) const {
  const auto keyframes = static_cast<int>(graph.keyframes.size());
  const int share = static_cast<int>(std::floor(config_.global_solve_share * keyframes));
  return keyframes - solved_at_ >= std::max(config_.global_solve_spacing, share);
}

OptimizeReport IncrementalOptimizer::update(Graph& graph) {
  update_last_seen(graph);
  marginalize_before(graph, std::max(0, static_cast<int>(graph.keyframes.size()) - config_.window));
  const std::vector<Term> terms = make_terms(graph, window_factors(graph), optimizer_);
  Values values;
  add_values(graph, terms, values);
  for (const VertexId vertex : prior_.vertices) values.try_emplace(vertex, block_of(graph, vertex));

  // Planes that were marginalised and that a room or a duplicate brings in stay where they are.
  Ordering ordering;
  for (const auto& [vertex, block] : values) {
    const auto id = static_cast<std::size_t>(vertex.id);
    const bool behind = vertex.layer == Layer::plane && !prior_.holds(vertex) && last_seen_[id] < first_;
    if (vertex != gauge && !behind) ordering.add(vertex);
  }
  if (ordering.size == 0) return {};
  OptimizeReport report = WindowSolver(terms, prior_, ordering, values, optimizer_).solve();
  report.keyframes = static_cast<int>(graph.keyframes.size()) - std::max(first_, 1);
  report.terms = static_cast<int>(terms.size());
  for (const auto& [vertex, row] : ordering.row) write_back(vertex, values.at(vertex), graph);
  return report;
}

OptimizeReport IncrementalOptimizer::solve(Graph& graph, int first_free) {
  solved_at_ = static_cast<int>(graph.keyframes.size());
  return optimize(graph, first_free, optimizer_);
}

void IncrementalOptimizer::relinearize(const Graph& graph) {
  first_ = std::max(0, static_cast<int>(graph.keyframes.size()) - config_.window);
  last_seen_.assign(graph.planes.size(), -1);
  for (const PlaneFactor& f : graph.plane_factors) last_seen_[static_cast<std::size_t>(f.plane)] = f.keyframe;
  const std::vector<VertexId> stay = kept(graph, first_);
  const auto stays = [&](int id) { return std::binary_search(stay.begin(), stay.end(), VertexId{Layer::plane, id}); };
  const FactorSelection old = {
      .pose = indices(graph.pose_factors, 0, [&](const PoseFactor& f) { return f.from < first_; }),
      .plane = indices(graph.plane_factors, 0, [&](const PlaneFactor& f) { return f.keyframe < first_; }),
      .room = {},
      .floor = {},
      .duplicate =
          indices(graph.duplicate_factors, 0, [&](const DuplicateFactor& f) { return !stays(f.a) || !stays(f.b); })};
  prior_ = marginalize_sparse(graph, make_terms(graph, old, optimizer_), stay, {gauge});
}

/// Keeps track of when planes were seen last.
void IncrementalOptimizer::update_last_seen(const Graph& graph) {
  const int newest = static_cast<int>(graph.keyframes.size()) - 1;
  const std::size_t known = last_seen_.size();
  last_seen_.resize(graph.planes.size(), newest);
  revisited_marginalized_plane_ = false;
  for (std::size_t i = first_plane_factor(graph, newest); i < graph.plane_factors.size(); ++i) {
    const int plane = graph.plane_factors[i].plane;
    const auto id = static_cast<std::size_t>(plane);
    revisited_marginalized_plane_ |= id < known && last_seen_[id] < first_ && !prior_.holds({Layer::plane, plane});
    last_seen_[id] = newest;
  }
}

/// What stays when the window begins at `first`: its keyframes, the planes they see, the latest seen of the others.
std::vector<VertexId> IncrementalOptimizer::kept(const Graph& graph, int first) const {
  std::vector<VertexId> vertices;
  for (int k = std::max(first, 1); k < static_cast<int>(graph.keyframes.size()); ++k)
    vertices.push_back({Layer::keyframe, k});
  std::vector<int> behind;
  for (std::size_t id = 0; id < last_seen_.size(); ++id) {
    if (graph.planes[id].merged_into >= 0) continue;
    if (last_seen_[id] >= first)
      vertices.push_back({Layer::plane, static_cast<int>(id)});
    else
      behind.push_back(static_cast<int>(id));
  }
  const auto later = [&](int a, int b) {
    const int seen_a = last_seen_[static_cast<std::size_t>(a)], seen_b = last_seen_[static_cast<std::size_t>(b)];
    return std::pair(-seen_a, a) < std::pair(-seen_b, b);
  };
  const auto count = std::min(behind.size(), static_cast<std::size_t>(config_.boundary_planes));
  std::partial_sort(behind.begin(), behind.begin() + static_cast<std::ptrdiff_t>(count), behind.end(), later);
  for (std::size_t i = 0; i < count; ++i) vertices.push_back({Layer::plane, behind[i]});
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// Marginalises the keyframes before `first`, and planes that are out of sight for longest.
void IncrementalOptimizer::marginalize_before(const Graph& graph, int first) {
  if (first <= first_) return;
  FactorSelection leaving;
  // A factor that leads back before the window is in the prior already, or waits for the next solve.
  leaving.pose = indices(graph.pose_factors, first_pose_factor(graph, first_),
                         [&](const PoseFactor& f) { return f.from >= first_ && f.from < first; });
  leaving.plane = indices(graph.plane_factors, first_plane_factor(graph, first_),
                          [&](const PlaneFactor& f) { return f.keyframe < first; });
  prior_ = marginalize(graph, prior_, make_terms(graph, leaving, optimizer_), kept(graph, first), {gauge});
  first_ = first;
}

FactorSelection IncrementalOptimizer::window_factors(const Graph& graph) const {
  FactorSelection window;
  window.pose = indices(graph.pose_factors, first_pose_factor(graph, first_),
                        [&](const PoseFactor& f) { return f.from >= first_; });
  window.plane =
      indices(graph.plane_factors, first_plane_factor(graph, first_), [](const PlaneFactor&) { return true; });
  const auto active = [&](int plane) {
    return last_seen_[static_cast<std::size_t>(plane)] >= first_ || prior_.holds({Layer::plane, plane});
  };
  std::vector<int> rooms;
  for (std::size_t i = 0; i < graph.room_factors.size(); ++i) {
    const RoomFactor& f = graph.room_factors[i];
    if (std::none_of(f.planes.begin(), f.planes.end(), active)) continue;
    window.room.push_back(i);
    rooms.push_back(f.room);
  }
  std::sort(rooms.begin(), rooms.end());
  window.floor = indices(graph.floor_factors, 0,
                         [&](const FloorFactor& f) { return std::binary_search(rooms.begin(), rooms.end(), f.room); });
  window.duplicate =
      indices(graph.duplicate_factors, 0, [&](const DuplicateFactor& f) { return active(f.a) && active(f.b); });
  return window;
}

}  // namespace plumbline::slam
