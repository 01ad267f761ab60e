// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/refine.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "bim/geometry/symmetric.h"

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

/// The beams of a scan against the structure at a pose.
class StructureResiduals {
 public:
  StructureResiduals(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan, double min_incidence)
      : R_IH_(X_IH.rotation()), sensor_I_(R_IH_ * scan.sensor_H + X_IH.t), hits_(scan.beams.size()) {
    std::vector<SensorRay> rays;
    double farthest = 0.0;
    for (const Beam& beam : scan.beams) {
      rays.push_back({R_IH_ * beam.direction_H, beam.slope});
      farthest = std::max(farthest, (beam.range + beyond_m) * std::sqrt(1.0 + beam.slope * beam.slope));
    }
    storey.structure->cast({sensor_I_.x(), sensor_I_.y(), storey.floor_at(sensor_I_) + scan.sensor_height}, rays,
                           farthest, hits_);
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      const double reach = scan.beams[i].range + beyond_m;
      const bool hit = hits_[i].element >= 0 && hits_[i].distance < reach;
      may_pass_.push_back(hit && storey.structure->is_railing(hits_[i].element));
      if (!hit || !hits_[i].upright) hits_[i].element = -1;
      across_.push_back(scan.beams[i].range - (hit ? hits_[i].distance : reach));
      if (hits_[i].element >= 0) across_.back() *= std::max(std::abs(hits_[i].n.dot(rays[i].direction)), min_incidence);
    }
  }

  [[nodiscard]] const Eigen::Matrix2d& R_IH() const { return R_IH_; }
  [[nodiscard]] const Eigen::Vector2d& sensor_I() const { return sensor_I_; }
  /// Element that beam i should end at, -1: no upright face.
  [[nodiscard]] int element(std::size_t i) const { return hits_[i].element; }
  /// Measured minus expected range, across the face hit, m; positive: through it.
  [[nodiscard]] double across(std::size_t i) const { return across_[i]; }
  /// Whether what the beam should end at has bars: beside them it passes.
  [[nodiscard]] bool may_pass(std::size_t i) const { return may_pass_[i]; }
  [[nodiscard]] const Eigen::Vector2d& n(std::size_t i) const { return hits_[i].n; }
  [[nodiscard]] double expected(std::size_t i) const { return hits_[i].distance; }
  [[nodiscard]] std::size_t size() const { return hits_.size(); }

 private:
  static constexpr double beyond_m = 1.0;  // a beam this far behind a face has long penetrated it

  Eigen::Matrix2d R_IH_;
  Eigen::Vector2d sensor_I_;
  std::vector<StructureHit> hits_;
  std::vector<double> across_;
  std::vector<bool> may_pass_;
};

/// Beams of one turn that should end at one wall and are not cut short, in their order.
class WallBeams {
 public:
  void add(std::size_t beam, bool penetrates) {
    begins_turn_ = begins_turn_ || beam == 0;
    last_beam_ = beam;
    ++(penetrates ? penetrating_ : met_);
    in_a_row_ = penetrates ? in_a_row_ + 1 : 0;
    if (met_ == 0) first_in_a_row_ = in_a_row_;
    most_in_a_row_ = std::max(most_in_a_row_, in_a_row_);
  }
  /// How many of the penetrating beams one change of the building explains. beams: of the turn, whose last is beside
  /// the first.
  [[nodiscard]] int one_change(std::size_t beams) const {
    if (penetrating_ >= met_) return penetrating_;
    const bool goes_round = begins_turn_ && last_beam_ + 1 == beams;
    return goes_round ? std::max(most_in_a_row_, first_in_a_row_ + in_a_row_) : most_in_a_row_;
  }

 private:
  bool begins_turn_ = false;
  std::size_t last_beam_ = 0;
  int met_ = 0, penetrating_ = 0, in_a_row_ = 0, first_in_a_row_ = 0, most_in_a_row_ = 0;
};

/// Weight of a residual under a Cauchy kernel of this scale.
double cauchy_weight(double e, double scale) { return 1.0 / (1.0 + e * e / (scale * scale)); }

/// Distances of the beams' ends to the faces they should hit, linearised in (x, y, yaw).
NormalEquations beam_equations(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan, double gate,
                               const LikelihoodConfig& likelihood, const RefineConfig& config) {
  NormalEquations equations;
  const StructureResiduals residuals(storey, X_IH, scan, likelihood.beam_min_incidence);
  // The share of evidence of a beam keeps its errors from being averaged away as if they were independent.
  const double information = likelihood.beam_weight / (likelihood.beam_sigma_m * likelihood.beam_sigma_m);
  // Votes of the beams on whether each element stands: where more beams penetrate it than end at it, what ends there is
  // something else.
  std::map<int, int> votes;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    if (residuals.element(i) >= 0 && residuals.across(i) > -gate)
      votes[residuals.element(i)] += residuals.across(i) <= gate ? 1 : -1;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals.element(i) < 0 || std::abs(residuals.across(i)) > gate || votes[residuals.element(i)] <= 0) continue;
    const Eigen::Vector2d& n = residuals.n(i);
    const Eigen::Vector2d direction = residuals.R_IH() * scan.beams[i].direction_H;
    const Eigen::Vector2d arm = residuals.R_IH() * scan.sensor_H + scan.beams[i].range * direction;
    const double e = n.dot(direction) * (scan.beams[i].range - residuals.expected(i));
    equations.add({n.x(), n.y(), n.dot(Eigen::Vector2d(-arm.y(), arm.x()))}, e,
                  gate > config.last_gate_m ? information : information * cauchy_weight(e, config.cauchy_share * gate));
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
    NormalEquations equations = beam_equations(storey, result.X_IH, scan, gate, likelihood, config);
    add_prior(equations, X_IH, result.X_IH, config);
    const Eigen::Vector3d step = solve_ldlt(equations.H, equations.b);
    result.X_IH.t += step.head<2>();
    result.X_IH.yaw = wrap_angle(result.X_IH.yaw + step.z());
    result.covariance = equations.H.inverse();
    gate = std::max(0.5 * gate, config.last_gate_m);
  }
  return result;
}

Agreement agreement(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                    const LikelihoodConfig& likelihood, const RefineConfig& config) {
  const StructureResiduals residuals(storey, X_IH, scan, likelihood.beam_min_incidence);
  int inliers = 0, penetrating = 0;
  std::map<int, WallBeams> walls;
  const std::size_t size = residuals.size();
  for (std::size_t i = 0; i < size; ++i) {
    const bool meets = std::abs(residuals.across(i)) <= config.inlier_m;
    const bool penetrates = residuals.across(i) > config.inlier_m && !residuals.may_pass(i);
    inliers += meets ? 1 : 0;
    penetrating += penetrates ? 1 : 0;
    if (residuals.element(i) >= 0 && (meets || penetrates)) walls[residuals.element(i)].add(i, penetrates);
  }
  int one_change = 0;
  for (const auto& [element, beams] : walls) one_change = std::max(one_change, beams.one_change(size));
  const double count = std::max<double>(1.0, static_cast<double>(scan.beams.size()));
  return {inliers / count, penetrating / count, one_change / count};
}

}  // namespace plumbline::slam
