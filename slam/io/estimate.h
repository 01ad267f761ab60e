// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "bim/geometry/plane.h"
#include "bim/geometry/polygon.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// The frame an estimate is in: M, a map of the method's own, or W, the building's plan.
enum class Frame { map, world };
enum class State { searching, ambiguous, converged, lost };

struct StampedPose {
  Nanoseconds stamp = 0;
  Pose X_FR;  ///< F is M or W, see Estimate::frame
};

/// A wall patch of the newest scan and the wall of the plan that it was taken for.
struct WallMatch {
  std::vector<int> faces;                          ///< ids of the plan's faces that make up the wall, ascending
  Eigen::Vector3d p0_R = Eigen::Vector3d::Zero();  ///< ends of the patch, free space on the left of p0 to p1
  Eigen::Vector3d p1_R = Eigen::Vector3d::Zero();
};

/// A pose that the robot may have.
struct Hypothesis {
  double mass = 0.0;  ///< posterior probability in [0, 1]; those of one Output sum to at most 1
  Pose X_WR;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw) in W, m and rad
  std::string room;                                      ///< PlanRoom name, or empty
  std::vector<WallMatch> walls = {};  ///< walls as associated at this pose; only with scans that made an update
};

/// One particle of a sample for the report: x, y in W, m; yaw, rad; weight as in the whole set, so that the weights of
/// a sample need not sum to 1. Its storey is not kept.
struct Particle {
  double x = 0.0, y = 0.0, yaw = 0.0, weight = 0.0;
};

struct StageDigest {
  std::string stage;
  std::uint64_t digest = 0;
};

/// CPU time of one call of a stage; only timings.json sees it.
struct StageTime {
  std::string stage;
  double cpu_ms = 0.0;
};

/// A method's answer right after one scan (causal).
struct Output {
  Nanoseconds stamp = 0;
  std::optional<Pose> X_FR;  ///< absent while a plan localization has no single answer
  State state = State::converged;
  int degenerate_directions = 0;  ///< of six, in which the surfaces that the scan met leave the pose open
  std::vector<Hypothesis> hypotheses;
  std::vector<Particle> particles;   ///< at most 500, for the report; empty when there is no particle set
  std::vector<StageDigest> digests;  ///< in pipeline order
  std::vector<StageTime> times;
};

/// An estimated wall face. Points satisfy n.x + d = 0, n towards the free space from which it was seen.
struct PlaneNode {
  int id = -1;
  Plane plane_F;
  Eigen::Vector2d p0 = Eigen::Vector2d::Zero();  ///< extent along the wall, in F
  Eigen::Vector2d p1 = Eigen::Vector2d::Zero();
  double z0 = 0.0;
  double z1 = 0.0;
  int observations = 0;
};

/// polygon: any closed chain of walls, of at least three sides, with openings between them or none.
enum class RoomKind { four_wall, two_wall, polygon };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(RoomKind) {
  return {"four_wall", "two_wall", "polygon"};
}

/// An estimated room.
struct RoomNode {
  int id = -1;
  RoomKind kind = RoomKind::four_wall;
  Eigen::Vector2d center_F = Eigen::Vector2d::Zero();
  Polygon2 polygon_F;       ///< counter-clockwise; two-wall: the stretch of corridor that was seen
  std::vector<int> planes;  ///< PlaneNode ids: (x+, x-, y+, y-), the pair, or the chain counter-clockwise
};

struct FloorNode {
  int id = -1;
  Eigen::Vector3d center_F = Eigen::Vector3d::Zero();
  Plane plane_F;
};

/// A loop closure that a method kept: the measured pose of R at `to` in R at `from`.
struct LoopEdge {
  Nanoseconds from = 0, to = 0;
  Pose X_FT;
};

/// How a method put returns of one scan into planes. Not all of the scan's: enough for a score.
struct SegmentedScan {
  Nanoseconds stamp = 0;
  Eigen::Vector3d sensor_R = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3i> point_mm;  ///< in R at stamp
  std::vector<int> plane;                 ///< of each point, within this scan; -1: none
};

/// A method's answer at the end of a run.
struct Estimate {
  Frame frame = Frame::map;
  std::vector<StampedPose> trajectory;  ///< after the last optimisation, one pose a scan
  std::vector<PlaneNode> planes;
  std::vector<RoomNode> rooms;
  std::vector<FloorNode> floors;
  std::vector<Eigen::Vector3f> map_F;               ///< point map, voxel-thinned to 0.05 m
  std::optional<std::vector<LoopEdge>> loops = {};  ///< absent of a method that closes none
  std::vector<SegmentedScan> segmented = {};        ///< a few scans; empty of a method that segments none
  Tree graph;                                       ///< as graph_tree() writes it; null where the method has none
};

}  // namespace plumbline::slam
