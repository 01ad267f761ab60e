// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bim/geometry/plane.h"
#include "slam/io/estimate.h"

namespace plumbline::slam {

/// Layer 1 [bavle2023, section V, Keyframes].
struct KeyframeVertex {
  Nanoseconds stamp = 0;
  Pose X_MR;  ///< estimate
  Pose X_OR;  ///< odometry at the same time
  int storey = 0;
};

enum class PlaneKind { wall, floor, ceiling };

/// Layer 2: one face of a wall, or a floor or ceiling. Normal towards the free space from which it was seen.
struct PlaneVertex {
  Plane plane_M;
  PlaneKind kind = PlaneKind::wall;
  int storey = 0;
  int merged_into = -1;   ///< id of the plane that took over its observations; -1: alive
  bool fixed = false;     ///< it is where it is; optimize() does not move it
  bool released = false;  ///< a floor of ground that slopes: later floors are other planes
};

/// Layer 3: centre of a four-wall room, of a two-wall stretch or of a polygon's corners.
struct RoomVertex {
  RoomKind kind = RoomKind::four_wall;
  Eigen::Vector2d center_M = Eigen::Vector2d::Zero();
  int storey = 0;
  bool found = true;  ///< false: the map no longer shows it; its factors are gone, its id stays
};

/// Layer 4: centre of a storey.
struct FloorVertex {
  Eigen::Vector2d center_M = Eigen::Vector2d::Zero();
  int storey = 0;
  int plane = -1;  ///< PlaneVertex of the walkable floor, -1 before it was seen
};

/// Relative pose between two keyframes; information of (translation, rotation) in the frame of `to`.
struct PoseFactor {
  int from = 0, to = 0;
  Pose X_FT;  ///< measured pose of `to` in `from`
  Matrix6d information = Matrix6d::Identity();
  bool loop = false;
};

/// A plane seen from a keyframe; information of (two tangential angles, offset) in R.
struct PlaneFactor {
  int keyframe = 0, plane = 0;
  Plane plane_R;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
};

/// A room with more planes is rejected as too ragged.
inline constexpr int max_room_planes = 16;

/// Where two walls of a room meet, by their indices among its planes.
using RoomCorner = std::array<int, 2>;

/// A room and its walls. Two or four: first and second are opposed, third and fourth too. A polygon's: its corners are
/// where two of its walls meet, each by its index in `planes`; corners at openings are left out.
struct RoomFactor {
  int room = 0;
  std::vector<int> planes;
  Eigen::Vector2d cluster_M = Eigen::Vector2d::Zero();  ///< centre of the free-space cluster, kept fixed
  double height_M = 0.0;                                ///< z at which the walls are cut, m
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
  std::vector<RoomCorner> corners = {};  ///< of a polygon, else empty
};

/// Where a room stands from the centre of its floor.
struct FloorFactor {
  int floor = 0, room = 0;
  Eigen::Vector2d offset_M = Eigen::Vector2d::Zero();  ///< floor centre - room centre
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

/// Two vertices that are one wall face.
struct DuplicateFactor {
  int a = 0, b = 0;
  Eigen::Vector3d anchor_M = Eigen::Vector3d::Zero();  ///< where their offsets are compared
  double angle_sigma = 0.01;                           ///< rad
  double offset_sigma = 0.02;                          ///< m
};

/// The four-layered situational graph as a plain value. A vertex's id is its index; ids in factors index the vectors.
struct Graph {
  std::vector<KeyframeVertex> keyframes;
  std::vector<PlaneVertex> planes;
  std::vector<RoomVertex> rooms;
  std::vector<FloorVertex> floors;
  std::vector<PoseFactor> pose_factors;
  std::vector<PlaneFactor> plane_factors;
  std::vector<RoomFactor> room_factors;
  std::vector<FloorFactor> floor_factors;
  std::vector<DuplicateFactor> duplicate_factors;
};

/// The loop closures among the pose factors, in their order.
[[nodiscard]] std::vector<LoopEdge> loop_edges(const Graph& graph);

/// Hash of every estimate, in order of layers and ids.
[[nodiscard]] std::uint64_t digest_of(const Graph& graph);

}  // namespace plumbline::slam
