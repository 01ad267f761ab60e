// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/graph/factors.h"
#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {

struct LongWalk {
  int keyframes = 60;
  int lap = 1000;       ///< keyframes after which the walk is where it began
  int walls_a_lap = 0;  ///< 0: one new wall every other keyframe, without end
  int in_sight = 9;     ///< keyframes from which a wall is seen in one go
  double noise = 1e-6;  ///< rad and m of a measurement, in true terms; sigmas stay those of the information
};

/// A walk that passes walls in any direction, each seen for a stretch of the way, over a floor that is always seen.
/// Estimates hold what a front end would start from: the measured steps, walls where they were first seen.
class LongWalkGraph {
 public:
  LongWalkGraph(std::uint64_t seed, const LongWalk& config) : config_(config), seed_(seed) {}

  [[nodiscard]] bool done() const { return static_cast<int>(graph.keyframes.size()) == config_.keyframes; }

  /// Adds the next keyframe with its factors and new planes.
  void grow() {
    const int k = static_cast<int>(graph.keyframes.size());
    RandomValues random(seed_, static_cast<std::uint64_t>(k));
    const Pose X_true = truth(k);
    Pose X_MR = X_true;
    if (k > 0) {
      const Pose step = truth(k - 1).inverse() * X_true * random.pose(config_.noise, config_.noise);
      X_MR = graph.keyframes.back().X_MR * step;
      Matrix6d information = Matrix6d::Identity() / (0.01 * 0.01);
      information.bottomRightCorner<3, 3>() /= 0.1;
      graph.pose_factors.push_back({k - 1, k, step, information, false});
    }
    graph.keyframes.push_back({k * 1'000'000'000LL, X_MR, X_MR, 0});
    for (const int wall : in_sight(k)) {
      const Plane measured = increment(X_true.inverse() * true_plane(wall), random.vector(config_.noise));
      see(wall, measured);
    }
    if (graph.rooms.empty() && graph.planes.size() > 4) {
      graph.rooms.push_back({RoomKind::two_wall, {0.3, 0.2}, 0});
      graph.room_factors.push_back({0, {1, 2}, {0.0, 0.0}, 0.0, Eigen::Matrix2d::Identity() * 400.0});
    }
  }

  Graph graph;

 private:
  /// Plane 0 is the floor.
  [[nodiscard]] Plane true_plane(int wall) const {
    if (wall == 0) return {Eigen::Vector3d::UnitZ(), 0.6};
    RandomValues random(seed_ + 1000, static_cast<std::uint64_t>(wall));
    const Plane upright = random.wall(random.uniform(-3.0, 3.0), 0.0);
    // 2 to 6 m beside the way where it is first seen.
    return {upright.n, random.uniform(2.0, 6.0) - upright.n.dot(truth(2 * wall).t)};
  }
  [[nodiscard]] Pose truth(int k) const {
    const double a = 2.0 * std::numbers::pi * k / config_.lap;
    const double radius = 0.6 * config_.lap / (2.0 * std::numbers::pi);
    return Pose::from_xyz_yaw({radius * std::sin(a), radius * (1.0 - std::cos(a)), 0.0}, a);
  }
  [[nodiscard]] std::vector<int> in_sight(int k) const {
    std::vector<int> walls = {0};
    for (int first = std::max(0, k - config_.in_sight + 1); first <= k; ++first)
      if (first % 2 == 0)
        walls.push_back(1 + (config_.walls_a_lap > 0 ? (first / 2) % config_.walls_a_lap : first / 2));
    return walls;
  }
  void see(int wall, const Plane& measured_R) {
    const int keyframe = static_cast<int>(graph.keyframes.size()) - 1;
    if (wall >= static_cast<int>(graph.planes.size())) {
      graph.planes.resize(static_cast<std::size_t>(wall) + 1);
      graph.planes.back() = {graph.keyframes.back().X_MR * measured_R, wall == 0 ? PlaneKind::floor : PlaneKind::wall,
                             0, -1};
    }
    graph.plane_factors.push_back({keyframe, wall, measured_R, Eigen::Matrix3d::Identity() / (0.005 * 0.005)});
  }

  LongWalk config_;
  std::uint64_t seed_;
};

}  // namespace plumbline::slam
