// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/generators/options.h"
#include "bim/symmetry/isometry.h"

namespace plumbline::bim {

inline constexpr double same_m = 1e-6;  ///< points of a template nearer to each other are one

/// Room drawn along the reference lines of its walls, which run in the middle between it and its neighbours.
struct TemplateRoom {
  std::string id;
  Polygon2 outline;  ///< counter-clockwise
};

/// Opening in the wall on which `at` lies.
struct TemplateOpening {
  std::string id;
  OpeningKind kind = OpeningKind::door;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double width_m = 1.0, height_m = 2.1, sill_m = 0.0;
};

struct TemplateRotation {
  double angle_deg = 180.0;
  Eigen::Vector2d about = Eigen::Vector2d::Zero();
};

/// One floor as rooms and what is in and between them; walls follow from it.
struct FloorTemplate {
  std::string name;
  std::vector<TemplateRoom> rooms;
  std::vector<TemplateOpening> openings;
  std::vector<PlanColumnEntry> columns;
  std::vector<PlanClutterEntry> clutter;
  std::vector<std::pair<std::string, std::string>> open;  ///< rooms with nothing between them
  std::vector<TemplateRotation> group;                    ///< proper isometries without the identity
  std::vector<std::vector<std::string>> alike;            ///< rooms of equal appearance that no rotation swaps
  std::string start;                                      ///< room a robot starts in
  int storeys = 1;

  void add_room(std::string id, Polygon2 outline);
  void add_door(std::string id, const Eigen::Vector2d& at, double width_m);
  /// A window of 1.2 m height above a sill of 0.9 m.
  void add_window(std::string id, const Eigen::Vector2d& at, double width_m);
  /// Square column from floor to ceiling.
  void add_column(std::string id, const Eigen::Vector2d& at, double side_m, double yaw_deg);
  /// Square box, 1 m high.
  void add_box(std::string id, const Eigen::Vector2d& at, double side_m, double yaw_deg);
  /// Rooms, openings and columns of another template, transformed by g, their ids with a suffix.
  void add_copy(const FloorTemplate& other, const Isometry2& g, const std::string& suffix);
  [[nodiscard]] int find_room(const std::string& id) const;
};

[[nodiscard]] Polygon2 rectangle(double x0, double y0, double x1, double y1);

/// A stretch of wall and the rooms it divides.
struct TemplateWall {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  int rooms[2] = {-1, -1};  ///< left of a to b, and right (-1: outside)
};

/// Walls along all room outlines, one for each pair of neighbours, in the order of the rooms.
[[nodiscard]] std::vector<TemplateWall> walls_of(const FloorTemplate& floor);
/// Number of the wall on which p lies, -1 when there is none.
[[nodiscard]] int wall_at(const std::vector<TemplateWall>& walls, const Eigen::Vector2d& p);

/// Entries of one storey, their ids with a prefix.
void add_storey_entries(const FloorTemplate& floor, const GeneratorOptions& options, const std::string& storey,
                        const std::string& prefix, PlanFile& plan);

}  // namespace plumbline::bim
