// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/generators/generator_options.h"

namespace plumbline::bim {

/// Sizes along reference lines, which run in the middle of inner walls and as far behind the inner face of outer ones.
struct CorridorOptions : GeneratorOptions {
  int rooms = 5;
  Sides sides = Sides::one;
  double room_width_m = 4.0, room_depth_m = 5.0, corridor_width_m = 2.4, door_offset_m = 0.6;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("rooms", rooms, plain_field("number of rooms on a side", {.min = 2, .max = 100}));
    v("sides", sides, Field{.doc = "sides of the corridor that have rooms"});
    v("room_width_m", room_width_m, Field{.doc = "size of a room along the corridor", .min = 2.6, .max = 20.0});
    v("room_depth_m", room_depth_m, Field{.doc = "size of a room across the corridor", .min = 2.5, .max = 20.0});
    v("corridor_width_m", corridor_width_m, Field{.doc = "width of the corridor", .min = 1.5, .max = 10.0});
    v("door_offset_m", door_offset_m,
      Field{.doc = "distance of a door from the middle of its room's wall", .min = 0.0, .max = 8.0});
  }
};

/// Flats of five rooms: rot180, mirrored, storeys.
struct UnitOptions : GeneratorOptions {
  int storeys = 1;
  double unit_width_m = 8.0, unit_depth_m = 11.0, hall_width_m = 1.8;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("storeys", storeys, plain_field("number of equal storeys", {.min = 1, .max = 20}));
    v("unit_width_m", unit_width_m, Field{.doc = "size of a flat along x", .min = 7.0, .max = 20.0});
    v("unit_depth_m", unit_depth_m, Field{.doc = "size of a flat along y", .min = 8.0, .max = 20.0});
    v("hall_width_m", hall_width_m, Field{.doc = "width of the passage through a flat", .min = 1.5, .max = 2.5});
  }
};

struct Rot90Options : GeneratorOptions {
  double core_m = 6.0, arm_m = 4.0;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("core_m", core_m, Field{.doc = "side length of the square core", .min = 5.0, .max = 20.0});
    v("arm_m", arm_m, Field{.doc = "depth of the rooms around the core", .min = 2.5, .max = 20.0});
  }
};

struct GridOptions : GeneratorOptions {
  int rows = 3, columns = 4;
  double room_width_m = 4.5, room_depth_m = 4.0;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("rows", rows, plain_field("number of rooms from south to north", {.min = 1, .max = 50}));
    v("columns", columns, plain_field("number of rooms from west to east", {.min = 2, .max = 50}));
    v("room_width_m", room_width_m, Field{.doc = "size of a room along x", .min = 2.6, .max = 20.0});
    v("room_depth_m", room_depth_m, Field{.doc = "size of a room along y", .min = 2.6, .max = 20.0});
  }
};

struct RingOptions : GeneratorOptions {
  int rooms = 3;
  double core_m = 8.0, corridor_width_m = 2.2, room_depth_m = 4.0, door_offset_m = 0.5;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("rooms", rooms, plain_field("number of rooms on each of the four sides", {.min = 1, .max = 30}));
    v("core_m", core_m, Field{.doc = "side length of the closed core", .min = 3.0, .max = 100.0});
    v("corridor_width_m", corridor_width_m, Field{.doc = "width of the corridor", .min = 1.5, .max = 10.0});
    v("room_depth_m", room_depth_m, Field{.doc = "size of a room across the corridor", .min = 2.5, .max = 20.0});
    v("door_offset_m", door_offset_m,
      Field{.doc = "distance of a door from the middle of its room's wall", .min = 0.0, .max = 5.0});
  }
};

struct HallOptions : GeneratorOptions {
  double width_m = 18.0, depth_m = 12.0, side_room_m = 4.0, pillar_m = 0.4;
  int pillars_x = 3, pillars_y = 2;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("width_m", width_m, Field{.doc = "size of the hall along x", .min = 8.0, .max = 100.0});
    v("depth_m", depth_m, Field{.doc = "size of the hall along y", .min = 6.0, .max = 100.0});
    v("side_room_m", side_room_m,
      Field{.doc = "side length of the square rooms at both ends", .min = 2.6, .max = 10.0});
    v("pillar_m", pillar_m, Field{.doc = "side length of a pillar", .min = 0.1, .max = 1.0});
    v("pillars_x", pillars_x, plain_field("number of pillars from west to east", {.min = 1, .max = 50}));
    v("pillars_y", pillars_y, plain_field("number of pillars from south to north", {.min = 1, .max = 50}));
  }
};

struct ShapeOptions : GeneratorOptions {
  RoomShape shape = RoomShape::l;
  double width_m = 10.0, depth_m = 8.0, step_m = 2.0;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("shape", shape, Field{.doc = "shape of the two rooms"});
    v("width_m", width_m, Field{.doc = "size of both rooms together along x", .min = 8.0, .max = 40.0});
    v("depth_m", depth_m, Field{.doc = "size of a room along y", .min = 5.0, .max = 40.0});
    v("step_m", step_m, Field{.doc = "how far the shape departs from a rectangle", .min = 1.2, .max = 3.0});
  }
};

struct LongOptions : GeneratorOptions {
  double length_m = 40.0, width_m = 2.2, end_room_m = 4.0;

  template <class V>
  void visit(V& v) {
    GeneratorOptions::visit(v);
    v("length_m", length_m, Field{.doc = "length of the corridor", .min = 6.0, .max = 300.0});
    v("width_m", width_m, Field{.doc = "width of the corridor", .min = 1.5, .max = 10.0});
    v("end_room_m", end_room_m, Field{.doc = "side length of the square rooms at both ends", .min = 2.6, .max = 12.0});
  }
};

}  // namespace plumbline::bim
