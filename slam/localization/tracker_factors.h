// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "slam/graph/factors.h"
#include "slam/localization/tracker.h"

namespace plumbline::slam {

/// Normal equations over a window of poses, 6 increments each, and the LiDAR's range bias, which comes last.
class WindowProblem {
 public:
  explicit WindowProblem(std::size_t poses);

  /// Residual e with Jacobian J towards pose i; sigmas by row; Huber in whitened length, 0: none.
  void add(std::size_t i, const Eigen::MatrixXd& J, const Eigen::VectorXd& e, const Eigen::VectorXd& sigmas,
           double huber);
  /// J_bias: towards the range bias.
  void add_with_bias(std::size_t i, const Eigen::MatrixXd& J, const Eigen::VectorXd& J_bias, Eigen::VectorXd e,
                     const Eigen::VectorXd& sigmas, double huber);
  /// off: of the range bias from its prior, m.
  void add_bias_prior(double off, double sigma);
  /// Between poses i and i + 1.
  void add_between(std::size_t i, const PoseResidual& residual, const Vector6d& sigmas);

  [[nodiscard]] Eigen::VectorXd solve() const;

 private:
  Eigen::MatrixXd H_;
  Eigen::VectorXd b_;
};

/// How much of a range bias shows in the distance of an observed wall: cosine of the beams' incidence.
[[nodiscard]] double bias_share(const PlaneObservation& observed);
/// Residual of an observed wall, its distance corrected by the range bias.
[[nodiscard]] PlaneResidual wall_residual(const TrackedPose& pose, const WallLink& link, const StoreyIndex& storey,
                                          double bias);
/// Standard deviations of such a residual.
[[nodiscard]] Eigen::Vector3d wall_sigmas(const WallLink& link, const TrackerConfig& config);
/// Weight of an observed wall by its residual, 1 where there is none (Geman and McClure): what stands before a wall is
/// taken for it within the gate. covariance: of the position in I, which widens it.
[[nodiscard]] double wall_weight(const TrackedPose& pose, const WallLink& link, const StoreyIndex& storey, double bias,
                                 const Eigen::Matrix2d& covariance, const TrackerConfig& config);

/// Pose-plane factors to the walls and the floor of the plan, which stand still.
void add_planes(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey, double bias,
                const TrackerConfig& config);
/// The robot stands on what the plan has below it: floor, landing or step.
void add_ground(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
                double standing_m, const TrackerConfig& config);
/// Room factors [bavle2023, eq. 7-8] with the room held by the plan: the robot's offset from the middle of two opposed
/// walls, as seen and as planned. A range bias shifts both walls alike and cancels.
void add_rooms(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
               const TrackerConfig& config);
/// Kalman gain of a measurement of the position along a direction.
[[nodiscard]] Eigen::Vector2d gain_along(const Eigen::Matrix2d& covariance, const Eigen::Vector2d& direction,
                                         double variance);
/// Covariance of (x, y, yaw) after that measurement, which leaves the yaw as it is (Joseph's form, for any gain).
[[nodiscard]] Eigen::Matrix3d corrected_along(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& direction,
                                              double variance);
/// Of a step, and of the time that the robot stood before its end.
[[nodiscard]] Vector6d odometry_sigmas(const Pose& X_ij, double waited_s, const TrackerConfig& config);

}  // namespace plumbline::slam
