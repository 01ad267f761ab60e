// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/model/building.h"

namespace plumbline::sim {

/// Building of one storey at the given height of the floor, to be filled by a test.
inline bim::Building empty_storey(double elevation_m = 0.0) {
  bim::Building building;
  building.storeys.push_back({"ground", "ground", elevation_m, 3.0, 0});
  return building;
}

inline Polygon2 rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// Upright prism over a convex polygon.
inline bim::Solid prism(const Polygon2& base, double z0, double z1) {
  bim::Solid solid;
  const int n = static_cast<int>(base.size());
  for (const Eigen::Vector2d& p : base) solid.vertices.emplace_back(p.x(), p.y(), z0);
  for (const Eigen::Vector2d& p : base) solid.vertices.emplace_back(p.x(), p.y(), z1);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    solid.triangles.emplace_back(i, j, n + j);
    solid.triangles.emplace_back(i, n + j, n + i);
    if (i > 1) {
      solid.triangles.emplace_back(0, i, i - 1);
      solid.triangles.emplace_back(n, n + i - 1, n + i);
    }
  }
  return solid;
}

/// A wall centred on its line; returns its index.
inline int add_wall(bim::Building& building, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                    double thickness = 0.2) {
  bim::Wall wall;
  wall.id = "w" + std::to_string(building.walls.size());
  wall.storey = 0;
  wall.a = a;
  wall.b = b;
  wall.offset_m = -0.5 * thickness;
  wall.thickness_m = thickness;
  wall.z0_m = building.storeys[0].elevation_m;
  wall.z1_m = wall.z0_m + 3.0;
  building.walls.push_back(wall);
  return static_cast<int>(building.walls.size()) - 1;
}

inline bim::Opening& add_door(bim::Building& building, int wall, double s, double width) {
  bim::Opening door;
  door.id = "d" + std::to_string(building.openings.size());
  door.wall = wall;
  door.s_m = s;
  door.width_m = width;
  door.z0_m = building.storeys[0].elevation_m;
  door.z1_m = door.z0_m + 2.1;
  building.openings.push_back(door);
  return building.openings.back();
}

inline void add_room(bim::Building& building, const std::string& id, const Polygon2& polygon) {
  bim::Room room;
  room.id = id;
  room.storey = 0;
  room.polygon = polygon;
  building.rooms.push_back(room);
}

inline void add_obstacle(bim::Building& building, const Polygon2& base, double z0, double z1) {
  bim::Obstacle obstacle;
  obstacle.id = "o" + std::to_string(building.obstacles.size());
  obstacle.storey = 0;
  obstacle.body = prism(base, z0, z1);
  building.obstacles.push_back(obstacle);
}

/// Two rooms of 4 x 5 m, west and east, with the wall between them (index 0) at x = 4.
inline bim::Building two_rooms(double elevation_m = 0.0) {
  bim::Building building = empty_storey(elevation_m);
  add_wall(building, {4, 0}, {4, 5});
  add_wall(building, {0, 0}, {8, 0});
  add_wall(building, {8, 0}, {8, 5});
  add_wall(building, {8, 5}, {0, 5});
  add_wall(building, {0, 5}, {0, 0});
  add_room(building, "west", rectangle({0.1, 0.1}, {3.9, 4.9}));
  add_room(building, "east", rectangle({4.1, 0.1}, {7.9, 4.9}));
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = rectangle({-0.1, -0.1}, {8.1, 5.1});
  slab.z0_m = elevation_m - 0.2;
  slab.z1_m = elevation_m;
  building.slabs.push_back(slab);
  return building;
}

/// The east room's floor so much above the west room's, with its door at the height of its floor.
inline bim::Building split_level(double rise_m, double door_m = 1.0) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, door_m);
  building.openings.front().z0_m = rise_m;
  building.openings.front().z1_m = rise_m + 2.1;
  building.slabs.front().polygon.outer = rectangle({-0.1, -0.1}, {4.0, 5.1});
  bim::Slab raised = building.slabs.front();
  raised.id = "raised";
  raised.polygon.outer = rectangle({4.0, -0.1}, {8.1, 5.1});
  raised.z1_m = rise_m;
  building.slabs.push_back(raised);
  building.rooms[1].z0_m = rise_m;
  return building;
}

}  // namespace plumbline::sim
