// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bim/geometry/plane.h"
#include "bim/geometry/polygon.h"
#include "bim/model/warning.h"

namespace plumbline::bim {

/// Closed triangle mesh in W, m. Triangles are counter-clockwise seen from outside.
struct Solid {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

/// What a storey is by its content: foundations and roofs hold no rooms to walk in.
enum class StoreyKind { habitable, foundation, roof };

struct Storey {
  std::string id;
  std::string name;
  double elevation_m = 0.0;  ///< z of the finished floor in W
  double height_m = 3.0;     ///< to the next storey or the ceiling
  std::int64_t step_id = 0;  ///< STEP entity number, 0 when not from IFC
  StoreyKind kind = StoreyKind::habitable;
};

enum class OpeningKind { door, window, opening_void };
enum class Leaf { open, closed, none };

/// A hole through a wall. s, z are in the wall's elevation: s along a to b from a, z above W's z = 0.
struct Opening {
  std::string id;
  int wall = -1;  ///< index into Building::walls
  OpeningKind kind = OpeningKind::door;
  double s_m = 0.0;  ///< centre along the wall, from a
  double width_m = 0.9;
  double z0_m = 0.0;  ///< sill
  double z1_m = 2.1;  ///< head
  Leaf leaf = Leaf::open;
  std::string material;        ///< of the leaf or pane that fills it; empty: opaque leaf, no pane
  std::optional<Solid> solid;  ///< IFC: the opening's uncut body in W; cut instead of the rectangle
  std::vector<Solid> parts;    ///< IFC: further touching bodies of the same opening
  std::string filling_id;      ///< id of the door or window that fills it, or empty
  std::int64_t step_id = 0;
  int rooms[2] = {-1, -1};  ///< index of the room on the left and on the right of a to b, -1 outside or unknown
};

/// A wall: reference line a to b, body from offset to offset + thickness across it (positive to the left of a to b).
/// A leaning one is sheared: what stands upright moves slope m to the left for every metre above z0; bodies and the
/// solids of its openings are given sheared.
struct Wall {
  std::string id;
  std::string name;
  int storey = -1;
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double offset_m = 0.0;
  double thickness_m = 0.2;
  double z0_m = 0.0;
  double z1_m = 3.0;
  double slope = 0.0;  ///< tangent of the angle it leans to the left
  std::string material;
  std::optional<Solid> body;  ///< IFC: the uncut body in W; absent for a plain box wall of a plan
  std::int64_t step_id = 0;

  [[nodiscard]] Eigen::Vector2d direction() const { return (b - a).normalized(); }
  [[nodiscard]] Eigen::Vector2d left() const {
    const Eigen::Vector2d e = direction();
    return {-e.y(), e.x()};
  }
  [[nodiscard]] double length() const { return (b - a).norm(); }
};

/// A stretch of a room's outline where no wall stands (open plan).
struct VirtualEdge {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();  ///< along the outline, counter-clockwise
  int room = -1;                                ///< index of the room beyond, -1 outside or unknown
  std::string door = {};                        ///< id of the door that stands there in no wall, or empty
};

struct Room {
  std::string id;
  std::string name;
  int storey = -1;
  Polygon2 polygon;  ///< counter-clockwise, clear inner outline
  double z0_m = 0.0;
  double z1_m = 3.0;
  std::vector<int> walls;  ///< indices of bounding walls, ascending
  std::vector<VirtualEdge> virtual_edges;
  std::int64_t step_id = 0;
  std::vector<Polygon2> holes;  ///< clockwise: what the room goes round and is not it; their rims bound it as well

  /// True inside or within 1e-9 m of the outline or the rim of a hole.
  [[nodiscard]] bool contains(const Eigen::Vector2d& p) const;
  /// Without the holes.
  [[nodiscard]] double area_m2() const;
  /// Distance to the outline or the rim of a hole, m.
  [[nodiscard]] double boundary_distance(const Eigen::Vector2d& p) const;
  [[nodiscard]] PolygonWithHoles2 outline() const { return {polygon, holes}; }
  /// The outline, then the rims of the holes: the room lies left of their edges.
  [[nodiscard]] std::vector<const Polygon2*> rims() const;
};

struct Slab {
  std::string id;
  int storey = -1;
  PolygonWithHoles2 polygon;
  double z0_m = -0.2;  ///< underside
  double z1_m = 0.0;   ///< top
  std::string material;
  std::optional<Solid> body;
  std::int64_t step_id = 0;
  bool assumed = false;  ///< stands in no file, see assumed_slabs
};

struct Column {
  std::string id;
  int storey = -1;
  Polygon2 footprint;
  double z0_m = 0.0;
  double z1_m = 3.0;
  std::string material;
  std::optional<Solid> body;
  std::int64_t step_id = 0;
};

/// One straight run of equal steps. Tread k (from 0) lies at z0 + (k + 1) rise, between k run and (k + 1) run from
/// start along yaw; the flight is centred on that line.
struct StairFlight {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< middle of the foot of the first riser
  double yaw = 0.0;                                 ///< rad, direction of ascent
  double width_m = 1.0;
  double z0_m = 0.0;  ///< level below the first riser
  int steps = 0;
  double rise_m = 0.17;
  double run_m = 0.28;
};

struct Landing {
  Polygon2 polygon;  ///< counter-clockwise
  double z_m = 0.0;
};

/// A walkable way from one storey to another: flights from the lowest up, with the landings between them.
struct Stair {
  std::string id;
  std::string name;
  int from = -1;            ///< storey at the foot
  int to = -1;              ///< storey at the head, -1 when it reaches none
  int rooms[2] = {-1, -1};  ///< room at the foot and at the head, -1 outside or unknown
  std::vector<StairFlight> flights;
  std::vector<Landing> landings;
  std::string material;
  std::vector<Solid> bodies;  ///< in W
  std::int64_t step_id = 0;
};

/// Any other solid in the building: clutter of a plan; door leaves and window panes; of IFC, railings, furniture, ...
struct Obstacle {
  std::string id;
  std::string kind;  ///< box | cylinder | door_leaf | window_pane | railing | furniture | ...
  int storey = -1;
  Solid body;
  bool planned = true;  ///< false: as-built only
  std::int64_t step_id = 0;
  std::string material = {};
};

/// Optical properties of a surface. Named by Wall::material and others.
struct Material {
  std::string id;
  double reflectivity = 0.5;  ///< share of light given back diffusely, 0 to 1
  double transmission = 0.0;  ///< share that goes through, 0 to 1
  double specular = 0.0;      ///< share mirrored, 0 to 1
  double retro = 0.0;         ///< share sent back where it came from, as signs and tapes do, 0 to 1
};

/// The normalised building: SI units, frame W, canonical order. One type serves as planned and as built.
struct Building {
  std::string name;
  std::string schema;  ///< "plan" | "IFC2X3" | "IFC4"
  std::string unit;    ///< length unit of the source
  std::vector<Storey> storeys;
  std::vector<Wall> walls;
  std::vector<Opening> openings;
  std::vector<Room> rooms;
  std::vector<Slab> slabs;
  std::vector<Column> columns;
  std::vector<Stair> stairs;
  std::vector<Obstacle> obstacles;
  std::vector<Material> materials;
  std::vector<Warning> warnings;
  /// Added to the file's coordinates, m: absent where they are those of W.
  std::optional<Eigen::Vector3d> moved_by = {};

  /// Hash of the content: ids and geometry of every element in their order; not the building's name, its source's
  /// unit, coordinates and entity numbers, nor warnings.
  [[nodiscard]] std::uint64_t hash() const;
};

/// Indices of the storeys from the lowest up (ties: as listed).
[[nodiscard]] std::vector<int> storeys_upwards(const Building& building);

}  // namespace plumbline::bim
