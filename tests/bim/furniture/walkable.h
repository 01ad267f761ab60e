// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "bim/geometry/polygon.h"
#include "bim/model/building.h"
#include "bim/model/hull.h"

namespace plumbline::bim {

/// What an obstacle covers, as a convex outline.
[[nodiscard]] inline Polygon2 hull_of(const Obstacle& obstacle) {
  Polygon2 points;
  for (const Eigen::Vector3d& p : obstacle.body.vertices) points.push_back(p.head<2>());
  return convex_hull(points);
}

/// Where a robot of radius 0.4 m can be in a room: cells of 0.1 m from the low corner of the room's box, by the number
/// of the part that they hang together in; -1 not free.
class WalkableRoom {
 public:
  WalkableRoom(const Polygon2& room, const std::vector<Polygon2>& standing) {
    Eigen::Vector2d high = room.front();
    low_ = room.front();
    for (const Eigen::Vector2d& p : room) {
      low_ = low_.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    nx_ = static_cast<int>((high.x() - low_.x()) / cell_m) + 1;
    ny_ = static_cast<int>((high.y() - low_.y()) / cell_m) + 1;
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) part_.push_back(is_free(room, standing, center(i, j)) ? 0 : -1);
    for (std::size_t c = 0; c < part_.size(); ++c)
      if (part_[c] == 0) flood(c);
  }

  [[nodiscard]] const std::vector<int>& parts() const { return part_; }
  /// Part of the cell that holds p.
  [[nodiscard]] int part_at(const Eigen::Vector2d& p) const {
    const int i = static_cast<int>(std::floor((p.x() - low_.x()) / cell_m));
    const int j = static_cast<int>(std::floor((p.y() - low_.y()) / cell_m));
    return i < 0 || j < 0 || i >= nx_ || j >= ny_ ? -1 : part_[index(i, j)];
  }

 private:
  static constexpr double cell_m = 0.1, radius_m = 0.4 - 1e-6;

  [[nodiscard]] std::size_t index(int i, int j) const { return static_cast<std::size_t>(j * nx_ + i); }
  [[nodiscard]] Eigen::Vector2d center(int i, int j) const { return low_ + cell_m * Eigen::Vector2d(i + 0.5, j + 0.5); }

  static bool is_free(const Polygon2& room, const std::vector<Polygon2>& standing, const Eigen::Vector2d& p) {
    if (!contains(room, p) || boundary_distance(room, p) < radius_m) return false;
    return std::none_of(standing.begin(), standing.end(), [&](const Polygon2& outline) {
      return contains(outline, p) || boundary_distance(outline, p) < radius_m;
    });
  }

  void flood(std::size_t from) {
    const int number = ++count_;
    std::vector<std::size_t> open = {from};
    part_[from] = number;
    while (!open.empty()) {
      const int i = static_cast<int>(open.back()) % nx_, j = static_cast<int>(open.back()) / nx_;
      open.pop_back();
      for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (i + di < 0 || j + dj < 0 || i + di >= nx_ || j + dj >= ny_ || part_[index(i + di, j + dj)] != 0) continue;
        part_[index(i + di, j + dj)] = number;
        open.push_back(index(i + di, j + dj));
      }
    }
  }

  Eigen::Vector2d low_;
  int nx_ = 0, ny_ = 0, count_ = 0;
  std::vector<int> part_;
};

/// What was one part of a room's free space and is free still is one part still, in every room of the building; so are
/// the places in front of its doors, which are free still.
inline void expect_walkable(const Building& bare, const std::vector<Polygon2>& before,
                            const std::vector<Polygon2>& after) {
  for (const Room& room : bare.rooms) {
    const WalkableRoom was(room.polygon, before), is(room.polygon, after);
    ASSERT_EQ(was.parts().size(), is.parts().size());
    std::map<int, int> now;  // number as it is, by the number as it was
    int stray = 0;
    for (std::size_t c = 0; c < was.parts().size(); ++c) {
      if (is.parts()[c] < 0 || was.parts()[c] < 0) continue;
      const auto [known, is_new] = now.emplace(was.parts()[c], is.parts()[c]);
      if (known->second != is.parts()[c]) ++stray;
    }
    EXPECT_EQ(stray, 0) << "cells cut off in room " << room.id;
    for (const Opening& opening : bare.openings) {
      const Wall& wall = bare.walls[static_cast<std::size_t>(opening.wall)];
      if (opening.kind == OpeningKind::window || wall.storey != room.storey) continue;
      for (const double side : {1.0, -1.0}) {
        const double face = side > 0.0 ? wall.offset_m + wall.thickness_m : wall.offset_m;
        const Eigen::Vector2d in_front = wall.a + opening.s_m * wall.direction() + (face + side * 0.48) * wall.left();
        if (was.part_at(in_front) < 0) continue;
        EXPECT_EQ(is.part_at(in_front), now[was.part_at(in_front)])
            << "door " << opening.id << " of room " << room.id << " is blocked";
      }
    }
  }
}

}  // namespace plumbline::bim
