// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/mirror.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumbline::bim {

namespace {

void mirror(Eigen::Vector2d& point) { point.x() = -point.x(); }

/// Keeps the sense of its turn: vertices come in the other order.
void mirror(Polygon2& polygon) {
  for (Eigen::Vector2d& vertex : polygon) mirror(vertex);
  std::reverse(polygon.begin(), polygon.end());
}

void mirror(PolygonWithHoles2& polygon) {
  mirror(polygon.outer);
  for (Polygon2& hole : polygon.holes) mirror(hole);
}

void mirror(Solid& solid) {
  for (Eigen::Vector3d& vertex : solid.vertices) vertex.x() = -vertex.x();
  for (Eigen::Vector3i& triangle : solid.triangles) std::swap(triangle[1], triangle[2]);
}

void mirror(std::optional<Solid>& solid) {
  if (solid) mirror(*solid);
}

/// Left of a to b becomes right.
void mirror(Wall& wall) {
  mirror(wall.a);
  mirror(wall.b);
  wall.offset_m = -(wall.offset_m + wall.thickness_m);
  wall.slope = -wall.slope;
  mirror(wall.body);
}

void mirror(Opening& opening) {
  mirror(opening.solid);
  for (Solid& part : opening.parts) mirror(part);
  std::swap(opening.rooms[0], opening.rooms[1]);
}

void mirror(Room& room) {
  mirror(room.polygon);
  for (Polygon2& hole : room.holes) mirror(hole);
  for (VirtualEdge& edge : room.virtual_edges) {
    mirror(edge.a);
    mirror(edge.b);
    std::swap(edge.a, edge.b);
  }
}

void mirror(Slab& slab) {
  mirror(slab.polygon);
  mirror(slab.body);
}

void mirror(Column& column) {
  mirror(column.footprint);
  mirror(column.body);
}

void mirror(Stair& stair) {
  for (StairFlight& flight : stair.flights) {
    mirror(flight.start);
    flight.yaw = std::remainder(std::numbers::pi - flight.yaw, 2.0 * std::numbers::pi);
  }
  for (Landing& landing : stair.landings) mirror(landing.polygon);
  for (Solid& body : stair.bodies) mirror(body);
}

void mirror(Obstacle& obstacle) { mirror(obstacle.body); }

template <typename Element>
void mirror(std::vector<Element>& elements) {
  for (Element& element : elements) mirror(element);
}

}  // namespace

Building mirrored(Building building) {
  mirror(building.walls);
  mirror(building.openings);
  mirror(building.rooms);
  mirror(building.slabs);
  mirror(building.columns);
  mirror(building.stairs);
  mirror(building.obstacles);
  building.name += " mirrored";
  return building;
}

}  // namespace plumbline::bim
