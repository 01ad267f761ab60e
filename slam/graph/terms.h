// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "slam/graph/graph.h"
#include "slam/graph/optimize.h"

namespace ceres {
class CostFunction;
}

/// A graph's factors as terms of a least squares problem over flat blocks; between the graph and its solvers.
namespace plumbline::slam {

enum class Layer { keyframe, plane, room, floor };

/// Names a vertex; by layer, then by id.
struct VertexId {
  Layer layer = Layer::keyframe;
  int id = 0;
  friend auto operator<=>(const VertexId&, const VertexId&) = default;
};

/// Dimension of a layer's increment, see factors.h.
[[nodiscard]] int tangent_size(Layer layer);

/// A vertex's estimate in as many of the numbers as its layer needs, see cost_functions.h.
using Block = std::array<double, 7>;
/// Addresses of blocks stay as more are added.
using Values = std::map<VertexId, Block>;

[[nodiscard]] Block block_of(const Graph& graph, VertexId vertex);
void write_back(VertexId vertex, const Block& block, Graph& graph);
/// block <- increment(block, step), tangent_size(layer) numbers.
void move(Layer layer, Block& block, const double* step);

/// Factors of a graph by their indices, ascending.
struct FactorSelection {
  std::vector<std::size_t> pose, plane, room, floor, duplicate;
};

/// A whitened factor ready for evaluation.
struct Term {
  Term(std::unique_ptr<ceres::CostFunction> cost_function, std::vector<VertexId> of, double huber_sigmas);
  ~Term();
  Term(Term&&) noexcept;
  Term& operator=(Term&&) noexcept;

  std::unique_ptr<ceres::CostFunction> cost;
  std::vector<VertexId> vertices;  ///< in the order of the cost's blocks
  double huber = 0.0;              ///< counts linearly from this many sigmas; 0: never
};

[[nodiscard]] std::vector<Term> make_terms(const Graph& graph, const FactorSelection& selection,
                                           const OptimizerConfig& config);
/// Adds the blocks of the terms' vertices that `values` does not hold.
void add_values(const Graph& graph, const std::vector<Term>& terms, Values& values);

}  // namespace plumbline::slam
