// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/generators/family_options.h"

namespace plumbline::bim {

/// Sizes along reference lines, which run in the middle of inner walls and as far behind the inner face of outer ones.
struct CorridorOptions : FamilyOptions {
  int rooms = 5;
  Sides sides = Sides::one;
  double room_width_m = 4.0, room_depth_m = 5.0, corridor_width_m = 2.4, door_offset_m = 0.6;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("rooms", rooms, Field{.doc = "rooms on a side", .min = 2, .max = 100});
    v("sides", sides, Field{.doc = "sides with rooms"});
    v("room_width_m", room_width_m, Field{.doc = "along the corridor, m", .min = 2.6, .max = 20.0});
    v("room_depth_m", room_depth_m, Field{.doc = "m", .min = 2.5, .max = 20.0});
    v("corridor_width_m", corridor_width_m, Field{.doc = "m", .min = 1.5, .max = 10.0});
    v("door_offset_m", door_offset_m, Field{.doc = "of a door from the middle of its room, m", .min = 0.0, .max = 8.0});
  }
};

/// Flats of five rooms: rot180, mirrored, storeys.
struct UnitOptions : FamilyOptions {
  int storeys = 1;
  double unit_width_m = 8.0, unit_depth_m = 11.0, hall_width_m = 1.8;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("storeys", storeys, Field{.doc = "storeys that are alike", .min = 1, .max = 20});
    v("unit_width_m", unit_width_m, Field{.doc = "m", .min = 7.0, .max = 20.0});
    v("unit_depth_m", unit_depth_m, Field{.doc = "m", .min = 8.0, .max = 20.0});
    v("hall_width_m", hall_width_m, Field{.doc = "of the passage through a flat, m", .min = 1.5, .max = 2.5});
  }
};

struct Rot90Options : FamilyOptions {
  double core_m = 6.0, arm_m = 4.0;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("core_m", core_m, Field{.doc = "side of the square core, m", .min = 5.0, .max = 20.0});
    v("arm_m", arm_m, Field{.doc = "depth of the rooms around it, m", .min = 2.5, .max = 20.0});
  }
};

struct GridOptions : FamilyOptions {
  int rows = 3, columns = 4;
  double room_width_m = 4.5, room_depth_m = 4.0;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("rows", rows, Field{.doc = "rooms from south to north", .min = 1, .max = 50});
    v("columns", columns, Field{.doc = "rooms from west to east", .min = 2, .max = 50});
    v("room_width_m", room_width_m, Field{.doc = "m", .min = 2.6, .max = 20.0});
    v("room_depth_m", room_depth_m, Field{.doc = "m", .min = 2.6, .max = 20.0});
  }
};

struct RingOptions : FamilyOptions {
  int rooms = 3;
  double core_m = 8.0, corridor_width_m = 2.2, room_depth_m = 4.0, door_offset_m = 0.5;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("rooms", rooms, Field{.doc = "rooms on each of the four sides", .min = 1, .max = 30});
    v("core_m", core_m, Field{.doc = "side of the closed core, m", .min = 3.0, .max = 100.0});
    v("corridor_width_m", corridor_width_m, Field{.doc = "m", .min = 1.5, .max = 10.0});
    v("room_depth_m", room_depth_m, Field{.doc = "m", .min = 2.5, .max = 20.0});
    v("door_offset_m", door_offset_m, Field{.doc = "of a door from the middle of its room, m", .min = 0.0, .max = 5.0});
  }
};

struct HallOptions : FamilyOptions {
  double width_m = 18.0, depth_m = 12.0, side_room_m = 4.0, pillar_m = 0.4;
  int pillars_x = 3, pillars_y = 2;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("width_m", width_m, Field{.doc = "m", .min = 8.0, .max = 100.0});
    v("depth_m", depth_m, Field{.doc = "m", .min = 6.0, .max = 100.0});
    v("side_room_m", side_room_m, Field{.doc = "side of the rooms at both ends, m", .min = 2.6, .max = 10.0});
    v("pillar_m", pillar_m, Field{.doc = "side of a pillar, m", .min = 0.1, .max = 1.0});
    v("pillars_x", pillars_x, Field{.doc = "pillars from west to east", .min = 1, .max = 50});
    v("pillars_y", pillars_y, Field{.doc = "pillars from south to north", .min = 1, .max = 50});
  }
};

struct ShapeOptions : FamilyOptions {
  RoomShape shape = RoomShape::l;
  double width_m = 10.0, depth_m = 8.0, step_m = 2.0;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("shape", shape, Field{.doc = "of the two rooms"});
    v("width_m", width_m, Field{.doc = "of both together, m", .min = 8.0, .max = 40.0});
    v("depth_m", depth_m, Field{.doc = "m", .min = 5.0, .max = 40.0});
    v("step_m", step_m, Field{.doc = "how far the rooms leave the rectangle, m", .min = 1.2, .max = 3.0});
  }
};

struct LongOptions : FamilyOptions {
  double length_m = 40.0, width_m = 2.2, end_room_m = 4.0;

  template <class V>
  void visit(V& v) {
    FamilyOptions::visit(v);
    v("length_m", length_m, Field{.doc = "m", .min = 6.0, .max = 300.0});
    v("width_m", width_m, Field{.doc = "m", .min = 1.5, .max = 10.0});
    v("end_room_m", end_room_m, Field{.doc = "side of the rooms at both ends, m", .min = 2.6, .max = 12.0});
  }
};

}  // namespace plumbline::bim
