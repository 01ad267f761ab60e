// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace plumbline::bim {

namespace {

constexpr double spare_m = 0.01;       ///< beyond the least gap, so that rounding does not matter
constexpr double chair_away_m = 0.06;  ///< between a chair and its table
constexpr double chair_every_m = 0.6;  ///< along a table's side
constexpr double wall_step_m = 0.1;    ///< between the positions tried along a wall
constexpr int misses_max = 8;          ///< of a kind of piece in a room, after which it is not tried again
constexpr int searches_max = 60;       ///< positions of a piece that are free but for the robot's way

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

double degrees(double rad) {
  const double deg = rounded(rad * 180.0 / std::numbers::pi, 1e3);
  return deg <= -180.0 ? deg + 360.0 : deg > 180.0 ? deg - 360.0 : deg;
}

Eigen::Vector2d along_x(double yaw_deg) {
  const double yaw = yaw_deg * std::numbers::pi / 180.0;
  return {std::cos(yaw), std::sin(yaw)};
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// Lays out one room.
class Layout {
 public:
  Layout(const Room& room, RoomSpace& space, const LayoutOrder& order, Draws& draws)
      : room_(room), space_(space), order_(order), draws_(draws) {}

  std::vector<FurniturePiece> run() {
    const std::span<const FurnitureItem> items = items_of(use_of(room_));
    std::vector<int> misses(items.size(), 0), placed(items.size(), 0);
    for (bool any_tried = space_.walkable(); any_tried;) {
      any_tried = false;
      for (std::size_t i = 0; i < items.size() && wanted() > 0.0; ++i) {
        if (misses[i] >= misses_max || placed[i] >= items[i].most) continue;
        FurniturePiece piece = draw(items[i]);
        if (piece.size.prod() > 2.0 * wanted()) piece.size = {items[i].smallest[0], items[i].smallest[1]};
        if (piece.size.prod() > 2.0 * wanted()) continue;
        any_tried = true;
        if (place(piece, items[i].spot)) {
          ++placed[i];
          add_chairs(pieces_.back(), items[i].chairs);
        } else {
          ++misses[i];
        }
      }
    }
    return std::move(pieces_);
  }

 private:
  /// Floor that is still to be covered, m^2.
  [[nodiscard]] double wanted() const {
    return static_cast<int>(pieces_.size()) < order_.pieces_max ? order_.target_m2 - covered_m2_ : 0.0;
  }

  FurniturePiece draw(const FurnitureItem& item) {
    std::array<double, 3> size{};
    for (std::size_t k = 0; k < 3; ++k)
      size[k] = rounded(draws_.between(item.smallest[k], item.largest[k]), k < 2 ? 20.0 : 100.0);
    FurniturePiece piece;
    piece.shape = item.shape;
    piece.storey = room_.storey;
    piece.size = {std::max(size[0], item.smallest[0]), std::max(size[1], item.smallest[1])};
    piece.height_m = std::min(size[2], std::max(0.3, rounded(room_.z1_m - room_.z0_m - 0.1, 100.0)));
    piece.floor_z_m = room_.z0_m;
    return piece;
  }

  bool place(FurniturePiece piece, Spot spot) {
    searches_ = 0;
    switch (spot) {
      case Spot::wall:
        return along_walls(piece, space_.config().gap_m + spare_m) || along_walls(piece, space_.config().gap_m + 0.12);
      case Spot::middle:
        return in_the_middle(piece);
      case Spot::beside:
        return beside_others(piece) || anywhere(piece);
    }
    return false;
  }

  /// Puts the piece there if it may stand there.
  bool try_at(FurniturePiece& piece, const Eigen::Vector2d& at, double yaw_deg) {
    if (searches_ > searches_max) return false;
    piece.at = {rounded(at.x(), 1e3), rounded(at.y(), 1e3)};
    piece.yaw_deg = yaw_deg;
    if (space_.clearance(piece.at) < 0.0) return false;
    Footprint footprint = footprint_of(piece);
    if (!space_.holds(footprint)) return false;
    ++searches_;
    if (!space_.stays_walkable(footprint)) return false;
    space_.add(std::move(footprint));
    covered_m2_ += piece.size.prod();
    pieces_.push_back(piece);
    return true;
  }

  [[nodiscard]] bool is_open(const Eigen::Vector2d& p) const {
    constexpr double on_edge_m = 0.05;
    return std::any_of(room_.virtual_edges.begin(), room_.virtual_edges.end(),
                       [&](const VirtualEdge& edge) { return segment_distance(edge.a, edge.b, p) < on_edge_m; });
  }

  /// Along the outline from a corner drawn and a place drawn, with the back to the wall.
  bool along_walls(FurniturePiece& piece, double gap_m) {
    const std::size_t count = room_.polygon.size(), first = draws_.below(count);
    const double begin = draws_.between(0.0, 1.0);
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Vector2d &a = room_.polygon[(first + k) % count], &b = room_.polygon[(first + k + 1) % count];
      const double spare = (b - a).norm() - piece.size.x() - 2.0 * gap_m;
      if (spare < 0.0) continue;
      // The room lies left of its outline; backs face right.
      const Eigen::Vector2d e = (b - a).normalized(), in = left_of(e);
      const double yaw_deg = degrees(std::atan2(-e.y(), -e.x()));
      const int steps = static_cast<int>(spare / wall_step_m) + 1;
      for (int i = 0; i <= steps; ++i) {
        const double u = std::min(spare, std::fmod(begin * steps + i, steps + 1) * wall_step_m);
        const Eigen::Vector2d on_wall = a + (gap_m + u + 0.5 * piece.size.x()) * e;
        if (is_open(on_wall)) continue;
        if (try_at(piece, on_wall + (gap_m + 0.5 * piece.size.y()) * in, yaw_deg)) return true;
      }
    }
    return false;
  }

  /// Direction of the outline's longest edge, deg; of equal ones the first.
  [[nodiscard]] double main_yaw_deg() const {
    Eigen::Vector2d longest = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < room_.polygon.size(); ++i) {
      const Eigen::Vector2d edge = room_.polygon[(i + 1) % room_.polygon.size()] - room_.polygon[i];
      if (edge.norm() > longest.norm() + 1e-6) longest = edge;
    }
    return degrees(std::atan2(longest.y(), longest.x()));
  }

  [[nodiscard]] Eigen::Vector2d draw_place() {
    const GridFrame& grid = space_.grid();
    const double x = draws_.between(0.0, grid.nx * grid.cell), y = draws_.between(0.0, grid.ny * grid.cell);
    return grid.origin + Eigen::Vector2d(x, y);
  }

  double draw_yaw_deg() {
    return degrees((main_yaw_deg() + 90.0 * static_cast<double>(draws_.below(4))) * std::numbers::pi / 180.0);
  }

  /// Of places drawn, the one farthest from what stands there, of equal ones the first.
  bool in_the_middle(FurniturePiece& piece) {
    constexpr int drawn = 80;
    struct Place {
      double clearance;
      Eigen::Vector2d at;
    };
    std::vector<Place> places;
    for (int i = 0; i < drawn; ++i) {
      const Eigen::Vector2d at = draw_place();
      places.push_back({space_.clearance(at), at});
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.clearance > b.clearance; });
    const double yaw_deg = draw_yaw_deg();
    return std::any_of(places.begin(), places.end(), [&](const Place& place) {
      return try_at(piece, place.at, yaw_deg) ||
             try_at(piece, place.at, degrees((yaw_deg + 90.0) * std::numbers::pi / 180.0));
    });
  }

  /// At a side of a piece that is there, flush with it.
  bool beside_others(FurniturePiece& piece) {
    constexpr std::size_t tried_max = 40;
    const std::size_t count = pieces_.size();
    const std::size_t first = count > 0 ? draws_.below(count) : 0;
    for (std::size_t k = 0; k < std::min(count, tried_max); ++k) {
      const FurniturePiece& other = pieces_[(first + k) % count];
      const double yaw_deg = other.yaw_deg, gap = space_.config().gap_m + spare_m;
      const Eigen::Vector2d center = other.at, x = along_x(yaw_deg), y = left_of(x);
      const Eigen::Vector2d apart = 0.5 * (other.size + piece.size), flush = 0.5 * (other.size - piece.size);
      for (const double side : {1.0, -1.0})
        for (const double edge : {1.0, -1.0})
          if (try_at(piece, center + side * (apart.x() + gap) * x + edge * flush.y() * y, yaw_deg) ||
              try_at(piece, center + side * (apart.y() + gap) * y + edge * flush.x() * x, yaw_deg))
            return true;
    }
    return false;
  }

  bool anywhere(FurniturePiece& piece) {
    constexpr int drawn = 150;
    for (int i = 0; i < drawn; ++i) {
      const Eigen::Vector2d at = draw_place();
      if (space_.clearance(at) > 0.0 && try_at(piece, at, draw_yaw_deg())) return true;
    }
    return false;
  }

  /// Chairs around a table, first at its front; a desk has them at its front alone.
  void add_chairs(const FurniturePiece table, int most) {
    if (most <= 0) return;
    const bool front_only = table.shape == FurnitureShape::desk;
    const Eigen::Vector2d x = along_x(table.yaw_deg), y = left_of(x);
    for (int side = 0; side < (front_only ? 1 : 4) && most > 0; ++side) {
      // Front, back, right, left: outwards, and the turn of a chair that faces the table from there.
      const std::array<Eigen::Vector2d, 4> outwards = {-y, y, x, -x};
      const std::array<double, 4> turn_deg = {180.0, 0.0, -90.0, 90.0};
      const auto s = static_cast<std::size_t>(side);
      const double length = side < 2 ? table.size.x() : table.size.y();
      const double away = 0.5 * (side < 2 ? table.size.y() : table.size.x());
      const Eigen::Vector2d row = side < 2 ? x : y;
      const int seats = std::max(1, static_cast<int>(length / chair_every_m));
      for (int i = 0; i < seats && most > 0; ++i) {
        FurniturePiece seat = table;
        seat.shape = FurnitureShape::chair;
        seat.size = {0.45, 0.45};
        seat.height_m = 0.9;
        searches_ = 0;
        if (wanted() <= 0.0) return;
        const double shift = ((i + 0.5) / seats - 0.5) * length;
        const Eigen::Vector2d at = table.at + shift * row + (away + chair_away_m + 0.5 * seat.size.y()) * outwards[s];
        const double yaw_deg = degrees((table.yaw_deg + turn_deg[s]) * std::numbers::pi / 180.0);
        if (try_at(seat, at, yaw_deg)) --most;
      }
    }
  }

  const Room& room_;
  RoomSpace& space_;
  const LayoutOrder& order_;
  Draws& draws_;
  std::vector<FurniturePiece> pieces_;
  double covered_m2_ = 0.0;
  int searches_ = 0;
};

}  // namespace

std::vector<FurniturePiece> lay_out(const Room& room, RoomSpace& space, const LayoutOrder& order, Draws& draws) {
  return Layout(room, space, order, draws).run();
}

}  // namespace plumbline::bim
