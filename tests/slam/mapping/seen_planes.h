// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "slam/graph/graph.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

/// What a robot at X_MR sees of the stretch a-b of a wall whose free side lies left of a to b; z from 0 to 2.4 m above
/// the floor, which is 0.5 m below R.
inline PlaneObservation see(const Pose& X_MR, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d n = Eigen::Vector2d(-(b - a).y(), (b - a).x()).normalized();
  const Pose X_RM = X_MR.inverse();
  PlaneObservation seen;
  seen.plane_R = X_RM * Plane{{n.x(), n.y(), 0.0}, -n.dot(a)};
  seen.covariance = Eigen::Vector3d(1e-5, 1e-4, 1e-4).asDiagonal();
  seen.points = 1000;
  seen.p0_R = X_RM * Eigen::Vector3d(a.x(), a.y(), 0.0);
  seen.p1_R = X_RM * Eigen::Vector3d(b.x(), b.y(), 0.0);
  seen.z0 = -0.5;
  seen.z1 = 1.9;
  seen.vertical = true;
  return seen;
}

inline PlaneObservation see_floor(const Pose& X_MR, double height_M) {
  PlaneObservation seen;
  seen.plane_R = X_MR.inverse() * Plane{Eigen::Vector3d::UnitZ(), -height_M};
  seen.covariance = Eigen::Vector3d(1e-5, 1e-5, 1e-4).asDiagonal();
  return seen;
}

inline Graph at(const Pose& X_MR) {
  Graph graph;
  graph.keyframes.push_back({0, X_MR, X_MR, 0});
  return graph;
}

}  // namespace plumbline::slam
