// SPDX-License-Identifier: Apache-2.0
#include "bim/model/odd_size.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "bim/config/tree.h"
#include "bim/median.h"
#include "bim/model/permanence.h"

namespace plumbline::bim {

namespace {

// Of doors in general: the gates of a hangar and the hatches of an attic are few. Halls and naves are lower than 50 m;
// millimetres that are taken for inches make storeys of 60 m.
constexpr double lowest_door_m = 1.0, highest_door_m = 5.0, highest_storey_m = 50.0,
                 longest_furniture_m = 50.0;  // a row of racks; a desk of 1.2 m in millimetres is 1.2 km

std::string rounded(double length_m) { return format_number(std::round(length_m * 1e3) / 1e3); }

/// 0 without any.
double middle_height_of_doors(const Building& building) {
  std::vector<double> heights;
  for (const Opening& opening : building.openings)
    if (opening.kind == OpeningKind::door) heights.push_back(opening.z1_m - opening.z0_m);
  return heights.empty() ? 0.0 : upper_median(heights);
}

}  // namespace

std::string odd_size(const Building& building) {
  constexpr double least_m = 1.0, most_m = 5000.0;
  Eigen::AlignedBox2d box;
  for (const Wall& wall : building.walls) {
    if (!wall.body)
      box.extend(wall.a).extend(wall.b);
    else
      for (const Eigen::Vector3d& p : wall.body->vertices) box.extend(p.head<2>());
  }
  for (const Room& room : building.rooms)
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  for (const Slab& slab : building.slabs)
    for (const Eigen::Vector2d& p : slab.polygon.outer) box.extend(p);
  if (box.isEmpty()) return {};
  const double length = box.sizes().maxCoeff();
  if (length < least_m || length > most_m) return "the building is " + rounded(length) + " m long; is the unit right?";
  if (const double door = middle_height_of_doors(building);
      door > 0.0 && (door < lowest_door_m || door > highest_door_m))
    return "its doors are " + rounded(door) + " m high; is the unit right?";
  for (const Storey& storey : building.storeys)
    if (storey.height_m > highest_storey_m)
      return "a storey of it is " + rounded(storey.height_m) + " m high; is the unit right?";
  for (const Obstacle& obstacle : building.obstacles) {
    const bool is_furniture = may_have_moved(obstacle) && obstacle.kind != "proxy" && obstacle.kind != "covering";
    if (!is_furniture || obstacle.body.vertices.empty()) continue;
    Eigen::AlignedBox3d size;
    for (const Eigen::Vector3d& p : obstacle.body.vertices) size.extend(p);
    if (const double longest = size.sizes().maxCoeff(); longest > longest_furniture_m)
      return "its '" + obstacle.id + "' is " + rounded(longest) + " m long; is the unit right?";
  }
  return {};
}

}  // namespace plumbline::bim
