// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/build.h"

#include <cmath>
#include <numbers>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

/// A wall goes on this far beside an opening.
constexpr double beside_opening_m = 0.3;

/// Windows of rooms in a row stand off the middle by this share of the room's width, so that the outer wall has room
/// for a niche.
constexpr double window_off = 0.2;

double window_width(double room_width_m) { return std::min(1.4, 0.35 * room_width_m); }

/// A door of this offset must leave wall on both sides of it, between the middles of the side walls.
void check_door(double room_width_m, double offset_m, const GeneratorOptions& options, const Mark& mark) {
  const double reach = offset_m + 0.5 * options.door_m + beside_opening_m;
  if (reach > 0.5 * room_width_m)
    throw InputError(mark,
                     "a door " + format_number(offset_m) + " m off the middle does not fit a room " +
                         format_number(room_width_m) + " m wide; it may be off by " +
                         format_number(std::max(0.0, 0.5 * room_width_m - 0.5 * options.door_m - beside_opening_m)) +
                         " m at most");
}

/// Five different rooms around a passage; the flat fills [0, w] x [0, d] and is entered at (w, d / 2).
FloorTemplate unit(const UnitOptions& o) {
  const double w = o.unit_width_m, d = o.unit_depth_m, y0 = 0.5 * (d - o.hall_width_m), y1 = d - y0;
  const double kitchen = 0.6 * w, study = 0.45 * w;
  FloorTemplate floor;
  floor.add_room("hall", rectangle(0, y0, w, y1));
  floor.add_room("living", rectangle(0, 0, kitchen, y0));
  floor.add_room("kitchen", rectangle(kitchen, 0, w, y0));
  floor.add_room("bedroom", rectangle(0, y1, study, d));
  floor.add_room("study", rectangle(study, y1, w, d));
  floor.add_door("door_living", {0.35 * w, y0}, o.door_m);
  floor.add_door("door_kitchen", {0.5 * (kitchen + w), y0}, o.door_m);
  floor.add_door("door_bedroom", {0.2 * w, y1}, o.door_m);
  floor.add_door("door_study", {0.8 * w, y1}, o.door_m);
  floor.add_window("window_living", {0.25 * w, 0}, 1.6);
  floor.add_window("window_study", {0.7 * w, d}, 1.2);
  return floor;
}

/// Two flats with one door between their halls.
FloorTemplate two_units(const UnitOptions& o, const Isometry2& second) {
  const FloorTemplate flat = unit(o);
  FloorTemplate floor;
  floor.add_copy(flat, {}, "_a");
  floor.add_copy(flat, second, "_b");
  floor.add_door("door_between", {o.unit_width_m, 0.5 * o.unit_depth_m}, o.door_m);
  floor.start = "living_a";
  floor.storeys = o.storeys;
  return floor;
}

}  // namespace

FloorTemplate corridor(const CorridorOptions& o, const Mark& mark) {
  check_door(o.room_width_m, o.door_offset_m, o, mark);
  const double length = o.rooms * o.room_width_m;
  FloorTemplate floor;
  floor.add_room("corridor", rectangle(0, 0, length, o.corridor_width_m));
  FloorTemplate side;
  std::vector<std::string> alike;
  for (int i = 0; i < o.rooms; ++i) {
    const std::string number = std::to_string(i + 1);
    const double x0 = i * o.room_width_m, middle = x0 + 0.5 * o.room_width_m;
    const double y0 = o.corridor_width_m, y1 = y0 + o.room_depth_m;
    side.add_room("room_" + number, rectangle(x0, y0, x0 + o.room_width_m, y1));
    side.add_door("door_" + number, {middle - o.door_offset_m, y0}, o.door_m);
    side.add_window("window_" + number, {middle + window_off * o.room_width_m, y1}, window_width(o.room_width_m));
    // Behind glass the outer wall shows which room is the last.
    if (!o.glass || (i > 0 && i + 1 < o.rooms)) alike.push_back("room_" + number);
  }
  if (o.sides == Sides::one) {
    floor.add_copy(side, {}, "");
  } else {
    const TemplateRotation turn{180.0, {0.5 * length, 0.5 * o.corridor_width_m}};
    floor.add_copy(side, {}, "_north");
    floor.add_copy(side, Isometry2::turn(std::numbers::pi, turn.about), "_south");
    floor.group = {turn};
    const std::vector<std::string> numbered = alike;
    alike.clear();
    for (const char* suffix : {"_north", "_south"})
      for (const std::string& id : numbered) alike.push_back(id + suffix);
  }
  floor.start = "room_" + std::to_string(o.rooms / 2 + 1) + (o.sides == Sides::one ? "" : "_north");
  floor.alike = {std::move(alike)};
  return floor;
}

FloorTemplate rot180(const UnitOptions& o, const Mark&) {
  const TemplateRotation turn{180.0, {o.unit_width_m, 0.5 * o.unit_depth_m}};
  FloorTemplate floor = two_units(o, Isometry2::turn(std::numbers::pi, turn.about));
  floor.group = {turn};
  return floor;
}

FloorTemplate mirrored(const UnitOptions& o, const Mark&) {
  return two_units(o, Isometry2::taking(std::numbers::pi, true, {0.0, 0.0}, {2.0 * o.unit_width_m, 0.0}));
}

FloorTemplate storeys(const UnitOptions& o, const Mark& mark) {
  if (o.storeys < 2) throw InputError(mark, "one storey is like no other; --storeys must be at least 2");
  FloorTemplate floor = unit(o);
  floor.start = "living";
  floor.storeys = o.storeys;
  return floor;
}

FloorTemplate rot90(const Rot90Options& o, const Mark&) {
  const double c = 0.5 * o.core_m, r = c + o.arm_m, divide = -0.2 * c;
  FloorTemplate arm;
  arm.add_room("office", rectangle(-r, c, divide, r));
  arm.add_room("store", rectangle(divide, c, c, r));
  arm.add_door("door_office", {0.5 * (divide - c), c}, o.door_m);
  arm.add_door("door_store", {0.5 * (divide + c) + 0.1 * c, c}, o.door_m);
  arm.add_window("window", {0.5 * (divide - r), r}, 1.2);
  FloorTemplate floor;
  floor.add_room("core", rectangle(-c, -c, c, c));
  const char* const suffixes[] = {"_north", "_west", "_south", "_east"};
  for (int k = 0; k < 4; ++k) {
    floor.add_copy(arm, Isometry2::turn(0.5 * k * std::numbers::pi, {0.0, 0.0}), suffixes[k]);
    if (k > 0) floor.group.push_back({90.0 * k, {0.0, 0.0}});
  }
  floor.start = "office_north";
  return floor;
}

FloorTemplate grid(const GridOptions& o, const Mark& mark) {
  check_door(std::min(o.room_width_m, o.room_depth_m), 0.0, o, mark);
  const double w = o.room_width_m, d = o.room_depth_m;
  FloorTemplate floor;
  const auto id = [](int row, int column) {
    return "room_" + std::to_string(row + 1) + "_" + std::to_string(column + 1);
  };
  for (int i = 0; i < o.rows; ++i) {
    for (int j = 0; j < o.columns; ++j) {
      floor.add_room(id(i, j), rectangle(j * w, i * d, (j + 1) * w, (i + 1) * d));
      const std::string from = "door_" + std::to_string(i + 1) + "_" + std::to_string(j + 1);
      if (j + 1 < o.columns) floor.add_door(from + "_east", {(j + 1) * w, (i + 0.5) * d}, o.door_m);
      if (i + 1 < o.rows) floor.add_door(from + "_north", {(j + 0.5) * w, (i + 1) * d}, o.door_m);
    }
  }
  const Eigen::Vector2d middle(0.5 * o.columns * w, 0.5 * o.rows * d);
  const bool square = o.rows == o.columns && w == d;
  for (int k = 1; k < 4; ++k)
    if (square || k == 2) floor.group.push_back({90.0 * k, middle});
  floor.start = id(0, 0);
  return floor;
}

FloorTemplate ring(const RingOptions& o, const Mark& mark) {
  const double k = 0.5 * o.core_m, l = k + o.corridor_width_m, width = 2.0 * l / o.rooms;
  check_door(width, o.door_offset_m, o, mark);
  FloorTemplate side;
  side.add_room("corridor", {{-k, k}, {k, k}, {l, l}, {-l, l}});
  for (int j = 0; j < o.rooms; ++j) {
    const std::string number = "_" + std::to_string(j + 1);
    const double x0 = -l + j * width, middle = x0 + 0.5 * width;
    side.add_room("room" + number, rectangle(x0, l, x0 + width, l + o.room_depth_m));
    side.add_door("door" + number, {middle - o.door_offset_m, l}, o.door_m);
    side.add_window("window" + number, {middle + window_off * width, l + o.room_depth_m}, window_width(width));
  }
  FloorTemplate floor;
  const char* const suffixes[] = {"_north", "_west", "_south", "_east"};
  for (int i = 0; i < 4; ++i) {
    floor.add_copy(side, Isometry2::turn(0.5 * i * std::numbers::pi, {0.0, 0.0}), suffixes[i]);
    floor.open.emplace_back(std::string("corridor") + suffixes[i], std::string("corridor") + suffixes[(i + 1) % 4]);
    if (i > 0) floor.group.push_back({90.0 * i, {0.0, 0.0}});
  }
  floor.start = "room_1_north";
  return floor;
}

FloorTemplate hall(const HallOptions& o, const Mark& mark) {
  const double w = o.width_m, d = o.depth_m, s = o.side_room_m, middle = 0.5 * d, off = 0.1 * d;
  if (s + 2.0 * off > d)
    throw InputError(mark, "the side rooms do not fit beside a hall " + format_number(d) +
                               " m deep; their side may be " + format_number(d - 2.0 * off) + " m at most");
  const double gap_x = w / (o.pillars_x + 1) - o.pillar_m, gap_y = d / (o.pillars_y + 1) - o.pillar_m;
  if (std::min(gap_x, gap_y) < 1.2)
    throw InputError(mark, "the pillars stand " + format_number(std::min(gap_x, gap_y)) +
                               " m apart; the robot needs at least 1.2 m: fewer pillars or a larger hall");
  const TemplateRotation turn{180.0, {0.5 * w, middle}};
  FloorTemplate floor;
  floor.add_room("hall", rectangle(0, 0, w, d));
  FloorTemplate end;
  end.add_room("room", rectangle(-s, middle - 0.5 * s + off, 0, middle + 0.5 * s + off));
  end.add_door("door", {0.0, middle + off}, o.door_m);
  floor.add_copy(end, {}, "_west");
  floor.add_copy(end, Isometry2::turn(std::numbers::pi, turn.about), "_east");
  for (int i = 1; i <= o.pillars_x; ++i)
    for (int j = 1; j <= o.pillars_y; ++j)
      floor.add_column("pillar_" + std::to_string(i) + "_" + std::to_string(j),
                       {i * w / (o.pillars_x + 1), j * d / (o.pillars_y + 1)}, o.pillar_m, 0.0);
  floor.group = {turn};
  floor.start = "room_west";
  return floor;
}

FloorTemplate shapes(const ShapeOptions& o, const Mark&) {
  const double w = o.width_m, d = o.depth_m, x = 0.5 * w, s = o.step_m;
  FloorTemplate half;
  switch (o.shape) {
    case RoomShape::l:
      half.add_room("room", {{0, 0}, {x + s, 0}, {x + s, 0.5 * d}, {x - s, 0.5 * d}, {x - s, d}, {0, d}});
      break;
    case RoomShape::trapezoid:
      half.add_room("room", {{0, 0}, {x + s, 0}, {x - s, d}, {0, d}});
      break;
    case RoomShape::chamfer:
      half.add_room("room", {{s, 0}, {x, 0}, {x, d}, {0, d}, {0, s}});
      break;
  }
  half.add_window("window", {0.0, 0.7 * d}, 1.2);
  const TemplateRotation turn{180.0, {x, 0.5 * d}};
  FloorTemplate floor;
  floor.add_copy(half, {}, "_west");
  floor.add_copy(half, Isometry2::turn(std::numbers::pi, turn.about), "_east");
  floor.add_door("door", turn.about, o.door_m);
  floor.group = {turn};
  floor.start = "room_west";
  return floor;
}

FloorTemplate long_corridor(const LongOptions& o, const Mark& mark) {
  if (o.end_room_m < o.width_m)
    throw InputError(mark, "the rooms at the ends are narrower than the corridor; their side must be at least " +
                               format_number(o.width_m) + " m");
  const double l = o.length_m, middle = 0.5 * o.width_m, s = o.end_room_m;
  FloorTemplate floor, end;
  floor.add_room("corridor", rectangle(0, 0, l, o.width_m));
  end.add_room("room", rectangle(-s, middle - 0.5 * s, 0, middle + 0.5 * s));
  end.add_door("door", {0.0, middle}, o.door_m);
  const TemplateRotation turn{180.0, {0.5 * l, middle}};
  floor.add_copy(end, {}, "_west");
  floor.add_copy(end, Isometry2::turn(std::numbers::pi, turn.about), "_east");
  floor.group = {turn};
  floor.start = "room_west";
  return floor;
}

}  // namespace plumbline::bim
