// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <set>
#include <string>

#include "bim/furniture/footprint.h"
#include "bim/furniture/shapes.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// One piece of furniture on the floor of a room.
struct FurniturePiece {
  std::string id;
  FurnitureShape shape = FurnitureShape::table;
  int storey = -1;
  int room = -1;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();    ///< centre of its floor area in W, m
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< along its own x and y, m
  double yaw_deg = 0.0;
  double height_m = 1.0;
  double floor_z_m = 0.0;
};

[[nodiscard]] Footprint footprint_of(const FurniturePiece& piece);
/// A planned obstacle of kind "furniture".
[[nodiscard]] Obstacle obstacle_of(const FurniturePiece& piece);

/// Gives out "furniture_<n>", counting up, but for ids that an element of a building has.
class FurnitureIds {
 public:
  void take(const Building& building);
  [[nodiscard]] std::string next();

 private:
  std::set<std::string> taken_;
  int number_ = 0;
};

}  // namespace plumbline::bim
