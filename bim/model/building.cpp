// SPDX-License-Identifier: Apache-2.0
#include "bim/model/building.h"

#include <algorithm>
#include <cmath>

#include "bim/digest/digest.h"
#include "bim/model/fillings.h"

namespace plumbline::bim {

namespace {

void add(Digest& digest, const Polygon2& polygon) {
  digest.add(static_cast<int>(polygon.size()));
  for (const Eigen::Vector2d& p : polygon) digest.add(p);
}

void add(Digest& digest, const Solid& solid) {
  digest.add(static_cast<int>(solid.vertices.size())).add(static_cast<int>(solid.triangles.size()));
  for (const Eigen::Vector3d& p : solid.vertices) digest.add(p);
  for (const Eigen::Vector3i& t : solid.triangles) digest.add(t[0]).add(t[1]).add(t[2]);
}

void add(Digest& digest, const std::optional<Solid>& solid) {
  digest.add(solid ? 1 : 0);
  if (solid) add(digest, *solid);
}

void add(Digest& digest, const Storey& storey) {
  digest.add(storey.id).add(static_cast<int>(storey.kind)).add(storey.elevation_m).add(storey.height_m);
}

void add(Digest& digest, const Wall& wall) {
  digest.add(wall.id).add(wall.storey).add(wall.a).add(wall.b).add(wall.offset_m).add(wall.thickness_m);
  digest.add(wall.z0_m).add(wall.z1_m).add(wall.slope).add(wall.material);
  add(digest, wall.body);
}

void add(Digest& digest, const Opening& opening) {
  digest.add(opening.id).add(opening.wall).add(static_cast<int>(opening.kind)).add(static_cast<int>(opening.leaf));
  digest.add(opening.s_m).add(opening.width_m).add(opening.z0_m).add(opening.z1_m).add(opening.filling_id);
  digest.add(opening.material);
  digest.add(opening.rooms[0]).add(opening.rooms[1]);
  add(digest, opening.solid);
  digest.add(static_cast<int>(opening.parts.size()));
  for (const Solid& part : opening.parts) add(digest, part);
}

void add(Digest& digest, const Room& room) {
  digest.add(room.id).add(room.storey).add(room.z0_m).add(room.z1_m);
  add(digest, room.polygon);
  for (const Polygon2& hole : room.holes) add(digest, hole);
  digest.add(static_cast<int>(room.walls.size()));
  for (const int wall : room.walls) digest.add(wall);
  digest.add(static_cast<int>(room.virtual_edges.size()));
  for (const VirtualEdge& edge : room.virtual_edges) {
    digest.add(edge.a).add(edge.b).add(edge.room);
    if (!edge.door.empty()) digest.add(edge.door);
  }
}

void add(Digest& digest, const Slab& slab) {
  digest.add(slab.id).add(slab.storey).add(slab.z0_m).add(slab.z1_m).add(slab.material);
  add(digest, slab.polygon.outer);
  digest.add(static_cast<int>(slab.polygon.holes.size()));
  for (const Polygon2& hole : slab.polygon.holes) add(digest, hole);
  add(digest, slab.body);
}

void add(Digest& digest, const Column& column) {
  digest.add(column.id).add(column.storey).add(column.z0_m).add(column.z1_m).add(column.material);
  add(digest, column.footprint);
  add(digest, column.body);
}

void add(Digest& digest, const Stair& stair) {
  digest.add(stair.id).add(stair.from).add(stair.to).add(stair.rooms[0]).add(stair.rooms[1]).add(stair.material);
  digest.add(static_cast<int>(stair.flights.size()));
  for (const StairFlight& flight : stair.flights) {
    digest.add(flight.start).add(flight.yaw).add(flight.width_m).add(flight.z0_m);
    digest.add(flight.steps).add(flight.rise_m).add(flight.run_m);
  }
  digest.add(static_cast<int>(stair.landings.size()));
  for (const Landing& landing : stair.landings) {
    digest.add(landing.z_m);
    add(digest, landing.polygon);
  }
  digest.add(static_cast<int>(stair.bodies.size()));
  for (const Solid& body : stair.bodies) add(digest, body);
}

void add(Digest& digest, const Obstacle& obstacle) {
  digest.add(obstacle.id).add(obstacle.kind).add(obstacle.storey).add(obstacle.planned ? 1 : 0);
  digest.add(obstacle.material);
  add(digest, obstacle.body);
}

void add(Digest& digest, const Material& material) {
  digest.add(material.id)
      .add(material.reflectivity)
      .add(material.transmission)
      .add(material.specular)
      .add(material.retro);
}

template <class Element>
void add_all(Digest& digest, const std::vector<Element>& elements) {
  digest.add(static_cast<int>(elements.size()));
  for (const Element& element : elements) add(digest, element);
}

}  // namespace

bool Room::contains(const Eigen::Vector2d& p) const { return plumbline::contains(polygon, holes, p); }

double Room::area_m2() const {
  double area = std::abs(signed_area(polygon));
  for (const Polygon2& hole : holes) area -= std::abs(signed_area(hole));
  return area;
}

double Room::boundary_distance(const Eigen::Vector2d& p) const {
  return plumbline::boundary_distance(polygon, holes, p);
}

std::vector<const Polygon2*> Room::rims() const {
  std::vector<const Polygon2*> found = {&polygon};
  for (const Polygon2& hole : holes) found.push_back(&hole);
  return found;
}

std::uint64_t Building::hash() const {
  Digest digest;
  add_all(digest, storeys);
  add_all(digest, walls);
  add_all(digest, openings);
  add_all(digest, rooms);
  add_all(digest, slabs);
  add_all(digest, columns);
  add_all(digest, stairs);
  std::vector<Obstacle> content = obstacles;
  std::erase_if(content, is_filling);
  add_all(digest, content);
  add_all(digest, materials);
  return digest.value();
}

std::vector<int> storeys_upwards(const Building& building) {
  std::vector<int> order;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return building.storeys[static_cast<std::size_t>(a)].elevation_m <
           building.storeys[static_cast<std::size_t>(b)].elevation_m;
  });
  return order;
}

}  // namespace plumbline::bim
