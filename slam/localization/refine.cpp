// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/refine.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace plumbline::slam {

namespace {

struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();

  void add(const Eigen::RowVector3d& J, double e, double information) {
    H += information * J.transpose() * J;
    b -= information * J.transpose() * e;
  }
};

/// Votes of the beams on whether each wall or solid of the plan stands.
class ElementHits {
 public:
  explicit ElementHits(const StoreyIndex& storey) : storey_(storey), ends_(storey.segments.size(), 0) {}

  void add(const BeamResidual& residual, double gate) {
    if (residual.segment >= 0 && residual.across > -gate) ends_[element(residual)] += residual.across <= gate ? 1 : -1;
  }
  /// False where more beams penetrate it than end at it: what ends there is then something else.
  [[nodiscard]] bool stands(const BeamResidual& residual) const { return ends_[element(residual)] > 0; }

 private:
  [[nodiscard]] std::size_t element(const BeamResidual& residual) const {
    return static_cast<std::size_t>(storey_.segments[static_cast<std::size_t>(residual.segment)].element);
  }
  const StoreyIndex& storey_;
  std::vector<int> ends_;
};

/// Distances of the beams' ends to the faces they should hit, linearised in (x, y, yaw).
NormalEquations beam_equations(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan, double gate,
                               const LikelihoodConfig& likelihood) {
  NormalEquations equations;
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * scan.sensor_H + X_IH.t;
  const int cell = storey.grid.cell_at(sensor_I);
  // The share of evidence of a beam keeps its errors from being averaged away as if they were independent.
  const double information = likelihood.beam_weight / (likelihood.beam_sigma_m * likelihood.beam_sigma_m);
  std::vector<BeamResidual> residuals;
  ElementHits hits(storey);
  for (const Beam& beam : scan.beams) {
    residuals.push_back(beam_residual(storey, sensor_I, cell, R_IH, beam, scan.sensor_height, likelihood));
    hits.add(residuals.back(), gate);
  }
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    const BeamResidual& residual = residuals[i];
    if (residual.segment < 0 || std::abs(residual.across) > gate || !hits.stands(residual)) continue;
    const PlanSegment& segment = storey.segments[static_cast<std::size_t>(residual.segment)];
    if (segment.n.dot(R_IH * beam.direction_H) >= 0.0) continue;  // the back of a face stands for a jamb
    const Eigen::Vector2d arm = R_IH * (scan.sensor_H + beam.range * beam.direction_H);
    const double e = segment.n.dot(arm + X_IH.t - segment.a);
    const Eigen::RowVector3d J(segment.n.x(), segment.n.y(), segment.n.dot(Eigen::Vector2d(-arm.y(), arm.x())));
    equations.add(J, e, information);
  }
  return equations;
}

void add_prior(NormalEquations& equations, const Pose2& X_prior, const Pose2& X, const RefineConfig& config) {
  const double position = 1.0 / (config.prior_sigma_m * config.prior_sigma_m);
  const double angle = 1.0 / (config.prior_sigma_rad * config.prior_sigma_rad);
  const Eigen::Vector2d e = X.t - X_prior.t;
  equations.add({1.0, 0.0, 0.0}, e.x(), position);
  equations.add({0.0, 1.0, 0.0}, e.y(), position);
  equations.add({0.0, 0.0, 1.0}, wrap_angle(X.yaw - X_prior.yaw), angle);
}

}  // namespace

Refined refine(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
               const LikelihoodConfig& likelihood, const RefineConfig& config) {
  Refined result{X_IH, {}};
  double gate = config.first_gate_m;
  for (int i = 0; i < config.iterations; ++i) {
    NormalEquations equations = beam_equations(storey, result.X_IH, scan, gate, likelihood);
    add_prior(equations, X_IH, result.X_IH, config);
    const Eigen::Vector3d step = equations.H.ldlt().solve(equations.b);
    result.X_IH.t += step.head<2>();
    result.X_IH.yaw = wrap_angle(result.X_IH.yaw + step.z());
    result.covariance = equations.H.inverse();
    gate = std::max(0.5 * gate, config.last_gate_m);
  }
  return result;
}

Agreement agreement(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                    const LikelihoodConfig& likelihood, const RefineConfig& config) {
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * scan.sensor_H + X_IH.t;
  const int cell = storey.grid.cell_at(sensor_I);
  int inliers = 0, penetration_ratio = 0, penetration_ratio_worst_wall = 0;
  std::vector<int> crossings_of_element(storey.segments.size(), 0);
  for (const Beam& beam : scan.beams) {
    const BeamResidual residual = beam_residual(storey, sensor_I, cell, R_IH, beam, scan.sensor_height, likelihood);
    if (std::abs(residual.across) <= config.inlier_m) ++inliers;
    if (residual.across <= config.inlier_m) continue;
    ++penetration_ratio;
    if (residual.segment < 0) continue;
    const int element = storey.segments[static_cast<std::size_t>(residual.segment)].element;
    penetration_ratio_worst_wall =
        std::max(penetration_ratio_worst_wall, ++crossings_of_element[static_cast<std::size_t>(element)]);
  }
  const double count = std::max<double>(1.0, static_cast<double>(scan.beams.size()));
  return {inliers / count, penetration_ratio / count, penetration_ratio_worst_wall / count};
}

}  // namespace plumbline::slam
