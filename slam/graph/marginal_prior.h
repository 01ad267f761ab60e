// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "slam/graph/terms.h"

namespace plumbline::slam {

/// The vertices that are solved for, each with its first row.
struct Ordering {
  std::map<VertexId, int> row;
  int size = 0;

  /// Appends a vertex; one that is in already keeps its rows.
  void add(VertexId vertex);
  [[nodiscard]] bool holds(VertexId vertex) const { return row.contains(vertex); }
};

/// Takes H(row.., column..) += block, lower triangle: row >= column.
using BlockSink = std::function<void(int row, int column, const Eigen::Ref<const Eigen::MatrixXd>& block)>;

/// Gauss-Newton normal equations of the terms at `values`, robust weights included: g += J^T w e and the blocks of J^T
/// w J to the sink, which may be empty. Vertices not in the ordering are constants. Returns the cost, 0.5 sum
/// rho(|e|^2).
double linearize(const std::vector<Term>& terms, const Values& values, const Ordering& ordering, Eigen::VectorXd* g,
                 const BlockSink& sink);
/// Sink into a dense lower triangle.
[[nodiscard]] BlockSink dense_sink(Eigen::MatrixXd& H);

/// Information of everything that was eliminated about the vertices that are left: the cost 0.5 d^T H d + g^T d, where
/// d are their increments from fixed estimates.
struct MarginalPrior {
  std::vector<VertexId> vertices;  ///< in the order of their rows
  std::vector<Block> at;           ///< the fixed estimates
  Eigen::MatrixXd information;     ///< H, symmetric
  Eigen::VectorXd gradient;        ///< g

  [[nodiscard]] bool holds(VertexId vertex) const;
};

/// Adds the prior to the normal equations at `values`, which hold all its vertices. Returns its cost.
double add_prior(const MarginalPrior& prior, const Values& values, const Ordering& ordering, Eigen::VectorXd* g,
                 Eigen::MatrixXd* H);

/// Prior and terms at the graph's estimates with all vertices but `kept` (ascending) eliminated by Schur complement,
/// dense; `held` vertices are constants. Kept vertices that nothing touches are left out. Throws InternalError when
/// what is eliminated is not determined.
[[nodiscard]] MarginalPrior marginalize(const Graph& graph, const MarginalPrior& former, const std::vector<Term>& terms,
                                        const std::vector<VertexId>& kept, const std::vector<VertexId>& held);
/// The same from terms alone, sparse: for a whole graph.
[[nodiscard]] MarginalPrior marginalize_sparse(const Graph& graph, const std::vector<Term>& terms,
                                               const std::vector<VertexId>& kept, const std::vector<VertexId>& held);

}  // namespace plumbline::slam
