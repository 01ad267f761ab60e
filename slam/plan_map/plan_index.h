// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/plane.h"
#include "bim/geometry/polygon.h"
#include "bim/plan/plan.h"
#include "slam/plan_map/face_sectors.h"
#include "slam/plan_map/segment_grid.h"
#include "slam/plan_map/structure.h"

namespace plumbline::slam {

struct PlanIndexConfig {
  double cell_m = 0.5;
  double line_gap_m = 1.5;
  double line_offset_m = 0.02;
  double line_angle_rad = 0.01;
  double wall_band_m = 1.0;
  int visibility_rays = 72;
  double visibility_range_m = 25.0;
  double body_height_m = 0.4;
  double row_min_m = 3.0;
  double row_gap_m = 0.3;
  bool furniture = true;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, Field{.doc = "cell size of the look-up grid", .min = 0.05});
    v("line_gap_m", line_gap_m,
      Field{.doc = "largest gap between coplanar faces of one line; a door is about 1 m wide", .min = 0});
    v("line_offset_m", line_offset_m, Field{.doc = "largest offset between faces of one line", .min = 0});
    v("line_angle_rad", line_angle_rad, Field{.doc = "largest angle between faces of one line", .min = 0});
    v("wall_band_m", wall_band_m, Field{.doc = "height above the floor at which a face counts as wall", .min = 0});
    v("visibility_rays", visibility_rays,
      Field{.doc = "rays from each sample point of a cell that list the lines seen from it", .min = 8, .max = 10000});
    // A wall patch of a VLP-16 farther away has too few rings.
    v("visibility_range_m", visibility_range_m, Field{.doc = "largest range of these rays", .min = 0});
    v("body_height_m", body_height_m,
      Field{.doc = "height of the robot's trunk, which must fit through doors", .min = 0});
    // Assumed: longer than a wardrobe or a kitchen, which leave walls to be seen.
    v("row_min_m", row_min_m,
      Field{.doc = "least length of a row of planned furniture whose front proposes poses as a wall does", .min = 0});
    // Assumed: less than a partition with furniture on both sides.
    v("row_gap_m", row_gap_m, Field{.doc = "largest gap between pieces of one row", .min = 0});
    v("furniture", furniture, Field{.doc = "whether planned furniture counts as part of the plan"});
  }
};

/// Coplanar faces of one storey seen as one plane [shaheer2023, eq. 1-2]; frame I.
struct WallLine {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();  ///< start; the line runs along e, free space on its left
  Eigen::Vector2d e = Eigen::Vector2d::UnitX();
  Eigen::Vector2d n = Eigen::Vector2d::UnitY();  ///< into free space
  double length = 0.0;
  double d = 0.0;        ///< n.p + d = 0
  double azimuth = 0.0;  ///< of n, rad
  /// Along e from a: doors and windows over more than 0.6 of the wall's height, so no door of 2.1 m in a wall above
  /// 3.5 m. What is seen there is not the wall.
  std::vector<Eigen::Vector2d> openings = {};
};

struct LocalRoom {
  int plan_room = -1;  ///< index into Plan::rooms
  std::string name;
  Polygon2 polygon;
};

/// One storey in I with its look-up tables.
struct StoreyIndex {
  int plan_storey = -1;
  double floor_z = 0.0;  ///< of its elevation, in I
  double ceiling_z = 3.0;
  std::optional<bim::WalkedFloors> floors;  ///< in I, where they do not all lie at floor_z
  std::vector<PlanSegment> segments;        ///< wall faces, in an order that depends on geometry alone
  std::vector<WallLine> lines;
  std::vector<WallLine> rows;  ///< fronts of planned furniture that may look like walls, where it is no part of `lines`
  std::vector<LocalRoom> rooms;
  SegmentGrid grid;                            ///< over segments
  FaceSectors sectors;                         ///< by cell of the grid
  std::vector<std::vector<int>> visible;       ///< per cell of the grid: lines seen from it, ascending
  std::shared_ptr<const Structure> structure;  ///< of the whole plan; copies of the storey share it
  std::shared_ptr<const Structure> furniture;  ///< that was planned, of the whole plan; null where none was

  /// Height in I of the floor at p. m.
  [[nodiscard]] double floor_at(const Eigen::Vector2d& p_I) const {
    return floors ? bim::height_at(*floors, p_I) : floor_z;
  }
  [[nodiscard]] double lowest_floor() const { return floors ? floors->ground_m : floor_z; }
  /// Planes of all its floors, in I.
  [[nodiscard]] std::vector<Plane> floor_planes() const;
  /// Room that holds p, or -1 (ties: lowest).
  [[nodiscard]] int room_at(const Eigen::Vector2d& p) const;
  /// True in a room, in a doorway and wherever else the plan has something to stand on at the storey's height.
  [[nodiscard]] bool has_floor_at(const Eigen::Vector2d& p_I) const;
};

/// The plan as the localization uses it. Everything stands in a frame I that the plan itself fixes: origin and x axis
/// along the first edge of the room whose name is the smallest, z from the floor of that room's storey. Coordinates in
/// I are rounded to 1e-6 m, so a plan moved as a whole gives the same numbers and the same decisions.
struct PlanIndex {
  PlanIndexConfig config;
  Pose X_WI;
  std::vector<StoreyIndex> storeys;  ///< those where the robot may be

  /// Height band and polygon area from which particles are drawn, m^2.
  [[nodiscard]] double free_area() const;
};

/// Tables of the given storey, or of all storeys that have rooms. Throws InputError when the storey is not in the plan
/// or no room is.
[[nodiscard]] PlanIndex make_plan_index(const bim::Plan& plan_W, const std::optional<std::string>& storey,
                                        const PlanIndexConfig& config);

/// Adds a storey of the plan that the index does not have. Returns its place in PlanIndex::storeys.
int add_storey(PlanIndex& index, const bim::Plan& plan_W, int plan_storey);

}  // namespace plumbline::slam
