// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/marginal_prior.h"

#include <ceres/cost_function.h>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/errors.h"
#include "slam/graph/cost_functions.h"
#include "slam/graph/factors.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

namespace {

/// What is known of any vertex before all factors, 1/m^2 and 1/rad^2: a direction that factors leave open, or whose
/// information drowns in that of others, is known to a kilometre instead of making the graph singular.
constexpr double least_information = 1e-6;

constexpr int max_rows = 6;
constexpr int max_blocks = 1 + max_room_planes;

using SparseMatrix = Eigen::SparseMatrix<double>;

/// A term's whitened residual and Jacobians; the tangent part stands in the first columns.
struct Evaluation {
  Eigen::Matrix<double, max_rows, 1> e;
  int rows = 0;
  std::array<std::array<double, max_rows * 7>, max_blocks> J{};
  std::array<int, max_blocks> columns{};

  /// False where the term has no value there.
  [[nodiscard]] bool at(const Term& term, const Values& values, bool with_jacobians) {
    std::array<const double*, max_blocks> x{};
    std::array<double*, max_blocks> jacobians{};
    rows = term.cost->num_residuals();
    for (std::size_t i = 0; i < term.vertices.size(); ++i) {
      x[i] = values.at(term.vertices[i]).data();
      jacobians[i] = J[i].data();
      columns[i] = term.cost->parameter_block_sizes()[i];
    }
    return term.cost->Evaluate(x.data(), e.data(), with_jacobians ? jacobians.data() : nullptr);
  }
};

/// J^T of one vertex, times a weight, from an evaluation; small enough for the stack, since a window has thousands.
class WeightedJacobian {
 public:
  WeightedJacobian(const Evaluation& evaluation, std::size_t i, int size, double weight)
      : evaluation_(evaluation), size_(size) {
    for (int a = 0; a < size; ++a)
      for (int r = 0; r < evaluation.rows; ++r) at(a, r) = weight * jacobian(i, r, a);
  }

  /// g += J^T w e.
  void add_gradient(double* g) const {
    for (int a = 0; a < size_; ++a) {
      double sum = at(a, 0) * evaluation_.e[0];
      for (int r = 1; r < evaluation_.rows; ++r) sum += at(a, r) * evaluation_.e[r];
      g[a] += sum;
    }
  }

  /// J^T w J_j, column by column.
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> times(std::size_t j, int size_j) {
    for (int b = 0; b < size_j; ++b)
      for (int a = 0; a < size_; ++a) {
        double sum = at(a, 0) * jacobian(j, 0, b);
        for (int r = 1; r < evaluation_.rows; ++r) sum += at(a, r) * jacobian(j, r, b);
        block_[static_cast<std::size_t>(b * size_ + a)] = sum;
      }
    return {block_.data(), size_, size_j};
  }

 private:
  [[nodiscard]] double jacobian(std::size_t i, int row, int column) const {
    return evaluation_.J[i][static_cast<std::size_t>(row * evaluation_.columns[i] + column)];
  }
  double& at(int a, int row) { return weighted_[static_cast<std::size_t>(a * max_rows + row)]; }
  [[nodiscard]] double at(int a, int row) const { return weighted_[static_cast<std::size_t>(a * max_rows + row)]; }

  const Evaluation& evaluation_;
  int size_;
  std::array<double, max_rows * max_rows> weighted_;
  std::array<double, max_rows * max_rows> block_;
};

/// d and its change with the vertex's increment: d(at, moved(value, step)).
struct Difference {
  Eigen::VectorXd d;
  Eigen::MatrixXd D;
};

Difference pose_difference(const Pose& from, const Pose& to) {
  Difference r{Eigen::VectorXd(6), Eigen::MatrixXd::Zero(6, 6)};
  const Eigen::Matrix3d R0T = from.rotation().transpose();
  r.d << R0T * (to.t - from.t), log_so3(from.q.conjugate() * to.q);
  r.D.topLeftCorner<3, 3>() = R0T * to.rotation();
  r.D.bottomRightCorner<3, 3>() = inverse_right_jacobian(r.d.tail<3>());
  return r;
}

Difference plane_difference(const Plane& from, const Plane& to) {
  const Tangents t0 = plane_tangents(from.n), t = plane_tangents(to.n);
  Eigen::Matrix<double, 2, 3> T0;
  T0 << t0.u.transpose(), t0.v.transpose();
  Eigen::Matrix<double, 3, 2> dn;
  dn << t.u, t.v;
  const double along = std::max(from.n.dot(to.n), 0.1);  // of directions that are nearly the same
  const Eigen::Vector2d ab = T0 * to.n / along;
  Difference r{Eigen::VectorXd(3), Eigen::MatrixXd::Zero(3, 3)};
  r.d << ab, to.d - from.d;
  r.D.topLeftCorner<2, 2>() = (T0 * dn - ab * (from.n.transpose() * dn)) / along;
  r.D(2, 2) = 1.0;
  return r;
}

Difference difference(Layer layer, const Block& from, const Block& to) {
  if (layer == Layer::keyframe) return pose_difference(to_pose(from.data()), to_pose(to.data()));
  if (layer == Layer::plane) return plane_difference(to_plane(from.data()), to_plane(to.data()));
  throw InternalError("a marginal prior holds keyframes and planes only");
}

/// Rows of D in which its column `a` is not zero: a pose's D moves translation and rotation each for itself, a plane's
/// its normal and its offset.
struct Rows {
  int first, end;
};
Rows moved_by(int a, int size) {
  const int part = size == 3 ? 2 : 3;
  return a < part ? Rows{0, part} : Rows{part, size};
}

/// Adds D_i^T B D_j to the block of H at (row_i, row_j).
void add_between(const Difference& i, const Eigen::Ref<const Eigen::MatrixXd>& B, const Difference& j, int row_i,
                 int row_j, Eigen::MatrixXd& H) {
  const int n = static_cast<int>(i.d.size()), m = static_cast<int>(j.d.size());
  std::array<double, max_rows * max_rows> half{};  // D_i^T B, column by column
  for (int c = 0; c < m; ++c)
    for (int a = 0; a < n; ++a) {
      const Rows rows = moved_by(a, n);
      double& sum = half[static_cast<std::size_t>(c * n + a)];
      for (int k = rows.first; k < rows.end; ++k) sum += i.D(k, a) * B(k, c);
    }
  for (int b = 0; b < m; ++b) {
    const Rows rows = moved_by(b, m);
    for (int c = rows.first; c < rows.end; ++c)
      for (int a = 0; a < n; ++a) H(row_i + a, row_j + b) += half[static_cast<std::size_t>(c * n + a)] * j.D(c, b);
  }
}

/// Rows of the vertices that terms and prior touch: first those to eliminate, then those to keep.
struct Split {
  Ordering ordering;
  int eliminated = 0;
  std::vector<VertexId> kept;
};

Split split(const MarginalPrior& former, const std::vector<Term>& terms, const std::vector<VertexId>& kept,
            const std::vector<VertexId>& held) {
  std::vector<VertexId> touched = former.vertices;
  for (const Term& term : terms) touched.insert(touched.end(), term.vertices.begin(), term.vertices.end());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  std::erase_if(touched, [&](VertexId v) { return std::find(held.begin(), held.end(), v) != held.end(); });
  Split split;
  for (const VertexId vertex : touched) {
    if (std::binary_search(kept.begin(), kept.end(), vertex))
      split.kept.push_back(vertex);
    else
      split.ordering.add(vertex);
  }
  split.eliminated = split.ordering.size;
  for (const VertexId vertex : split.kept) split.ordering.add(vertex);
  return split;
}

MarginalPrior prior_over(const Graph& graph, const Split& split) {
  MarginalPrior prior;
  prior.vertices = split.kept;
  for (const VertexId vertex : split.kept) prior.at.push_back(block_of(graph, vertex));
  return prior;
}

}  // namespace

void Ordering::add(VertexId vertex) {
  if (row.emplace(vertex, size).second) size += tangent_size(vertex.layer);
}

bool MarginalPrior::holds(VertexId vertex) const {
  return std::binary_search(vertices.begin(), vertices.end(), vertex);
}

BlockSink dense_sink(Eigen::MatrixXd& H) {
  return [&H](int row, int column, const Eigen::Ref<const Eigen::MatrixXd>& block) {
    H.block(row, column, block.rows(), block.cols()) += block;
  };
}

double linearize(const std::vector<Term>& terms, const Values& values, const Ordering& ordering, Eigen::VectorXd* g,
                 const BlockSink& sink) {
  constexpr int held = -1;
  double cost = 0.0;
  Evaluation evaluation;
  for (const Term& term : terms) {
    if (!evaluation.at(term, values, g != nullptr)) {
      if (g == nullptr) return std::numeric_limits<double>::infinity();
      throw InternalError("a factor of the graph has no value at its present estimate");
    }
    const auto e = evaluation.e.head(evaluation.rows);
    const double norm = e.norm();
    const bool outlier = term.huber > 0.0 && norm > term.huber;
    const double weight = outlier ? term.huber / norm : 1.0;
    cost += outlier ? term.huber * (norm - 0.5 * term.huber) : 0.5 * norm * norm;
    if (g == nullptr) continue;
    std::array<int, max_blocks> row{};
    for (std::size_t i = 0; i < term.vertices.size(); ++i) {
      const auto at = ordering.row.find(term.vertices[i]);
      row[i] = at == ordering.row.end() ? held : at->second;
    }
    for (std::size_t i = 0; i < term.vertices.size(); ++i) {
      if (row[i] == held) continue;
      WeightedJacobian weighted(evaluation, i, tangent_size(term.vertices[i].layer), weight);
      weighted.add_gradient(g->data() + row[i]);
      for (std::size_t j = 0; sink && j < term.vertices.size(); ++j)
        if (row[j] != held && row[j] <= row[i])
          sink(row[i], row[j], weighted.times(j, tangent_size(term.vertices[j].layer)));
    }
  }
  return cost;
}

double add_prior(const MarginalPrior& prior, const Values& values, const Ordering& ordering, Eigen::VectorXd* g,
                 Eigen::MatrixXd* H) {
  const auto n = prior.gradient.size();
  Eigen::VectorXd d(n);
  std::vector<Difference> parts;
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < prior.vertices.size(); ++k) {
    parts.push_back(difference(prior.vertices[k].layer, prior.at[k], values.at(prior.vertices[k])));
    d.segment(row, parts.back().d.size()) = parts.back().d;
    row += parts.back().d.size();
  }
  const Eigen::VectorXd Hd = prior.information * d;
  if (g == nullptr) return 0.5 * d.dot(Hd) + prior.gradient.dot(d);
  const Eigen::VectorXd gradient = prior.gradient + Hd;
  Eigen::Index row_i = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Eigen::Index size_i = parts[i].d.size();
    const int to_i = ordering.row.at(prior.vertices[i]);
    g->segment(to_i, size_i) += parts[i].D.transpose() * gradient.segment(row_i, size_i);
    Eigen::Index row_j = 0;
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const Eigen::Index size_j = parts[j].d.size();
      const int to_j = ordering.row.at(prior.vertices[j]);
      if (to_j <= to_i)
        add_between(parts[i], prior.information.block(row_i, row_j, size_i, size_j), parts[j], to_i, to_j, *H);
      row_j += size_j;
    }
    row_i += size_i;
  }
  return 0.5 * d.dot(Hd) + prior.gradient.dot(d);
}

MarginalPrior marginalize(const Graph& graph, const MarginalPrior& former, const std::vector<Term>& terms,
                          const std::vector<VertexId>& kept, const std::vector<VertexId>& held) {
  const Split rows = split(former, terms, kept, held);
  Values values;
  add_values(graph, terms, values);
  for (const VertexId vertex : former.vertices) values.try_emplace(vertex, block_of(graph, vertex));
  const int n = rows.ordering.size, m = rows.eliminated;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
  linearize(terms, values, rows.ordering, &g, dense_sink(H));
  add_prior(former, values, rows.ordering, &g, &H);

  MarginalPrior prior = prior_over(graph, rows);
  H.diagonal().array() += least_information;
  const Eigen::LLT<Eigen::MatrixXd> llt(H.topLeftCorner(m, m));
  if (llt.info() != Eigen::Success) throw InternalError("a vertex to be marginalised is not determined");
  const Eigen::MatrixXd Y = llt.matrixL().solve(H.bottomLeftCorner(n - m, m).transpose());
  const Eigen::VectorXd y = llt.matrixL().solve(g.head(m));
  Eigen::MatrixXd S = H.bottomRightCorner(n - m, n - m);
  S.noalias() -= Y.transpose() * Y;
  prior.information = S.selfadjointView<Eigen::Lower>();
  prior.gradient = g.tail(n - m) - Y.transpose() * y;
  return prior;
}

MarginalPrior marginalize_sparse(const Graph& graph, const std::vector<Term>& terms, const std::vector<VertexId>& kept,
                                 const std::vector<VertexId>& held) {
  const Split rows = split({}, terms, kept, held);
  Values values;
  add_values(graph, terms, values);
  const int n = rows.ordering.size, m = rows.eliminated;
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
  linearize(terms, values, rows.ordering, &g, [&](int row, int column, const Eigen::Ref<const Eigen::MatrixXd>& block) {
    for (int j = 0; j < block.cols(); ++j)
      for (int i = 0; i < block.rows(); ++i)
        if (row + i >= column + j) triplets.emplace_back(row + i, column + j, block(i, j));
  });
  for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, least_information);
  SparseMatrix H(n, n);
  H.setFromTriplets(triplets.begin(), triplets.end());

  // Fill is kept low among what goes; what stays comes last, so that its part of the factor is the root of its Schur
  // complement.
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inner, order(n);
  const SparseMatrix H_ee = H.topLeftCorner(m, m);
  Eigen::AMDOrdering<int>()(H_ee.selfadjointView<Eigen::Lower>(), inner);
  for (int i = 0; i < n; ++i) order.indices()(i) = i < m ? inner.indices()(i) : i;
  SparseMatrix ordered(n, n);
  ordered.selfadjointView<Eigen::Lower>() = H.selfadjointView<Eigen::Lower>().twistedBy(order.inverse());
  const Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> llt(ordered);
  if (llt.info() != Eigen::Success) throw InternalError("a graph to be marginalised is not determined");
  const SparseMatrix L = llt.matrixL();
  const Eigen::VectorXd y = L.triangularView<Eigen::Lower>().solve(order.inverse() * g);

  MarginalPrior prior = prior_over(graph, rows);
  const Eigen::MatrixXd L_kk = L.bottomRightCorner(n - m, n - m);
  prior.information = L_kk * L_kk.transpose();
  prior.gradient = L_kk * y.tail(n - m);
  return prior;
}

}  // namespace plumbline::slam
