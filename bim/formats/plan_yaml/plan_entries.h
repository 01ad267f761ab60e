// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Where the line a to b lies in the wall's thickness, seen from a to b.
enum class Just { center, left, right };
enum class ClutterShape { box, cylinder };

}  // namespace plumbline::bim

namespace plumbline {

template <>
struct EnumNames<bim::Just> {
  static constexpr std::array<std::string_view, 3> names = {"center", "left", "right"};
};
template <>
struct EnumNames<bim::ClutterShape> {
  static constexpr std::array<std::string_view, 2> names = {"box", "cylinder"};
};
template <>
struct EnumNames<bim::OpeningKind> {
  static constexpr std::array<std::string_view, 3> names = {"door", "window", "void"};
};
template <>
struct EnumNames<bim::Leaf> {
  static constexpr std::array<std::string_view, 3> names = {"open", "closed", "none"};
};

}  // namespace plumbline

namespace plumbline::bim {

/// Limits of what a plan may say. A building reaches at most 10 km from its origin, so that a float keeps 1 mm.
inline constexpr double plan_reach_m = 1e4;
inline constexpr double plan_size_max_m = 1e3;
inline constexpr std::size_t plan_entries_max = 20000;  ///< of a list
inline constexpr std::size_t plan_corners_max = 2000;   ///< of a room
inline constexpr std::size_t plan_storeys_max = 1000;   ///< storeys, stairs and deviations
inline constexpr double plan_length_min_m = 0.01;       ///< of a wall

inline constexpr Field plan_id{.doc = "unique in its list, without '/'", .required = true};
inline constexpr Field plan_reference{.doc = "id of another element", .required = true};
inline constexpr Field plan_place{.doc = "in the plan, m", .min = -plan_reach_m, .max = plan_reach_m, .required = true};
inline constexpr Field plan_height{.doc = "height", .min = 0.01, .max = plan_size_max_m};
inline constexpr Field plan_width{.doc = "along the wall", .min = 0.01, .max = plan_size_max_m};
inline constexpr Field plan_size{
    .doc = "along its own x and y, m", .min = 0.01, .max = plan_size_max_m, .required = true};
inline constexpr Field plan_yaw{.doc = "turned about its centre", .min = -360.0, .max = 360.0};
inline constexpr Field plan_share{.doc = "share of the light", .min = 0.0, .max = 1.0};

inline constexpr Field plan_material{.doc = "id of a material, declared or preset"};

struct PlanStoreyEntry {
  std::string id;
  double elevation_m = 0.0;
  std::optional<double> height_m;  ///< 3 m, or that of the storey it copies
  std::string copy_of;
  std::string floor_material;  ///< of its floor slab

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("elevation_m", elevation_m, Field{.doc = "of the finished floor", .min = -plan_reach_m, .max = plan_reach_m});
    v("height_m", height_m,
      Field{.doc = "floor to ceiling; 3 m, or that of the storey it copies", .min = 0.5, .max = plan_size_max_m});
    v("copy_of", copy_of, Field{.doc = "storey whose content stands here again"});
    v("floor_material", floor_material, plan_material);
  }
};

struct PlanWallEntry {
  std::string id, storey;
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  double thickness_m = 0.2;
  Just just = Just::center;
  std::string material;
  std::optional<double> height_m;  ///< the storey's

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_reference);
    v("a", a, plan_place);
    v("b", b, plan_place);
    v("thickness_m", thickness_m, Field{.doc = "across", .min = 0.01, .max = 10.0});
    v("just", just, Field{.doc = "where a-b lies in the thickness, seen from a to b"});
    v("material", material, plan_material);
    v("height_m", height_m, Field{.doc = "the storey's when not given", .min = 0.01, .max = plan_size_max_m});
  }
};

struct PlanOpeningEntry {
  std::string id, wall;
  OpeningKind kind = OpeningKind::door;
  double s_m = 0.0;
  double width_m = 0.9;
  double height_m = 2.1;
  double sill_m = 0.0;
  std::optional<Leaf> leaf;  ///< door: open; window and void: none
  std::string material;      ///< of the leaf or pane; a window's is glass when not given

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("wall", wall, plan_reference);
    v("kind", kind, Field{.doc = "a void has neither leaf nor pane"});
    v("s_m", s_m, Field{.doc = "centre along the wall, from a", .min = 0.0, .max = plan_reach_m, .required = true});
    v("width_m", width_m, plan_width);
    v("height_m", height_m, plan_height);
    v("sill_m", sill_m, Field{.doc = "above the wall's lower edge", .min = 0.0, .max = plan_size_max_m});
    v("leaf", leaf, Field{.doc = "of a door, open when not given; an open leaf stands nowhere"});
    v("material", material, Field{.doc = "of the leaf or pane; a window's is glass when not given"});
  }
};

struct PlanRoomEntry {
  std::string id, storey;
  std::vector<Eigen::Vector2d> polygon;
  std::vector<std::string> walls;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_reference);
    v("polygon", polygon, plan_place);
    v("walls", walls, Field{.doc = "bounding walls; found when not named"});
  }
};

struct PlanColumnEntry {
  std::string id, storey;
  Eigen::Vector2d at = Eigen::Vector2d::Zero(), size = Eigen::Vector2d::Zero();
  double yaw_deg = 0.0;
  std::optional<double> height_m;  ///< the storey's
  std::string material;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_reference);
    v("at", at, plan_place);
    v("size", size, plan_size);
    v("yaw_deg", yaw_deg, plan_yaw);
    v("height_m", height_m, Field{.doc = "the storey's when not given", .min = 0.01, .max = plan_size_max_m});
    v("material", material, plan_material);
  }
};

struct PlanClutterEntry {
  std::string id, storey;
  ClutterShape shape = ClutterShape::box;
  Eigen::Vector2d at = Eigen::Vector2d::Zero(), size = Eigen::Vector2d::Zero();
  double yaw_deg = 0.0;
  double height_m = 1.0;
  std::string material;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_reference);
    v("shape", shape, Field{.doc = "a cylinder has `size` as its diameters"});
    v("at", at, plan_place);
    v("size", size, plan_size);
    v("yaw_deg", yaw_deg, plan_yaw);
    v("height_m", height_m, plan_height);
    v("material", material, plan_material);
  }
};

struct PlanMaterialEntry : Material {
  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("reflectivity", reflectivity, plan_share);
    v("transmission", transmission, plan_share);
    v("specular", specular, plan_share);
    v("retro", retro, plan_share);
  }
};

}  // namespace plumbline::bim
