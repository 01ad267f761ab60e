// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/as_written.h"

#include <cmath>

#include "bim/errors.h"
#include "slam/io/pose_check.h"

namespace plumbline::scenarios {

namespace {

/// Files hold no negative zero, and nothing that is not finite.
double positive_zero(double value) {
  if (!std::isfinite(value)) throw InternalError("a result is not a finite number");
  return value == 0.0 ? 0.0 : value;
}
double round_to(double value, double steps) { return positive_zero(std::round(value * steps) / steps); }

template <class Derived>
void drop_negative_zeros(Eigen::PlainObjectBase<Derived>& m) {
  m = m.unaryExpr([](double value) { return positive_zero(value); }).eval();
}
void drop_negative_zeros(Pose& X) {
  drop_negative_zeros(X.t);
  drop_negative_zeros(X.q.coeffs());
}
void drop_negative_zeros(double& value) { value = positive_zero(value); }

void round_as_written(slam::Hypothesis& hypothesis) {
  drop_negative_zeros(hypothesis.mass);
  drop_negative_zeros(hypothesis.X_WR);
  drop_negative_zeros(hypothesis.covariance);
  for (slam::WallMatch& match : hypothesis.walls) {
    match.p0_R = rounded(match.p0_R);
    match.p1_R = rounded(match.p1_R);
  }
}

void round_as_written(slam::Estimate& estimate) {
  for (slam::PlaneNode& plane : estimate.planes) {
    for (double* value : {&plane.plane_F.d, &plane.z0, &plane.z1}) drop_negative_zeros(*value);
    for (Eigen::Vector2d* p : {&plane.p0, &plane.p1}) drop_negative_zeros(*p);
    drop_negative_zeros(plane.plane_F.n);
  }
  for (slam::RoomNode& room : estimate.rooms) {
    drop_negative_zeros(room.center_F);
    for (Eigen::Vector2d& p : room.polygon_F) drop_negative_zeros(p);
  }
  for (slam::FloorNode& floor : estimate.floors) {
    for (Eigen::Vector3d* v : {&floor.center_F, &floor.plane_F.n}) drop_negative_zeros(*v);
    drop_negative_zeros(floor.plane_F.d);
  }
  if (estimate.loops)
    for (slam::LoopEdge& loop : *estimate.loops) drop_negative_zeros(loop.X_FT);
  for (slam::SegmentedScan& scan : estimate.segmented) drop_negative_zeros(scan.sensor_R);
  for (const Eigen::Vector3f& p : estimate.map_F)
    if (!p.allFinite()) throw InternalError("a map point is not a finite number");
  estimate.graph = Tree();
}

}  // namespace

Eigen::Vector3d rounded(const Eigen::Vector3d& p) {
  return {round_to(p.x(), 1e3), round_to(p.y(), 1e3), round_to(p.z(), 1e3)};
}
slam::Particle rounded(const slam::Particle& particle) {
  return {round_to(particle.x, 1e3), round_to(particle.y, 1e3), round_to(particle.yaw, 1e3),
          round_to(particle.weight, 1e6)};
}

void round_as_written(std::vector<slam::StampedPose>& poses) {
  for (slam::StampedPose& pose : poses) {
    drop_negative_zeros(pose.X_FR);
    pose.X_FR = slam::checked_pose(pose.X_FR.t, pose.X_FR.q, {});
  }
}

void round_as_written(MethodRecord& method) {
  round_as_written(method.causal);
  round_as_written(method.estimate.trajectory);
  round_as_written(method.estimate);
  for (BeliefRecord& belief : method.beliefs) {
    for (slam::Hypothesis& hypothesis : belief.hypotheses) round_as_written(hypothesis);
    for (slam::Particle& particle : belief.particles) particle = rounded(particle);
  }
}

void check_finite(const BeliefRecord& belief) {
  for (slam::Hypothesis hypothesis : belief.hypotheses) round_as_written(hypothesis);
  for (const slam::Particle& particle : belief.particles) (void)rounded(particle);
}

void check_finite(const slam::Estimate& estimate) {
  slam::Estimate copy = estimate;
  round_as_written(copy);
  if (!estimate.graph.is_null()) (void)write_json(estimate.graph, 0);
}

}  // namespace plumbline::scenarios
