// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/faults.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/boxes.h"
#include "bim/model/extrude.h"

namespace plumbline::bim {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Faulty {
 public:
  Faulty(Building building, const Stream& stream, std::uint64_t tick)
      : building_(std::move(building)), stream_(stream), tick_(tick) {}

  FaultyBuilding take() { return {std::move(building_), std::move(element_), rise_m_}; }

  void split_level() {
    const int index = drawn(building_.rooms.size());
    if (index < 0) return;
    Room& room = building_.rooms[at(index)];
    const double rise = 0.05 + 0.55 * draw();
    Slab slab;
    slab.id = room.id + "/split_level";
    slab.storey = room.storey;
    slab.polygon = {room.polygon, {}};
    slab.z0_m = room.z0_m;
    slab.z1_m = std::round((room.z0_m + rise) * 1e3) / 1e3;
    element_ = room.id;
    rise_m_ = slab.z1_m - room.z0_m;
    room.z0_m = slab.z1_m;
    for (Opening& opening : building_.openings) {
      if (opening.kind == OpeningKind::window || (opening.rooms[0] != index && opening.rooms[1] != index)) continue;
      const double height = opening.z1_m - opening.z0_m;
      opening.z0_m = slab.z1_m;
      opening.z1_m = slab.z1_m + height;
      if (opening.wall < 0) continue;
      opening.z1_m = std::min(opening.z1_m, building_.walls[at(opening.wall)].z1_m - 0.05);
    }
    building_.slabs.push_back(std::move(slab));
  }

  void mezzanine() {
    const int index = drawn(building_.rooms.size());
    if (index < 0) return;
    const Room& room = building_.rooms[at(index)];
    const Eigen::AlignedBox2d box = box_of(room.polygon);
    if (room.polygon.size() != 4) return;
    const double high = room.z0_m + 2.0 + 0.4 * draw();
    Slab slab;
    slab.id = room.id + "/mezzanine";
    slab.storey = room.storey;
    const Eigen::Vector2d end(box.center().x(), box.max().y());
    const Polygon2 left = {box.min(), {end.x(), box.min().y()}, end, {box.min().x(), box.max().y()}};
    const Region2 half = intersect(unite(std::vector<Polygon2>{room.polygon}), unite(std::vector<Polygon2>{left}));
    if (half.size() != 1) return;
    slab.polygon = half.front();
    element_ = room.id;
    slab.z0_m = high - 0.15;
    slab.z1_m = high;
    building_.slabs.push_back(std::move(slab));
  }

  void overlapping_wall() {
    const int index = drawn_door();
    if (index < 0) return;
    element_ = building_.openings[at(index)].id;
    Wall again = building_.walls[at(building_.openings[at(index)].wall)];
    again.id += "/overlapping_wall";
    again.offset_m -= 0.05;
    again.thickness_m += 0.1;
    add_wall(std::move(again));
  }

  void crossing_wall() {
    const int index = drawn_door();
    if (index < 0) return;
    const Opening& door = building_.openings[at(index)];
    element_ = door.id;
    const Wall& host = building_.walls[at(door.wall)];
    Wall wall = host;
    wall.id += "/crossing_wall";
    const Eigen::Vector2d foot = host.a + (door.s_m + door.width_m / 3.0) * host.direction();
    const double face = host.offset_m + host.thickness_m;
    // From the far face of the host, half a metre into the room on its left.
    wall.a = foot + host.offset_m * host.left();
    wall.b = foot + (face + 0.5) * host.left();
    wall.thickness_m = door.width_m / 3.0;
    wall.offset_m = -0.5 * wall.thickness_m;
    add_wall(std::move(wall));
  }

  void missing_slabs() { building_.slabs.clear(); }

  void curtain_front() {
    std::vector<int> outer;
    for (std::size_t i = 0; i < building_.walls.size(); ++i)
      if (is_windowed(static_cast<int>(i))) outer.push_back(static_cast<int>(i));
    const int pick = drawn(outer.size());
    if (pick < 0) return;
    const int index = outer[at(pick)];
    const Wall wall = building_.walls[at(index)];
    element_ = wall.id;
    remove_wall(index);
    const int panels = std::max(1, static_cast<int>(std::round(wall.length() / 1.2)));
    const double middle = wall.offset_m + 0.5 * wall.thickness_m, pitch = wall.length() / panels;
    for (int i = 0; i < panels; ++i) {
      add_box(wall, "curtain_panel", i, i * pitch + 0.03, (i + 1) * pitch - 0.03, middle - 0.015, middle + 0.015,
              "glass");
      add_box(wall, "mullion", i, i * pitch - 0.03, i * pitch + 0.03, middle - 0.06, middle + 0.06, "");
    }
    const bool known = std::any_of(building_.materials.begin(), building_.materials.end(),
                                   [](const Material& material) { return material.id == "glass"; });
    if (!known) building_.materials.push_back({"glass", 0.1, 0.9});
  }

 private:
  double draw() { return stream_.uniform(tick_, 0, draws_++); }
  /// One of so many, -1 of none.
  int drawn(std::size_t count) {
    return count == 0 ? -1
                      : std::min(static_cast<int>(draw() * static_cast<double>(count)), static_cast<int>(count) - 1);
  }
  int drawn_door() {
    std::vector<int> doors;  // of walls
    for (std::size_t i = 0; i < building_.openings.size(); ++i)
      if (building_.openings[i].kind == OpeningKind::door && building_.openings[i].wall >= 0)
        doors.push_back(static_cast<int>(i));
    const int pick = drawn(doors.size());
    return pick < 0 ? -1 : doors[at(pick)];
  }

  /// Outer walls are those with a window, or with a room on one side only; doors must stay where they are.
  [[nodiscard]] bool is_windowed(int wall) const {
    bool window = false;
    for (const Opening& opening : building_.openings) {
      if (opening.wall != wall) continue;
      if (opening.kind != OpeningKind::window) return false;
      window = true;
    }
    return window;
  }

  /// Walls stand sorted by storey; rooms are looked up again by whoever reads the file.
  void add_wall(Wall wall) { building_.walls.push_back(std::move(wall)); }

  void remove_wall(int index) {
    std::erase_if(building_.openings, [&](const Opening& opening) { return opening.wall == index; });
    for (Opening& opening : building_.openings) opening.wall -= opening.wall > index ? 1 : 0;
    for (Room& room : building_.rooms) {
      std::erase(room.walls, index);
      for (int& wall : room.walls) wall -= wall > index ? 1 : 0;
    }
    building_.walls.erase(building_.walls.begin() + index);
  }

  void add_box(const Wall& wall, const std::string& kind, int number, double s0, double s1, double y0, double y1,
               const std::string& material) {
    const auto p = [&](double s, double y) -> Eigen::Vector2d {
      return wall.a + s * wall.direction() + y * wall.left();
    };
    Obstacle part;
    part.id = wall.id + "/" + kind + std::to_string(number + 1) + "/curtain_front";
    part.kind = kind;
    part.storey = wall.storey;
    part.material = material;
    part.body = extrude({PolygonWithHoles2{{p(s0, y0), p(s1, y0), p(s1, y1), p(s0, y1)}, {}}}, wall.z0_m, wall.z1_m);
    building_.obstacles.push_back(std::move(part));
  }

  Building building_;
  const Stream& stream_;
  std::uint64_t tick_;
  std::uint32_t draws_ = 0;
  std::string element_;
  double rise_m_ = 0.0;
};

}  // namespace

FaultyBuilding with_fault(Building building, BuildingFault fault, const Stream& stream, std::uint64_t tick) {
  Faulty faulty(std::move(building), stream, tick);
  switch (fault) {
    case BuildingFault::split_level:
      faulty.split_level();
      break;
    case BuildingFault::mezzanine:
      faulty.mezzanine();
      break;
    case BuildingFault::overlapping_wall:
      faulty.overlapping_wall();
      break;
    case BuildingFault::crossing_wall:
      faulty.crossing_wall();
      break;
    case BuildingFault::missing_slabs:
      faulty.missing_slabs();
      break;
    case BuildingFault::curtain_front:
      faulty.curtain_front();
      break;
  }
  return faulty.take();
}

}  // namespace plumbline::bim
