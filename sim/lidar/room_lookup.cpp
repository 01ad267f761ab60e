// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/room_lookup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bim/geometry/polygon.h"

namespace plumbline::sim {

namespace {

constexpr double cells_max = 4e6;
/// A point this far above or below a room still belongs to it: floors and ceilings are not exactly level.
constexpr double height_tolerance_m = 0.1;

Eigen::AlignedBox2d box_of(const Polygon2& polygon) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon) box.extend(p);
  return box;
}

}  // namespace

RoomLookup::RoomLookup(const bim::Building& building) : rooms_(building.rooms) {
  Eigen::AlignedBox2d box;
  for (const bim::Room& room : rooms_) box.extend(box_of(room.polygon));
  if (box.isEmpty()) return;
  const Eigen::Vector2d size = box.sizes();
  cell_m_ = std::max(cell_m_, std::sqrt((size.x() + 1.0) * (size.y() + 1.0) / cells_max));
  origin_W_ = box.min();
  cells_ = (size / cell_m_).array().floor().cast<int>() + 1;
  std::vector<std::vector<Entry>> cells(static_cast<std::size_t>(cells_.cast<std::int64_t>().prod()));
  for (std::size_t i = 0; i < rooms_.size(); ++i) add_room(static_cast<std::int32_t>(i), cells);
  for (const std::vector<Entry>& cell : cells) {
    first_.push_back(static_cast<std::int32_t>(entries_.size()));
    entries_.insert(entries_.end(), cell.begin(), cell.end());
  }
  first_.push_back(static_cast<std::int32_t>(entries_.size()));
}

void RoomLookup::add_room(std::int32_t room, std::vector<std::vector<Entry>>& cells) const {
  const bim::Room& of = rooms_[static_cast<std::size_t>(room)];
  const Eigen::AlignedBox2d box = box_of(of.polygon);
  if (box.isEmpty()) return;
  const Eigen::Vector2i low = ((box.min() - origin_W_) / cell_m_).array().floor().cast<int>();
  const Eigen::Vector2i high = ((box.max() - origin_W_) / cell_m_).array().floor().cast<int>();
  const double half_diagonal = std::sqrt(0.5) * cell_m_;
  for (int y = low.y(); y <= high.y(); ++y)
    for (int x = low.x(); x <= high.x(); ++x) {
      const Eigen::Vector2d centre = origin_W_ + cell_m_ * (Eigen::Vector2d(x, y) + Eigen::Vector2d::Constant(0.5));
      const bool crossed = of.boundary_distance(centre) <= half_diagonal;
      if (crossed || of.contains(centre))
        cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells_.x()) + static_cast<std::size_t>(x)]
            .push_back({room, !crossed});
    }
}

std::int64_t RoomLookup::cell_of(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d cell = (p_W - origin_W_) / cell_m_;
  if (!(cell.x() >= 0.0 && cell.y() >= 0.0 && cell.x() < cells_.x() && cell.y() < cells_.y())) return -1;
  return std::int64_t{cells_.x()} * static_cast<int>(cell.y()) + static_cast<int>(cell.x());
}

std::int32_t RoomLookup::at(const Eigen::Vector3d& p_W) const {
  const std::int64_t cell = cell_of(p_W.head<2>());
  if (cell < 0) return -1;
  const auto c = static_cast<std::size_t>(cell);
  for (auto i = static_cast<std::size_t>(first_[c]); i < static_cast<std::size_t>(first_[c + 1]); ++i) {
    const bim::Room& room = rooms_[static_cast<std::size_t>(entries_[i].room)];
    if (p_W.z() < room.z0_m - height_tolerance_m || p_W.z() > room.z1_m + height_tolerance_m) continue;
    if (entries_[i].whole || room.contains(p_W.head<2>())) return entries_[i].room;
  }
  return -1;
}

}  // namespace plumbline::sim
