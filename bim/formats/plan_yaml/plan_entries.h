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

[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(OpeningKind) { return {"door", "window", "void"}; }
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(Leaf) { return {"open", "closed", "none"}; }

/// Where the line a to b lies in the wall's thickness, seen from a to b.
enum class Just { center, left, right };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(Just) { return {"center", "left", "right"}; }

/// Boxes, cylinders, and furniture with the same names as its shapes.
enum class ClutterShape {
  box,
  cylinder,
  table,
  desk,
  chair,
  bed,
  sofa,
  shelf,
  wardrobe,
  kitchen,
  machine,
  pallet,
  person
};
[[nodiscard]] constexpr std::array<std::string_view, 13> names_of(ClutterShape) {
  return {"box",   "cylinder", "table",   "desk",    "chair",  "bed",   "sofa",
          "shelf", "wardrobe", "kitchen", "machine", "pallet", "person"};
}

/// Limits of what a plan may say. A building reaches at most 10 km from its origin, so that a float keeps 1 mm.
inline constexpr double plan_reach_m = 1e4;
inline constexpr double plan_size_max_m = 1e3;
inline constexpr std::size_t plan_entries_max = 20000;  ///< of a list
inline constexpr std::size_t plan_corners_max = 2000;   ///< of a room
inline constexpr std::size_t plan_storeys_max = 1000;   ///< storeys, stairs and deviations
inline constexpr double plan_length_min_m = 0.01;       ///< of a wall

inline constexpr Field plan_id{.doc = "id, unique in its list, without '/'", .required = true};
inline constexpr Field plan_storey{.doc = "id of its storey", .required = true};
inline constexpr Field plan_centre{
    .doc = "centre", .unit = "m", .min = -plan_reach_m, .max = plan_reach_m, .required = true};
inline constexpr Field plan_wall_height{
    .doc = "height; the storey's when not given", .min = 0.01, .max = plan_size_max_m};
inline constexpr Field plan_size{
    .doc = "size along its own x and y", .unit = "m", .min = 0.01, .max = plan_size_max_m, .required = true};
inline constexpr Field plan_yaw{.doc = "rotation about its centre, counter-clockwise", .min = -360.0, .max = 360.0};
inline constexpr Field plan_material{.doc = "id of its material, declared or preset"};

struct PlanStoreyEntry {
  std::string id;
  double elevation_m = 0.0;
  std::optional<double> height_m;
  std::string copy_of;
  std::string floor_material;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("elevation_m", elevation_m,
      Field{.doc = "height of the finished floor", .min = -plan_reach_m, .max = plan_reach_m});
    v("height_m", height_m,
      Field{.doc = "height from floor to ceiling; 3 m when not given, or that of the storey it copies",
            .min = 0.5,
            .max = plan_size_max_m});
    v("copy_of", copy_of, Field{.doc = "id of the storey whose content this storey repeats"});
    v("floor_material", floor_material, Field{.doc = "id of the floor slab's material, declared or preset"});
  }
};

struct PlanWallEntry {
  std::string id, storey;
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  double thickness_m = 0.2;
  Just just = Just::center;
  std::string material;
  std::optional<double> height_m;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_storey);
    v("a", a,
      Field{.doc = "start of the reference line",
            .unit = "m",
            .min = -plan_reach_m,
            .max = plan_reach_m,
            .required = true});
    v("b", b,
      Field{.doc = "end of the reference line",
            .unit = "m",
            .min = -plan_reach_m,
            .max = plan_reach_m,
            .required = true});
    v("thickness_m", thickness_m, Field{.doc = "thickness of the wall", .min = 0.01, .max = 10.0});
    v("just", just, Field{.doc = "position of the reference line in the thickness, seen from a to b"});
    v("material", material, plan_material);
    v("height_m", height_m, plan_wall_height);
  }
};

struct PlanOpeningEntry {
  std::string id, wall;
  OpeningKind kind = OpeningKind::door;
  double s_m = 0.0;
  double width_m = 0.9;
  double height_m = 2.1;
  double sill_m = 0.0;
  std::optional<Leaf> leaf;
  std::string material;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("wall", wall, Field{.doc = "id of its wall", .required = true});
    v("kind", kind, Field{.doc = "kind of opening; a void has neither leaf nor pane"});
    v("s_m", s_m,
      Field{.doc = "distance of the opening's centre from a, along the wall",
            .min = 0.0,
            .max = plan_reach_m,
            .required = true});
    v("width_m", width_m, Field{.doc = "clear width along the wall", .min = 0.01, .max = plan_size_max_m});
    v("height_m", height_m, Field{.doc = "clear height", .min = 0.01, .max = plan_size_max_m});
    v("sill_m", sill_m,
      Field{.doc = "height of the lower edge above the wall's lower edge", .min = 0.0, .max = plan_size_max_m});
    v("leaf", leaf, Field{.doc = "state of a door's leaf, open when not given; an open leaf has no geometry"});
    v("material", material, Field{.doc = "id of the leaf's or pane's material; a window's is glass when not given"});
  }
};

struct PlanRoomEntry {
  std::string id, storey;
  std::vector<Eigen::Vector2d> polygon;
  std::vector<std::string> walls;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_storey);
    v("polygon", polygon,
      Field{.doc = "corners of the room, in order",
            .unit = "m",
            .min = -plan_reach_m,
            .max = plan_reach_m,
            .required = true});
    v("walls", walls, Field{.doc = "ids of the bounding walls; computed from the polygon when not given"});
  }
};

struct PlanColumnEntry {
  std::string id, storey;
  Eigen::Vector2d at = Eigen::Vector2d::Zero(), size = Eigen::Vector2d::Zero();
  double yaw_deg = 0.0;
  std::optional<double> height_m;
  std::string material;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("storey", storey, plan_storey);
    v("at", at, plan_centre);
    v("size", size, plan_size);
    v("yaw_deg", yaw_deg, plan_yaw);
    v("height_m", height_m, plan_wall_height);
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
    v("storey", storey, plan_storey);
    v("shape", shape,
      Field{.doc =
                "shape of the object; the diameters of a cylinder are `size`; furniture has its back at its own +y"});
    v("at", at, plan_centre);
    v("size", size, plan_size);
    v("yaw_deg", yaw_deg, plan_yaw);
    v("height_m", height_m, Field{.doc = "height", .min = 0.01, .max = plan_size_max_m});
    v("material", material, plan_material);
  }
};

struct PlanMaterialEntry : Material {
  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("reflectivity", reflectivity, share_field("share of the light that is reflected diffusely"));
    v("transmission", transmission, share_field("share of the light that is transmitted"));
    v("specular", specular, share_field("share of the light that is reflected as by a mirror"));
    v("retro", retro, share_field("share of the light that is reflected back to its source, as by signs and tapes"));
  }
};

}  // namespace plumbline::bim
