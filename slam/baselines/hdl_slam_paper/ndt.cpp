// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/geometry/symmetric.h"
#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"
#include "slam/baselines/hdl_slam_paper/ndt_cells.h"

namespace plumbline::slam::hdl {

namespace {

constexpr double sufficient_decrease = 1e-4;  ///< of the line search, as in the reference

/// Newton's step with the sizes of the Hessian's eigenvalues: it leads downwards, where the reference reverses one that
/// leads upwards.
Vector6d descent(const NdtScore& score) {
  const SymmetricEigen<6> eigen = symmetric_eigen(score.hessian);
  const double least = 1e-12 * eigen.values.cwiseAbs().maxCoeff();
  Vector6d step = Vector6d::Zero();
  for (int i = 0; i < 6; ++i)
    if (std::abs(eigen.values[i]) > least)
      step -= eigen.vectors.col(i).dot(score.gradient) / std::abs(eigen.values[i]) * eigen.vectors.col(i);
  return step;
}

struct Step {
  double length = 0.0;
  Pose X_TS;
  NdtScore score;
};

class Ndt final : public CloudMatcher {
 public:
  explicit Ndt(const NdtConfig& config) : config_(config), cells_(config) {}

  void set_target(const std::vector<Eigen::Vector3d>& points_T) override { cells_.set(points_T); }

  // Newton's method with a line search [magnusson2009, algorithm 2].
  [[nodiscard]] CloudMatch match(const std::vector<Eigen::Vector3d>& points_S, const Pose& guess) const override {
    CloudMatch match{guess, false};
    NdtScore score = cells_.score(points_S, match.X_TS);
    if (!(score.value < 0.0)) return match;
    match.converged = true;
    for (int i = 0; i < config_.max_iterations; ++i) {
      const std::optional<Step> step = search(points_S, match.X_TS, score);
      if (!step) break;
      match.X_TS = step->X_TS;
      score = step->score;
      if (step->length < config_.epsilon) break;
    }
    return match;
  }

 private:
  /// The first step that lowers the score enough; each is half as long as the one before, where the reference
  /// interpolates between them.
  [[nodiscard]] std::optional<Step> search(const std::vector<Eigen::Vector3d>& points_S, const Pose& X_TS,
                                           const NdtScore& score) const {
    Vector6d direction = descent(score);
    const double newton = direction.norm();
    if (!(newton > 0.0) || !std::isfinite(newton)) return std::nullopt;
    direction /= newton;
    const double slope = score.gradient.dot(direction);
    for (double length = std::min(newton, config_.step_m);; length *= 0.5) {
      Step step{length, retract(X_TS, length * direction), {}};
      step.score = cells_.score(points_S, step.X_TS);
      if (step.score.value <= score.value + sufficient_decrease * length * slope) return step;
      if (length < 0.5 * config_.epsilon) return std::nullopt;
    }
  }

  NdtConfig config_;
  NdtCells cells_;
};

}  // namespace

std::unique_ptr<CloudMatcher> make_ndt(const NdtConfig& config) { return std::make_unique<Ndt>(config); }

}  // namespace plumbline::slam::hdl
